# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Seconds for a diagnosis of an hour of driving at 50 Hz, against a quarter of an hour.

Both are drives of five minutes through the physics engine with a reference at 20 Hz, made once and
kept for this call alone. All effects of the library are candidates. Growth of 4 is linear. Linear
algebra has one thread, as in `werrimbi diagnose`.

Then what a diagnosis asks for most often, all legs of the hour predicted with their noise, against
the same in plain Python, tick by tick; both must say the same.

    python benchmark/diagnosis_hour.py [--hide EFFECT[=STRENGTH]]
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from benchmark.per_tick import PerTick
from werrimbi_odom.api.one_blas_thread import with_one_blas_thread
from werrimbi_odom.effects.library import LIBRARY
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.free_parameters import Model
from werrimbi_odom.inference.fitting.prediction import predict_all
from werrimbi_odom.inference.legs.cutting import match_for_fit
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.simulation import (
    TrueRobot,
    free,
    hide,
    record,
    write_robot_file,
    write_run,
)

DRIVE = 300.0
"""Of one drive [s]."""

DRIVES = 12
"""An hour of them."""

LIMIT = 15.0
"""The hour's diagnosis should take less on 2 idle cores [s]."""

ROBOT = TrueRobot(left_wheel_noise=4.0e-4, right_wheel_noise=5.8e-4)


def drive(folder: Path, number: int, wish: str, seconds: float = DRIVE) -> Path:
    """One drive, written as a run folder."""
    name, _, strength = wish.partition("=")
    odd = []
    if name:
        odd.append(hide(name, float(strength) if strength else None, seed=1).peculiarity)
    speed = 0.4 if number % 2 else 0.8
    manoeuvre = free(seconds, seed=number, speed=speed, yaw_rate=2.5 * speed, acceleration=speed)
    recording = record(ROBOT, manoeuvre, seed=100 + number, hidden=odd)
    return write_run(recording, folder / f"drive_{number:02}")


def main() -> None:
    """Measure, and print."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--hide", default="castor_kick=0.01", help="what is hidden; '' for nothing")
    wish = parser.parse_args().hide
    cores = os.cpu_count() or 1
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        file = read_robot_file(write_robot_file(ROBOT, folder / "robot.yaml"))
        with ProcessPoolExecutor(cores) as pool:
            jobs = [pool.submit(drive, folder, number, wish) for number in range(DRIVES)]
            runs = [read_run(job.result(), file) for job in jobs]
    rows = sum(run.ticks.rows for run in runs)
    print(f"{rows} readings of the counters in {DRIVES} drives; hidden: {wish or 'nothing'}")
    print(f"{'driving':>9} {'wall':>8} {'CPU':>8}  verdict, on {cores} cores")
    walls, cpus = [], []
    for count in (DRIVES // 4, DRIVES):
        wall, cpu = time.perf_counter(), time.process_time()
        found = with_one_blas_thread(diagnose)(
            runs[:count], file.robot, LIBRARY, EvaluationOptions(limits=file.limits)
        )
        wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
        walls.append(wall)
        cpus.append(cpu)
        minutes = count * DRIVE / 60.0
        said = f"{found.verdict} {', '.join(found.found)}"
        print(f"{minutes:5.0f} min {wall:6.1f} s {cpu:6.1f} s  {said}", flush=True)
    growth = f"{walls[1] / walls[0]:.1f} (CPU {cpus[1] / cpus[0]:.1f})"
    print(f"growth {growth} for 4 times as much; limit {LIMIT:.0f} s")
    if walls[1] > LIMIT:
        print("over the limit (was the machine idle?)", file=sys.stderr)
    print(legs_predicted(file.robot, runs))


def legs_predicted(robot: Robot, runs: list[Run]) -> str:
    """Seconds for one prediction of all legs, by the package and by plain Python."""
    laid = concatenated(match_for_fit(runs, robot, 1.0))
    model = Model(robot, tuple({} for _ in runs))
    begun = time.perf_counter()
    ours = predict_all(model, laid)
    middle = time.perf_counter()
    plain = []
    raw = laid.raw(robot)
    left, right = raw.left.tolist(), raw.right.tolist()
    for begin, end in zip(laid.begin.tolist(), laid.end.tolist(), strict=True):
        state = PerTick(robot)
        for step in range(begin, end):
            state.roll(left[step], right[step])
        plain.append((state.x, state.y, state.yaw, state.covariance.yawyaw))
    ended = time.perf_counter()
    found = np.column_stack(
        [
            ours.relative,
            ours.per_left[:, 2, 2] * robot.left_wheel_noise**2
            + ours.per_right[:, 2, 2] * robot.right_wheel_noise**2,
        ]
    )
    worst = float(np.max(np.abs(found - np.array(plain))))
    assert worst < 1e-9, f"the two differ by {worst:g}"
    fast, slow = middle - begun, ended - middle
    return (
        f"all {laid.count} legs predicted, with noise: {1e3 * fast:.0f} ms; tick by tick in plain "
        f"Python {1e3 * slow:.0f} ms, {slow / fast:.0f} times as long (same to {worst:.0e})"
    )


if __name__ == "__main__":
    main()
