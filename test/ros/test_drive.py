# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A drive through the real node: pose, covariances, stamps, frames."""

from __future__ import annotations

import math
import random
from typing import Any

import numpy as np
import pytest

pytest.importorskip("rclpy")

from test.ros.messages import in_plane, matrix_of, seconds_of, yaw_of
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.trajectory import Trajectory, trajectory

ROBOT = Robot(0.35, 0.05, 2000.0, 1000.0)

SQUARE = [(100, 50)] * 60 + [(-50, 25)] * 18 + [(100, 50)] * 60
MANOEUVRES = [
    *SQUARE,
    *[(80, 50)] * 60,  # an arc to the left
    *[(0, 40)] * 30,  # a pivot about the left wheel
    *[(-60, -30)] * 40,  # back
    *[(0, 0)] * 10,
]


def random_drive(seed: int, readings: int) -> list[tuple[int, int]]:
    """Wheels that go their own ways, with stops and reversals."""
    chance = random.Random(seed)
    steps: list[tuple[int, int]] = []
    while len(steps) < readings:
        left, right = chance.randint(-120, 120), chance.randint(-60, 60)
        if chance.random() < 0.2:
            left = right = 0
        steps += [(left, right)] * chance.randint(1, 25)
    return steps[:readings]


def recorded(node: Any, steps: list[tuple[float, float]]) -> tuple[list[Any], Trajectory]:
    """Odometry of a drive from the origin, and the model's answer to the same counters."""
    node.reset()
    node.odometry.clear()
    time, left, right = [node.now], [node.left], [node.right]
    for step in steps:
        node.step(*step)
        time.append(node.now)
        left.append(node.left)
        right.append(node.right)
    node.last()
    counts = np.array(left, dtype=np.int64), np.array(right, dtype=np.int64)
    return list(node.odometry), trajectory(ROBOT, np.array(time), *counts)


@pytest.mark.parametrize("steps", [MANOEUVRES, random_drive(1, 300)], ids=["planned", "random"])
def test_every_message_is_what_the_model_says(node: Any, steps: list[tuple[int, int]]) -> None:
    messages, model = recorded(node, steps)
    assert len(messages) == len(steps)
    expected = model.covariance.matrix()
    for row, message in enumerate(messages, start=1):
        position = message.pose.pose.position
        assert position.x == pytest.approx(model.x[row], abs=1e-9)
        assert position.y == pytest.approx(model.y[row], abs=1e-9)
        turned = math.remainder(yaw_of(message.pose.pose) - model.yaw[row], 2.0 * math.pi)
        assert turned == pytest.approx(0.0, abs=1e-9)
        got = in_plane(message.pose.covariance)
        np.testing.assert_allclose(got, expected[row], rtol=1e-9, atol=1e-9 * expected[row].max())
        assert seconds_of(message) == pytest.approx(model.time[row], abs=1e-9)
        assert (message.header.frame_id, message.child_frame_id) == ("odom", "base_link")


def test_twist_is_the_motion_of_the_last_interval(node: Any) -> None:
    message = node.drive([(0, 0), (100, 80)])
    left, right = 100 * ROBOT.left_tick, 80 * ROBOT.right_tick
    twist = message.twist.twist
    assert twist.linear.x == pytest.approx(0.5 * (left + right) / 0.02, rel=1e-9)
    assert twist.linear.y == 0.0
    assert twist.angular.z == pytest.approx((right - left) / 0.35 / 0.02, rel=1e-9)
    left_variance = 4.0e-4**2 * left + ROBOT.left_tick**2 / 6.0
    right_variance = 5.8e-4**2 * right + ROBOT.right_tick**2 / 6.0
    covariance = matrix_of(message.twist.covariance)
    total = (left_variance + right_variance) / 0.02**2
    assert covariance[0, 0] == pytest.approx(0.25 * total, rel=1e-9)
    assert covariance[5, 5] == pytest.approx(total / 0.35**2, rel=1e-9)
    difference = (right_variance - left_variance) / 0.02**2
    assert covariance[0, 5] == pytest.approx(0.5 * difference / 0.35, rel=1e-9)
    assert covariance[1, 1] == covariance[0, 0]


def test_covariances_are_symmetric_and_semi_definite_always(node: Any) -> None:
    messages, _ = recorded(node, random_drive(2, 400) + SQUARE)
    for message in messages:
        for covariance in (matrix_of(message.pose.covariance), matrix_of(message.twist.covariance)):
            assert (covariance == covariance.T).all()
            assert np.linalg.eigvalsh(covariance)[0] >= -1e-15 * covariance.max()
            assert (covariance.diagonal()[2:5] == 1e-6).all()
            assert not covariance[2:5, [0, 1, 5]].any()


def test_nothing_is_measured_out_of_the_plane(node: Any) -> None:
    message = node.drive([(100, 50)])
    pose, twist = message.pose.pose, message.twist.twist
    assert (pose.position.z, pose.orientation.x, pose.orientation.y) == (0.0, 0.0, 0.0)
    assert (twist.linear.z, twist.angular.x, twist.angular.y) == (0.0, 0.0, 0.0)


def test_no_covariance_grows_at_rest_and_none_is_lost_by_a_stop(node: Any) -> None:
    moving = [(100, 50)] * 40 + [(70, 50)] * 40
    straight_through = matrix_of(recorded(node, moving)[0][-1].pose.covariance)
    with_stops = moving[:15] + [(0, 0)] * 50 + moving[15:55] + [(0, 0)] * 50 + moving[55:]
    messages, _ = recorded(node, with_stops)
    at_rest = [matrix_of(message.pose.covariance) for message in messages[15:64]]
    assert all((covariance == at_rest[0]).all() for covariance in at_rest)
    assert at_rest[0][0, 0] > 0.0
    np.testing.assert_allclose(
        matrix_of(messages[-1].pose.covariance), straight_through, rtol=1e-9, atol=1e-18
    )


def test_a_count_that_flickers_at_rest_is_no_travel(node: Any) -> None:
    node.reset()
    before = matrix_of(node.drive([(100, 50)] * 20).pose.covariance)
    after = matrix_of(node.drive([(1, 0), (-1, 0)] * 100).pose.covariance)
    np.testing.assert_allclose(after, before, rtol=1e-9, atol=1e-18)


def test_backwards_is_as_uncertain_as_forwards(node: Any) -> None:
    forwards = matrix_of(recorded(node, [(100, 50)] * 50)[0][-1].pose.covariance)
    backwards = matrix_of(recorded(node, [(-100, -50)] * 50)[0][-1].pose.covariance)
    np.testing.assert_allclose(backwards.diagonal(), forwards.diagonal(), rtol=1e-9)
