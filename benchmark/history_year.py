# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi history` over a year of simulated driving: what it tells, its time and its memory.

A robot whose wheels have white noise (`test.white_noise_robot`) drives some three times a day, half
a minute each, beside a reference of 1 mm and 2 mrad. Its left tyre wears by 0.5 % in the year, its
right one is replaced after 0.58 of the drives by one that is 0.8 % larger, and the marker is
mounted anew after a third of them, 4 mrad to the left and 4 mm back.

The drives, and what `history` keeps of each, stay in FOLDER: whoever stops this can go on with it.

    python benchmark/history_year.py FOLDER [--drives N] [--seconds S]
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import numpy as np

from test.robot_file import BARE
from test.white_noise_robot import WhiteNoiseRobot, drive, wandering

ROBOT = WhiteNoiseRobot(0.35, 0.05, 0.05, 4e-4, 5.8e-4)
ROBOT_FILE = f"{BARE}    left_wheel_noise: 4.0e-4\n    right_wheel_noise: 5.8e-4\n"
BEGAN = 1735689600.0
"""The first of January of 2025 [s]."""
YEAR = 365.0 * 86400.0
WEAR, NEW_TYRE = -5e-3, 8e-3
"""Of the left radius in a year; of the right one from then on."""
REPLACED, REMOUNTED = 0.58, 1.0 / 3.0
"""When, in parts of the year."""
BEFORE, AFTER = (0.001, 0.0), (-0.003, 0.004)
"""The marker: ahead of the axle [m], to the left [rad]."""


def make(folder: Path, number: int, drives: int, seconds: float) -> Path:
    """A drive as a run folder, if it is not there."""
    place = folder / f"drive_{number:05}"
    if place.exists():
        return place
    gone, random = number / drives, np.random.default_rng([1, number])
    robot = replace(
        ROBOT,
        left_radius=ROBOT.left_radius * (1.0 + WEAR * gone),
        right_radius=ROBOT.right_radius * (1.0 + NEW_TYRE * (gone >= REPLACED)),
    )
    run = drive(robot, wandering(random, seconds), random)
    seen, ticks = run.reference, run.ticks
    assert seen is not None
    ahead, left = BEFORE if gone < REMOUNTED else AFTER
    late = BEGAN + YEAR * gone
    made = folder / "being_written"
    made.mkdir(exist_ok=True)
    _table(made / "ticks.csv", "left_ticks,right_ticks", ticks.time + late, ticks.left, ticks.right)
    x, y = seen.x + ahead * np.cos(seen.yaw), seen.y + ahead * np.sin(seen.yaw)
    _table(made / "reference.csv", "x_m,y_m,yaw_rad", seen.time + late, x, y, seen.yaw + left)
    return made.rename(place)


def _table(file: Path, names: str, *columns: np.ndarray) -> None:
    np.savetxt(file, np.column_stack(columns), "%.5f", ",", header=f"t_s,{names}", comments="")


def told(folder: Path, runs: list[Path]) -> str:
    """What `werrimbi history` says of drives, its time and the most memory of a process."""
    words = ["history", "--robot", folder / "robot.yaml", *runs, "--cache", folder / "kept"]
    words += ["--report", folder / "history.html"]
    begun, before = time.perf_counter(), os.times()
    command = [sys.executable, "-m", "werrimbi_odom.cli.main", *map(str, words)]
    child = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert child.stdout is not None
    said = child.stdout.read()
    _, status, used = os.wait4(child.pid, 0)
    assert status == 0, said
    wall, after = time.perf_counter() - begun, os.times()
    cpu = after.children_user + after.children_system
    cpu -= before.children_user + before.children_system
    print(
        f"{len(runs)} drives: {wall:.1f} s, {cpu:.1f} s of CPU, {used.ru_maxrss / 1024.0:.0f} MB",
        flush=True,
    )
    return said


def main() -> None:
    """Measure, and print."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--drives", type=int, default=1000)
    parser.add_argument("--seconds", type=float, default=30.0)
    given = parser.parse_args()
    folder, drives = given.folder, given.drives
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "robot.yaml").write_text(ROBOT_FILE)
    runs = [make(folder, number, drives, given.seconds) for number in range(drives)]
    told(folder, runs[:-1])
    said = told(folder, runs)
    told(folder, runs)
    print(said)


if __name__ == "__main__":
    main()
