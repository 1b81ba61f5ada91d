# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Estimates into messages, at the extremes that no short drive reaches."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest

pytest.importorskip("rclpy")

from builtin_interfaces.msg import Time

from test.ros.messages import assert_covariances, matrix_of, yaw_of
from werrimbi_odom.model.covariance import PoseCovariance, sigmas_along_and_across
from werrimbi_odom.model.odometer import Odometer
from werrimbi_odom.model.pose import Pose
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.ros.diagnostics import length_in_words
from werrimbi_odom.ros.odometry_messages import OdometryMessage

ROBOTS = {
    "usual": Robot(0.35, 0.05, 2000.0, 1000.0),
    "one_sure_wheel": Robot(0.35, 0.05, 2000.0, 2000.0, left_wheel_noise=0.0),
    "no_noise": Robot(0.35, 0.05, 2e6, 2e6, left_wheel_noise=0.0, right_wheel_noise=0.0),
    "noisy": Robot(0.2, 0.05, 500.0, 500.0, left_wheel_noise=0.1, right_wheel_noise=0.1),
    "exact": Robot(0.35, 0.05, 2000.0, 2000.0, covariance_order="exact"),
    "wide": Robot(20.0, 2.0, 500.0, 500.0),
}


@pytest.mark.parametrize("name", ROBOTS)
@pytest.mark.parametrize("far", [1, 10_000])
def test_matrices_are_symmetric_and_semi_definite_for_any_robot_and_drive(
    name: str, far: int
) -> None:
    """Lines and spins, out and back, from millimetres to a hundred kilometres."""
    chance = random.Random(5)
    odometer = Odometer(ROBOTS[name])
    message = OdometryMessage("odom", "base_link")
    left = right = 0
    time = 0.0
    for _ in range(150):
        step = [(far, far), (-far, -far), (far, -far), (far, 0), (0, 0)][chance.randrange(5)]
        for _ in range(chance.randint(1, 6)):
            left, right, time = left + step[0], right + step[1], time + 10.0
            estimate = odometer.update(time, left, right)
            if estimate is None:
                continue
            odometry = message.filled(Time(), estimate)
            assert_covariances(odometry)
            for matrix in map(matrix_of, (odometry.pose.covariance, odometry.twist.covariance)):
                assert np.linalg.eigvalsh(matrix)[0] >= -1e-14 * matrix.max()


def test_far_away_and_back_with_a_heading_that_nobody_knows() -> None:
    """Squares of the way cancel, and leave rounding of either sign in the place of a variance."""
    odometer = Odometer(ROBOTS["no_noise"])
    message = OdometryMessage("odom", "base_link")
    odometer.update(0.0, 0, 0)
    negative, time = 0, 0.0
    for turns in range(1, 60):
        odometer.set_pose(Pose(), PoseCovariance(0.0, 0.0, 0.0, 0.0, 0.0, 1e6))
        far = 12_345_678_901 * turns
        for at in (0.0, 0.3, 1.0, 0.7, 0.2, 0.0):
            time += 10.0
            estimate = odometer.update(time, round(at * far), round(at * 1.0001 * far))
            assert estimate is not None
            negative += min(estimate.covariance.xx, estimate.covariance.yy) < 0.0
            assert_covariances(message.filled(Time(), estimate))
    assert negative, "nothing cancelled: this shows nothing"


def test_a_heading_of_many_turns_is_a_unit_quaternion() -> None:
    odometer = Odometer(ROBOTS["usual"])
    odometer.update(0.0, 0, 0)
    estimate = odometer.update(1000.0, -1_000_000, 500_000)
    assert estimate is not None
    pose = OdometryMessage("odom", "base_link").filled(Time(), estimate).pose.pose
    assert math.hypot(pose.orientation.z, pose.orientation.w) == pytest.approx(1.0, abs=1e-15)
    too_far = math.remainder(yaw_of(pose) - estimate.pose.yaw, 2.0 * math.pi)
    assert too_far == pytest.approx(0.0, abs=1e-9)


def test_sigmas_are_read_in_the_robots_frame() -> None:
    odometer = Odometer(ROBOTS["usual"])
    odometer.update(0.0, 0, 0)
    estimate = odometer.update(1.0, 2000, 1000)
    assert estimate is not None
    covariance = estimate.covariance
    along, across = sigmas_along_and_across(covariance, 0.0)
    assert (along, across) == (math.sqrt(covariance.xx), math.sqrt(covariance.yy))
    assert sigmas_along_and_across(covariance, 0.5 * math.pi) == pytest.approx((across, along))


@pytest.mark.parametrize(
    ("length", "words"),
    [(0.0, "0.0 mm"), (0.00123, "1.2 mm"), (0.5, "500.0 mm"), (12.3456, "12.346 m")],
)
def test_lengths_in_words(length: float, words: str) -> None:
    assert length_in_words(length) == words
