# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`covariance_order: exact` in the live node: another covariance, the same pose, a shift told."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

pytest.importorskip("rclpy")

from diagnostic_msgs.msg import DiagnosticStatus

from test.ros.messages import in_plane, values_of
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.trajectory import trajectory

NOISY = Robot(0.35, 0.05, 2000.0, 1000.0, left_wheel_noise=0.05, right_wheel_noise=0.05)


def test_the_node_publishes_exact_moments_about_its_pose(
    launch: Callable[..., Any], robot: dict[str, Any]
) -> None:
    noise = {"left_wheel_noise": 0.05, "right_wheel_noise": 0.05, "covariance_order": "exact"}
    node = launch(robot | noise).begin()
    told = node.keep(DiagnosticStatus, "odom_node/status")
    time, left, right = [node.now], [node.left], [node.right]
    node.odometry.clear()
    for _ in range(120):
        node.step(100.0, 52.0)
        time.append(node.now)
        left.append(node.left)
        right.append(node.right)
    last = node.last()
    node.rest(0.5)
    counts = np.array(time), np.array(left), np.array(right)
    exact = trajectory(replace(NOISY, covariance_order="exact"), *counts)
    first = trajectory(NOISY, *counts)
    published = in_plane(last.pose.covariance)
    assert published == pytest.approx(exact.covariance.matrix()[-1], rel=1e-6, abs=1e-12)
    assert last.pose.pose.position.x == pytest.approx(first.x[-1], abs=1e-9)
    assert np.abs(published - first.covariance.matrix()[-1]).max() > 0.02 * published.max()
    assert exact.mean_shift is not None
    shift = values_of(told[-1])["mean shift"]
    x, y = (float(number) for number in re.findall(r"[+-][\d.]+", shift))
    assert x == pytest.approx(1e3 * exact.mean_shift[0][-1], abs=0.06)
    assert y == pytest.approx(1e3 * exact.mean_shift[1][-1], abs=0.06)
    assert "not applied" in shift
