# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Random nonsense as run folders: counts and a reference of any kind, and what they amount to."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

TICKS, RADIUS, BASE = 2000.0, 0.05, 0.35
KINDS = ("walk", "white", "still", "steady", "circle", "jumps", "spin", "same", "same times")
"""How a reference may go; the last two as the wheels do, or a multiple of it."""


@dataclass(frozen=True)
class Nonsense:
    """What was written, and the largest length [m] and turning [rad] in it by the robot file."""

    robot: Path
    runs: tuple[Path, ...]
    length: float
    turning: float


def columns(random: np.random.Generator, kind: str, time: np.ndarray) -> np.ndarray:
    """Three columns of anything, of the size of a drive of some seconds."""
    shape = (time.size, 3)
    made: dict[str, Callable[[], np.ndarray]] = {
        "walk": lambda: 0.1 * np.cumsum(random.normal(size=shape), axis=0),
        "white": lambda: 0.05 * random.normal(size=shape),
        "still": lambda: np.zeros(shape),
        "steady": lambda: np.outer(time, 0.5 * random.normal(size=3)),
        "circle": lambda: np.stack([np.cos(time), np.sin(time), time], axis=1),
        "jumps": lambda: np.cumsum(
            (random.random(shape) < 0.05) * random.normal(size=shape), axis=0
        ),
        "spin": lambda: 0.3 * np.stack([time, -time, 4.0 * time], axis=1),
    }
    return made[kind]()


def nonsense(folder: Path, seed: int, wheels: str, seen: str) -> Nonsense:
    """Up to three drives, and a robot file that may be absurd."""
    random = np.random.default_rng(seed)

    def absurd(value: float) -> float:
        return float(value * 10.0 ** random.uniform(-1.5, 1.5)) if random.random() < 0.2 else value

    ticks = absurd(TICKS)
    robot = {
        "wheel_separation": absurd(BASE),
        "wheel_radius": absurd(RADIUS),
        "left_ticks_per_revolution": ticks,
        "right_ticks_per_revolution": ticks,
        "left_wheel_noise": absurd(4e-4),
    }
    (folder / "robot.yaml").write_text(
        "odom_node:\n  ros__parameters:\n"
        + "".join(f"    {name}: {value!r}\n" for name, value in robot.items())
    )
    runs, lengths, turnings = [], [robot["wheel_separation"]], [2.0 * np.pi]
    kept = ([0, 1, 2], [0, 1], [2])[int(random.integers(3))]
    for number in range(int(random.integers(1, 4))):
        time = np.arange(int(random.integers(40, 120))) * 0.1
        counts = np.rint(
            columns(random, wheels, time)[:, :2] * TICKS / (2.0 * np.pi * RADIUS)
        ).astype(int)
        if random.random() < 0.15:
            counts[:, int(random.integers(2))] = 7
        went = counts * 2.0 * np.pi * robot["wheel_radius"] / ticks
        measured = reference(random, seen, time, counts * 2.0 * np.pi * RADIUS / TICKS)
        if random.random() < 0.15:
            measured[:, int(random.integers(3))] = random.normal()
        runs.append(write(folder / f"run_{number}", random, time, counts, measured, kept))
        steps = np.abs(np.diff(went, axis=0))
        lengths += [float(steps.sum(axis=0).max()), float(np.hypot(*np.ptp(measured, axis=0)[:2]))]
        lengths.append(float(np.hypot(*np.diff(measured[:, :2], axis=0).T).sum()))
        turnings.append(float(steps.sum()) / robot["wheel_separation"])
        turnings.append(float(np.abs(np.diff(measured[:, 2])).sum()))
    return Nonsense(folder / "robot.yaml", tuple(runs), sum(lengths), sum(turnings))


def reference(
    random: np.random.Generator, kind: str, time: np.ndarray, went: np.ndarray
) -> np.ndarray:
    """What is measured, (n, 3); of the wheels' own `went` [m], (n, 2), or of nothing."""
    if not kind.startswith("same"):
        return columns(random, kind, time)
    times = 1.0 if kind == "same" else 10.0 ** random.uniform(-1.5, 1.5)
    yaw = (went[:, 1] - went[:, 0]) / BASE
    steps = np.diff(went.mean(axis=1), prepend=0.0) * np.exp(1j * yaw)
    place = times * np.cumsum(steps)
    return np.stack([place.real, place.imag, yaw], axis=1) + 1e-3 * random.normal(
        size=(yaw.size, 3)
    )


def write(
    folder: Path,
    random: np.random.Generator,
    time: np.ndarray,
    counts: np.ndarray,
    measured: np.ndarray,
    kept: list[int],
) -> Path:
    """A run folder; of the reference the columns `kept`, with gaps."""
    folder.mkdir()
    rows = [f"{t:.4f},{left},{right}" for t, (left, right) in zip(time, counts, strict=True)]
    (folder / "ticks.csv").write_text("\n".join(["t_s,left_ticks,right_ticks", *rows, ""]))
    gaps = random.random(measured.shape) < random.choice([0.0, 0.1])
    every = int(random.choice([1, 2, 5]))
    rows = [
        ",".join(
            [
                f"{t:.4f}",
                *("" if gap or place not in kept else f"{value:.9g}"
                  for place, (gap, value) in enumerate(zip(absent, row, strict=True))),
            ]
        )
        for t, absent, row in zip(time[::every], gaps[::every], measured[::every], strict=True)
    ]  # fmt: skip
    (folder / "reference.csv").write_text("\n".join(["t_s,x_m,y_m,yaw_rad", *rows, ""]))
    return folder
