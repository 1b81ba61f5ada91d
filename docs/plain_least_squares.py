# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What the tool leaves on real robots beside plain least squares: prints a table of real_robots.md.

    python docs/plain_least_squares.py [ROBOT...]

Both learn from the same drives and are judged on the same legs of the same other ones; no leg is
left out. The least squares are scipy's, of a dead reckoning of their own: base, a factor for each
wheel (where headings alone are measured one base is kept: they tell the factors over it), and one
delay of the reference. Some minutes a robot.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from case_book import BOOK
from follow_advice import ROBOTS, Case, drives_of, followed, predicted, werrimbi
from scipy.optimize import least_squares

from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.legs.cutting import match
from werrimbi_odom.model.robot import Robot

ASKED = ("kobuki_sound", "kobuki_left_taped", "kobuki_right_taped", "upenn_skid_gyro")
SHORT = 0.25
"""Legs that are fitted, of those that are judged: a delay is seen within a turn."""
DELAYS = (0.0, 0.06, 0.12)
"""Where the fit begins [s]."""
Path3 = tuple[np.ndarray, np.ndarray, np.ndarray]
"""Times [s], places as complex numbers [m], headings [rad]."""


@dataclass(frozen=True)
class Legs:
    """What was measured over the legs of a drive, and its wheels' way."""

    drive: Path
    begin: np.ndarray
    end: np.ndarray
    moved: np.ndarray
    """As seen from where the leg begins, complex [m]; NaN where headings alone are measured."""
    turned: np.ndarray
    time: np.ndarray
    left: np.ndarray
    right: np.ndarray


