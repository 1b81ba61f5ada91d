# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The wheels' noise is of the size that was asked for, white, and independent."""

from __future__ import annotations

import numpy as np
import pytest

from werrimbi_odom.simulation import TrueRobot, free, record

K_LEFT, K_RIGHT = 4.0e-4, 5.8e-4


@pytest.fixture(scope="module")
def errors() -> tuple[np.ndarray, np.ndarray]:
    """Errors of both wheels over the square root of their path, stride by stride."""
    robot = TrueRobot(left_wheel_noise=K_LEFT, right_wheel_noise=K_RIGHT)
    drives = [record(robot, free(60.0, seed=s), seed=s) for s in (1, 2)]
    both = [wheel_errors(drive.true_path, robot) for drive in drives]
    left, right = (np.concatenate(parts) for parts in zip(*both, strict=True))
    return left, right


def wheel_errors(path, robot: TrueRobot) -> tuple[np.ndarray, np.ndarray]:
    left = np.diff(path.left_angle_rad) * robot.left_wheel_radius
    right = np.diff(path.right_angle_rad) * robot.right_wheel_radius
    turn = np.diff(path.yaw_rad)
    ahead = path.yaw_rad[:-1] + turn / 2
    along = np.cos(ahead) * np.diff(path.x_m) + np.sin(ahead) * np.diff(path.y_m)
    half = robot.wheel_separation / 2
    moving = (np.abs(left) > 1e-4) & (np.abs(right) > 1e-4)  # at rest there is no noise to see
    left_error, right_error = along - half * turn - left, along + half * turn - right
    return (
        left_error[moving] / np.sqrt(np.abs(left[moving])),
        right_error[moving] / np.sqrt(np.abs(right[moving])),
    )


def test_size(errors: tuple[np.ndarray, np.ndarray]) -> None:
    left, right = errors
    five_sigma = 5 / np.sqrt(2 * len(left))
    assert np.sqrt(np.mean(left**2)) == pytest.approx(K_LEFT, rel=five_sigma)
    assert np.sqrt(np.mean(right**2)) == pytest.approx(K_RIGHT, rel=five_sigma)


def test_unbiased_white_and_independent(errors: tuple[np.ndarray, np.ndarray]) -> None:
    left, right = (e / e.std() for e in errors)
    five_sigma = 5 / np.sqrt(len(left))
    assert abs(left.mean()) < five_sigma
    assert abs(right.mean()) < five_sigma
    assert abs(np.mean(left[1:] * left[:-1])) < five_sigma
    assert abs(np.mean(right[1:] * right[:-1])) < five_sigma
    assert abs(np.mean(left * right)) < five_sigma


def test_noise_moves_the_robot_but_not_its_wheels() -> None:
    quiet = record(TrueRobot(), free(20.0, seed=1), seed=1)
    noisy = record(
        TrueRobot(left_wheel_noise=K_LEFT, right_wheel_noise=K_RIGHT), free(20.0, seed=1), seed=1
    )
    np.testing.assert_allclose(
        quiet.true_path.left_angle_rad, noisy.true_path.left_angle_rad, atol=1e-6
    )
    assert np.abs(quiet.true_path.yaw_rad - noisy.true_path.yaw_rad).max() > 1e-3


def test_no_noise_at_rest() -> None:
    robot = TrueRobot(left_wheel_noise=K_LEFT, right_wheel_noise=K_RIGHT)
    path = record(robot, free(20.0, seed=1), seed=1).true_path
    rest = path.t_s < 0.5
    assert np.ptp(path.x_m[rest]) < 1e-6
    assert np.ptp(path.yaw_rad[rest]) < 1e-6
