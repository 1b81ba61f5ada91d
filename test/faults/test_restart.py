# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The node is killed in mid-drive, started again, and told by set_pose where it was."""

from __future__ import annotations

import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("rclpy")

from geometry_msgs.msg import PoseWithCovarianceStamped

from test.ros.conftest import ROBOT, command
from test.ros.messages import in_plane, yaw_of
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.trajectory import trajectory

MODEL = Robot(0.35, 0.05, 2000.0, 1000.0)
STEPS = [(100, 50)] * 60 + [(-35, 17)] * 40 + [(100, 40)] * 60
"""A line, a spin, an arc; the right encoder has half the counts of the left."""
KILLED_AFTER = 80
MISSED = [(90, 45)] * 10
"""Driven while there is no node."""


def restarted(launched: Any, folder: Path) -> None:
    """Kill the node as the kernel does when memory is short, and start another."""
    launched.process.kill()
    launched.process.wait(10.0)
    launched.process = subprocess.Popen(
        command(folder, ROBOT), stderr=launched._errors, env=launched.environment
    )
    heard = len(launched.diagnostics)
    launched.until(lambda: len(launched.diagnostics) > heard, "diagnostics of the new one", 20.0)


def told(launched: Any, last: Any) -> None:
    """set_pose, and readings at rest, until the odometry comes from there."""
    pose = PoseWithCovarianceStamped(header=last.header, pose=last.pose)
    place = last.pose.pose.position
    for _ in range(50):
        heard = len(launched.odometry)
        launched.set_pose(pose)
        launched.step(0, 0)
        launched.rest(0.1)
        if len(launched.odometry) > heard:
            now = launched.odometry[-1].pose.pose.position
            if abs(now.x - place.x) < 1e-9 and abs(now.y - place.y) < 1e-9:
                return
    raise AssertionError(f"the pose was not taken; {launched.stderr()}")


def of_plane(odometry: Any) -> tuple[np.ndarray, np.ndarray]:
    pose = odometry.pose.pose
    numbers = np.array([pose.position.x, pose.position.y, yaw_of(pose)])
    return numbers, in_plane(odometry.pose.covariance)


def whole(steps: list[tuple[float, float]]) -> tuple[np.ndarray, np.ndarray]:
    """Pose and covariance after a drive that nothing has disturbed."""
    counts = np.cumsum(np.array([(0.0, 0.0), *steps]), axis=0).astype(np.int64)
    path = trajectory(MODEL, 0.02 * np.arange(len(counts)), *counts.T)
    pose = np.array([path.x[-1], path.y[-1], path.yaw[-1]])
    return pose, path.covariance.matrix()[-1]


def test_it_goes_on_as_if_nothing_had_been(launch: Any, tmp_path: Path) -> None:
    launched = launch().begin()
    last = launched.drive(STEPS[:KILLED_AFTER])
    restarted(launched, tmp_path)
    told(launched, last)
    pose, covariance = of_plane(launched.drive(STEPS[KILLED_AFTER:]))
    expected, promised = whole(STEPS)
    difference = pose - expected
    difference[2] = np.remainder(difference[2] + np.pi, 2.0 * np.pi) - np.pi
    assert np.abs(difference).max() < 1e-9
    assert np.abs(covariance - promised).max() < 1e-3 * np.abs(promised).max()


def test_what_was_driven_while_it_was_dead_is_missing_and_nothing_else(
    launch: Any, tmp_path: Path
) -> None:
    launched = launch().begin()
    last = launched.drive(STEPS[:KILLED_AFTER])
    restarted(launched, tmp_path)
    for left, right in MISSED:  # nobody hears these
        launched.left, launched.right = launched.left + left, launched.right + right
    told(launched, last)
    pose, _ = of_plane(launched.drive(STEPS[KILLED_AFTER:]))
    expected, _ = whole(STEPS)
    assert np.abs((pose - expected)[:2]).max() < 1e-9