def change(path: Path3, begin: np.ndarray, end: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """How far a path goes and turns between two times, as seen from the first."""
    time, place, yaw = path
    ends = [
        (np.interp(at, time, place.real) + 1j * np.interp(at, time, place.imag),
         np.interp(at, time, yaw))
        for at in (begin, end)
    ]  # fmt: skip
    (here, heading), (there, after) = ends
    return (there - here) * np.exp(-1j * heading), after - heading


def legs_of(drive: Path, robot: Robot, share: float) -> Legs:
    """Legs of this share of a metre or a quarter turn, by the robot file as it was given."""
    run = read_run(drive, read_robot_file(drive.parent / "robot.yaml"))
    matched = match(run, robot, share, turn=share * rules.QUARTER_TURN)
    seen, ticks = matched.measured, run.ticks.unwrapped(robot.encoder_bits)
    path = (seen.time, seen.x + 1j * seen.y, np.unwrap(seen.yaw))
    begin, end = (part[~matched.gap] for part in (seen.time[:-1], seen.time[1:]))
    return Legs(drive, begin, end, *change(path, begin, end), ticks.time, ticks.left, ticks.right)


def reckoned(legs: Legs, robot: Robot, left: float, right: float, base: float) -> Path3:
    """Dead reckoning from the counts, by factors of the wheels and of the base."""
    ways = [
        factor * tick * (counts - counts[0])
        for factor, tick, counts in (
            (left, robot.left_tick, legs.left),
            (right, robot.right_tick, legs.right),
        )
    ]
    yaw = (ways[1] - ways[0]) / (base * robot.wheel_separation)
    middle = np.exp(0.5j * (yaw[1:] + yaw[:-1]))
    steps = 0.5 * np.diff(ways[0] + ways[1]) * middle
    return legs.time, np.concatenate([[0.0], np.cumsum(steps)]), yaw


def off(legs: Legs, path: Path3, delay: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Errors of the legs: places [m] and headings [rad]."""
    moved, turned = change(path, legs.begin - delay, legs.end - delay)
    return np.abs(legs.moved - moved), np.angle(np.exp(1j * (legs.turned - turned)))


def plain(drives: Sequence[Legs], robot: Robot) -> tuple[float, float, float, float]:
    """Left and right factor, base and delay [s] of least squares."""
    places = all(np.isfinite(legs.moved).all() for legs in drives)

    def errors(x: np.ndarray) -> np.ndarray:
        parts = []
        for legs in drives:
            path = reckoned(legs, robot, x[0], x[1], x[3] if places else 1.0)
            moved, turned = change(path, legs.begin - x[2], legs.end - x[2])
            parts.append(np.angle(np.exp(1j * (legs.turned - turned))))
            if places:
                apart = legs.moved - moved
                parts += [apart.real, apart.imag]
        return np.concatenate(parts)

    # Headings of wheels that skid are beyond half a turn off at first: begin at several bases.
    begins = [
        [over, over, delay, 1.0] if not places else [1.0, 1.0, delay, 1.0 / over]
        for delay in DELAYS
        for over in (1.0, 0.5)
    ]
    fits = [
        least_squares(errors, begin[: 3 + places], x_scale=[0.01, 0.01, 0.01, 0.01][: 3 + places])
        for begin in begins
    ]
    left, right, delay, *base = min(fits, key=lambda fit: fit.cost).x.tolist()
    return left, right, base[0] if base else 1.0, delay


def told_by(file: Path, legs: Legs, folder: Path) -> Path3:
    """The path that a robot file predicts for the reference."""
    rows = predicted(legs.drive, file, folder)
    return rows["t_s"], rows["x_m"] + 1j * rows["y_m"], np.unwrap(rows["yaw_rad"])


def figures(errors: Sequence[tuple[np.ndarray, np.ndarray]]) -> str:
    """Root mean square and median of the places, if they are measured, and of the headings."""
    places, headings = (np.abs(np.concatenate(part)) for part in zip(*errors, strict=True))
    told = []
    if np.isfinite(places).all():
        told = [f"{1e3 * np.sqrt(np.mean(places**2)):.0f} mm ({1e3 * np.median(places):.0f})"]
    degrees = np.degrees(headings)
    told += [f"{np.sqrt(np.mean(degrees**2)):.2f}° ({np.median(degrees):.2f})"]
    return ", ".join(told)


def factors_told(left: float, right: float, base: float, delay: float, *, places: bool) -> str:
    """What least squares find, as the tool would say it."""
    radii = f", radii × {0.5 * (left + right):.3f}" if places else ""
    over = 2.0 * base / (left + right)
    return (
        f"base × {base if places else over:.3f}{radii}, right over left {right / left:.4f}, "
        f"delay {1e3 * delay:.0f} ms"
    )


def fitted(case: Case, folder: Path) -> tuple[Path, Path]:
    """The robot files of `calibrate fit`, and of the last of the commands that are printed."""
    fit = folder / "fit.yaml"
    drives = (*drives_of(case, case.fitted), *case.options)
    given = str(ROBOTS / case.robot / "robot.yaml")
    done = werrimbi("calibrate", "fit", "--robot", given, *drives, "--out", str(fit))
    assert done.returncode == 0, done.stderr
    return fit, followed(case, folder)[-1].robot


def row(case: Case) -> str:
    """One line of the table."""
    given = ROBOTS / case.robot / "robot.yaml"
    robot = read_robot_file(given).robot
    train = [legs_of(Path(each), robot, SHORT) for each in drives_of(case, case.fitted)]
    judged = [legs_of(Path(each), robot, 1.0) for each in drives_of(case, case.judged)]
    *factors, delay = plain(train, robot)
    by_hand = figures([off(each, reckoned(each, robot, *factors), delay) for each in judged])
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        files = (given, *fitted(case, folder))
        ours = [
            figures([off(each, told_by(file, each, folder)) for each in judged]) for file in files
        ]
    count = sum(each.turned.size for each in judged)
    places = all(np.isfinite(each.moved).all() for each in judged)
    found = factors_told(*factors, delay, places=places)
    return (
        f"| `{case.robot}` | {', '.join(case.judged)}, {count} | {ours[0]} | {by_hand} "
        f"| {ours[1]} | {ours[2]} | {found} |"
    )


if __name__ == "__main__":
    print("| robot | held out, legs | file as given | plain least squares | `calibrate fit` "
          "| printed commands followed | least squares find |")  # fmt: skip
    print("| --- | --- | --- | --- | --- | --- | --- |")
    for each in BOOK:
        if each.robot in (sys.argv[1:] or ASKED):
            print(row(each), flush=True)
