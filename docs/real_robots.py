# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Calibration judged on real robots: prints the table of docs/real_robots.md.

Every figure is over legs of drives that took no part in the calibration.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

import numpy as np

from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.calibration.any_driving import Calibration, calibrate
from werrimbi_odom.inference.calibration.recorded_square import (
    SquareRecording,
    recorded_square,
    squares_of,
)
from werrimbi_odom.inference.calibration.umbmark import corrected, umbmark
from werrimbi_odom.inference.comparison.leg_errors import LegErrors, errors_of, statistics
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.free_parameters import Model
from werrimbi_odom.inference.legs.cutting import match
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.trajectory import trajectory

ROOT = Path(__file__).parents[1]
ROBOTS = Path(os.environ.get("WERRIMBI_DATA", ROOT / "recordings")) / "robots"


@dataclass(frozen=True, slots=True)
class Case:
    """A robot, the drives it is calibrated on, and those it is judged on."""

    robot: str
    told: str
    train: str
    holdout: str
    leg: float
    kind: Literal["absolute", "incremental"]


CASES = (
    Case("optitrack_robot", "OptiTrack robot", "square_*", "free_*", 0.5, "absolute"),
    Case(
        "khepera_laser_to_the_side",
        "Khepera, laser to the side",
        "part_[01]",
        "part_2",
        0.1,
        "incremental",
    ),
    Case("khepera_laser_moved", "Khepera, laser moved", "part_[01]", "part_2", 0.1, "incremental"),
)


def umbmark_of_drives(case: Case) -> Robot:
    """The paper's procedure on the recorded squares."""
    robot_file = read_robot_file(ROBOTS / case.robot / "robot.yaml")
    records = []
    for path in sorted((ROBOTS / case.robot).glob(case.train)):
        run = read_run(path, robot_file)
        assert run.reference is not None
        ticks, seen = run.ticks, run.reference
        records.append(
            recorded_square(
                SquareRecording(
                    run.name,
                    ticks.time,
                    ticks.left,
                    ticks.right,
                    seen.time,
                    seen.x,
                    seen.y,
                    seen.yaw,
                ),
                robot_file.robot,
                1.7,
            )
        )
    result = umbmark(squares_of(records, 1.7), robot_file.robot)
    return corrected(robot_file.robot, result.factors)


def fitted(case: Case) -> Calibration:
    """Maximum likelihood on the training drives."""
    robot_file = read_robot_file(ROBOTS / case.robot / "robot.yaml")
    paths = sorted((ROBOTS / case.robot).glob(case.train))
    runs = [
        match(
            read_run(path, robot_file),
            robot_file.robot,
            case.leg / rules.PARTS_OF_A_LEG,
            turn=rules.QUARTER_TURN / rules.PARTS_OF_A_LEG,
        )
        for path in paths
    ]
    return calibrate(runs, robot_file.robot, EvaluationOptions(reference_kind=case.kind))


def judged(case: Case, robot: Robot, sigma_xy: float, sigma_yaw: float) -> LegErrors:
    """Legs of the held-out drives, cut alike for every robot."""
    robot_file = read_robot_file(ROBOTS / case.robot / "robot.yaml")
    runs = concatenated(
        [
            match(read_run(path, robot_file), robot_file.robot, case.leg)
            for path in sorted((ROBOTS / case.robot).glob(case.holdout))
        ]
    )
    model = Model(robot, ({},) * len(runs.runs))
    return errors_of(model, runs, sigma_xy, sigma_yaw, case.kind)


def row(told: str, method: str, legs: LegErrors, noise: str, verdict: str) -> str:
    """One line of the table."""
    figures = statistics(legs)
    spread = np.percentile(legs.distance, 90)
    return (
        f"| {told} | {method} | {figures.count} | {1e3 * figures.median_position_m:.1f} "
        f"| {1e3 * figures.rmse_position_m:.1f} | {1e3 * spread:.1f} "
        f"| {figures.nees:.1f} | {figures.coverage_95:.0%} | {noise} | {verdict} |"
    )


def table() -> str:
    """The whole table in Markdown."""
    lines = [
        "| robot | calibration | held-out legs | median (mm) | rms (mm) | 90 % (mm) | NEES "
        "| inside 95 % | k_L, k_R (m^½) | what the tool says |",
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    for case in CASES:
        result = fitted(case)
        sigmas = [result.noises[f"reference_sigma_{name}"].value for name in ("xy", "yaw")]
        given = read_robot_file(ROBOTS / case.robot / "robot.yaml").robot
        methods: list[tuple[str, Robot, str]] = [("none", given, "")]
        if case.robot == "optitrack_robot":
            methods.append(("UMBmark, 6 squares", umbmark_of_drives(case), ""))
        says = "explained" if result.trusted else "something else is missing"
        methods.append(("maximum likelihood", result.robot, says))
        for method, robot, verdict in methods:
            noise = f"{robot.left_wheel_noise:.1e}, {robot.right_wheel_noise:.1e}"
            legs = judged(case, robot, *sigmas)
            lines.append(row(case.told, method, legs, noise, verdict))
    return "\n".join(lines)


def part_of(run: Run, begin: float, end: float) -> Run:
    """A run between two times [s]."""
    ticks, seen = run.ticks, run.reference
    assert seen is not None
    rows = (ticks.time >= begin) & (ticks.time <= end)
    known = (seen.time >= begin) & (seen.time <= end)
    return replace(
        run,
        ticks=replace(ticks, time=ticks.time[rows], left=ticks.left[rows], right=ticks.right[rows]),
        reference=replace(
            seen, time=seen.time[known], x=seen.x[known], y=seen.y[known], yaw=seen.yaw[known]
        ),
    )


def whole_error(robot: Robot, run: Run) -> float:
    """Root mean square of the position over a drive, its start pose fitted [m]."""
    seen = run.reference
    assert seen is not None
    path = trajectory(robot, run.ticks.time, run.ticks.left, run.ticks.right)
    there = np.interp(seen.time, path.time, path.x) + 1j * np.interp(seen.time, path.time, path.y)
    measured = seen.x + 1j * seen.y
    there, measured = there - there.mean(), measured - measured.mean()
    turned = there * np.exp(1j * np.angle(np.sum(np.conj(there) * measured)))
    return float(np.sqrt(np.mean(np.abs(measured - turned) ** 2)))


def labyrinth() -> str:
    """The robot whose reference has positions alone: first 20 s to fit, the rest to judge."""
    robot_file = read_robot_file(ROBOTS / "labyrinth" / "robot.yaml")
    run = read_run(ROBOTS / "labyrinth" / "drive", robot_file)
    begin, end = float(run.ticks.time[0]), float(run.ticks.time[-1])
    cut = begin + 20.0
    train = match(part_of(run, begin, cut), robot_file.robot, 0.25, turn=0.25 * rules.QUARTER_TURN)
    result = calibrate([train], robot_file.robot)
    rest = part_of(run, cut, end)
    before, after = (whole_error(robot, rest) for robot in (robot_file.robot, result.robot))
    says = "explained" if result.trusted else "something else is missing"
    return (
        f"| Labyrinth robot | {end - cut:.0f} s | {1e3 * before:.0f} | {1e3 * after:.0f} "
        f"| {result.robot.wheel_separation_multiplier:.3f} | {says} |"
    )


if __name__ == "__main__":
    print(table())
    print()
    print("| robot | held out | rms before (mm) | rms after (mm) | base × | what the tool says |")
    print("| --- | --- | --- | --- | --- | --- |")
    print(labyrinth())
