# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Poorer references of drives that were measured well: what users without motion capture have.

Each takes a reference (t, x, y, yaw, columns of shape (m,)) and gives another one.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Table = NDArray[np.float64]
Rng = np.random.Generator


@dataclass(frozen=True)
class Poorer:
    """Another reference of the same drive."""

    says: str
    change: Callable[[Table, Rng], Table]
    kind: Literal["absolute", "incremental"] = "absolute"


def positions_alone(reference: Table, chance: Rng) -> Table:
    """As a GPS, or one marker."""
    there = reference.copy()
    there[:, 3] = np.nan
    return there


def gyro(reference: Table, chance: Rng) -> Table:
    """An integrated gyro: heading alone, with a bias of the run and white noise of the rate.

    The bias is drawn from 0.002 to 0.02 rad/s, of either sign; the rate's noise walks by
    0.1 mrad/sqrt(s). The 2 mrad of each sample stay, as of a driver that rounds.
    """
    time, yaw = reference[:, 0], np.unwrap(reference[:, 3])
    bias = float(chance.choice([-1.0, 1.0]) * math.exp(chance.uniform(*np.log((0.002, 0.02)))))
    step = np.diff(time, prepend=time[0])
    walk = np.cumsum(1.0e-4 * np.sqrt(step) * chance.standard_normal(time.size))
    heading = yaw + bias * (time - time[0]) + walk
    blank = np.full(time.size, np.nan)
    return np.stack([time, blank, blank, heading], axis=-1)


def two_poses(reference: Table, chance: Rng) -> Table:
    """By tape: where the drive began and where it ended."""
    return reference[[0, -1]]


def once_a_second(reference: Table, chance: Rng) -> Table:
    """As a slow tracker, or a person with a stopwatch."""
    wanted = np.arange(reference[0, 0], reference[-1, 0], 1.0)
    return reference[np.unique(np.searchsorted(reference[:, 0], wanted))]


def scan_matcher(reference: Table, chance: Rng) -> Table:
    """Incremental at 5 Hz: its noise adds up, and one match in 100 fails (10 cm, 6 degrees)."""
    wanted = np.arange(reference[0, 0], reference[-1, 0], 0.2)
    poses = reference[np.unique(np.searchsorted(reference[:, 0], wanted))]
    place, yaw = poses[:, 1] + 1j * poses[:, 2], np.unwrap(poses[:, 3])
    step = np.diff(place) * np.exp(-1j * yaw[:-1])
    turn = np.diff(yaw)
    count = step.size
    step = step + 1e-3 * (chance.standard_normal(count) + 1j * chance.standard_normal(count))
    turn = turn + 1e-3 * chance.standard_normal(count)
    failed = chance.uniform(size=count) < 0.01
    step = step + failed * 0.1 * np.exp(1j * chance.uniform(-np.pi, np.pi, count))
    turn = turn + failed * chance.normal(0.0, 0.1, count)
    heading = yaw[0] + np.concatenate([[0.0], np.cumsum(turn)])
    path = place[0] + np.concatenate([[0.0], np.cumsum(step * np.exp(1j * heading[:-1]))])
    return np.stack([poses[:, 0], path.real, path.imag, heading], axis=-1)


POORER = {
    "positions_alone": Poorer("positions without yaw", positions_alone),
    "gyro": Poorer("a gyro's yaw alone, with a bias", gyro),
    "two_poses": Poorer("two poses a drive", two_poses),
    "once_a_second": Poorer("one sample a second", once_a_second),
    "scan_matcher": Poorer("incremental, with failed matches", scan_matcher, "incremental"),
}


def rewrite(folder: Path, name: str, seed: int) -> None:
    """Put a poorer reference in the place of a run folder's own."""
    file = folder / "reference.csv"
    reference = np.loadtxt(file, delimiter=",", skiprows=1, ndmin=2)
    poor = POORER[name].change(reference, np.random.default_rng([seed, *folder.name.encode()]))
    lines = ["t_s,x_m,y_m,yaw_rad\n"]
    for row in poor.tolist():
        time, *rest = row
        cells = ["" if math.isnan(value) else f"{value:.6f}" for value in rest]
        lines.append(",".join([f"{time:.6f}", *cells]) + "\n")
    file.write_text("".join(lines), encoding="utf-8")
