# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Dead reckoning begins at the reference's first pose, also where that is not there in one row."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from werrimbi_odom.files.references.start_pose import start_of, start_pose
from werrimbi_odom.files.robot_files.robot_file import RobotFile
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.model.pose import Pose
from werrimbi_odom.model.trajectory import trajectory

TRUE = Pose(3.0, -2.0, 1.2)
"""Where the robot below was at the first row."""


@pytest.fixture
def file(robot: Any) -> RobotFile:
    made: RobotFile = robot()
    return made


def drive(file: RobotFile, yaw: bool = True) -> Run:
    """An arc, a spin, another arc, and a perfect reference at each row."""
    left = np.concatenate([np.arange(0, 3000, 20), np.arange(3000, 2000, -20)])
    left = np.concatenate([left, np.arange(2000, 5000, 20)])
    right = 2 * np.concatenate([np.arange(0, 4500, 30), np.arange(4500, 5500, 20)])
    right = np.concatenate([right, 2 * np.arange(5500, 7000, 10)])
    time = 10.0 + 0.02 * np.arange(left.size)
    true = trajectory(file.robot, time, left, right, start=TRUE)
    heading = true.yaw if yaw else np.full(time.size, np.nan)
    return Run(
        "arcs", Path("arcs"), Ticks(time, left, right), Reference(time, true.x, true.y, heading)
    )


def with_reference(run: Run, rows: Any, **parts: Any) -> Run:
    """The run with only some rows of its reference, of which some values are not known."""
    reference = run.reference
    assert reference is not None
    values = {name: getattr(reference, name)[rows].copy() for name in ("time", "x", "y", "yaw")}
    for name, unknown in parts.items():
        values[name][unknown] = np.nan
    return Run(run.name, run.path, run.ticks, Reference(**values))


def test_the_first_row_as_it_stands(file: RobotFile) -> None:
    start = start_of(drive(file), file)
    assert start.pose == TRUE
    assert start.told == "the reference's first pose"
    assert start_pose(drive(file), file) == TRUE


def test_without_a_reference_the_origin(file: RobotFile) -> None:
    run = drive(file)
    assert start_pose(Run(run.name, run.path, run.ticks), file) == Pose()
    unknown = with_reference(run, slice(None), x=slice(None), y=slice(None), yaw=slice(None))
    assert start_pose(unknown, file) == Pose()


def test_a_heading_that_was_never_measured_is_fitted(file: RobotFile) -> None:
    start = start_of(drive(file, yaw=False), file)
    np.testing.assert_allclose(start.pose, TRUE, atol=1e-12)
    assert "least squares" in start.told


def test_the_fitted_heading_is_that_of_least_squares(file: RobotFile) -> None:
    run = drive(file, yaw=False)
    reference = run.reference
    assert reference is not None
    noise = np.random.default_rng(5).normal(0.0, 0.05, (2, reference.time.size))
    noise[:, 0] = 0.0
    noisy = Reference(reference.time, reference.x + noise[0], reference.y + noise[1], reference.yaw)
    fitted = start_pose(Run(run.name, run.path, run.ticks, noisy), file)

    def cost(yaw: float) -> float:
        start = Pose(TRUE.x, TRUE.y, yaw)
        path = trajectory(file.robot, run.ticks.time, run.ticks.left, run.ticks.right, start=start)
        return float(np.sum((path.x - noisy.x) ** 2 + (path.y - noisy.y) ** 2))

    best = cost(fitted.yaw)
    assert best < cost(fitted.yaw + 1e-4)
    assert best < cost(fitted.yaw - 1e-4)
    assert abs(fitted.yaw - TRUE.yaw) < 0.02


def test_start_and_end_by_tape_are_enough(file: RobotFile) -> None:
    run = with_reference(drive(file, yaw=False), [0, -1])
    np.testing.assert_allclose(start_pose(run, file), TRUE, atol=1e-12)


def test_a_heading_that_comes_later_is_brought_back(file: RobotFile) -> None:
    run = with_reference(drive(file), slice(None), yaw=slice(0, 200))
    np.testing.assert_allclose(start_pose(run, file), TRUE, atol=1e-12)


def test_a_position_that_comes_later_is_brought_back(file: RobotFile) -> None:
    run = with_reference(drive(file), slice(None), x=slice(0, 200), y=slice(0, 200))
    np.testing.assert_allclose(start_pose(run, file), TRUE, atol=1e-12)


def test_a_heading_alone_starts_at_the_origin(file: RobotFile) -> None:
    run = with_reference(drive(file), slice(None), x=slice(None), y=slice(None))
    np.testing.assert_allclose(start_pose(run, file), (0.0, 0.0, TRUE.yaw), atol=1e-12)


def test_without_travel_no_heading_can_be_fitted(file: RobotFile) -> None:
    run = with_reference(drive(file, yaw=False), [0])
    start = start_of(run, file)
    assert start.pose == Pose(TRUE.x, TRUE.y, 0.0)
    assert "heading 0" in start.told
