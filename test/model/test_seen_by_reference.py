# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What a reference shows of a robot: another point, another axis, another time, another hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from test.model.drives import ROBOT, random_drive, read
from werrimbi_odom.model.pose import Pose
from werrimbi_odom.model.reference_measurement import axle_of, shown
from werrimbi_odom.model.reference_view import View
from werrimbi_odom.model.trajectory import Trajectory, trajectory

ARM = View(ahead=0.2, left=-0.1)


def spin(turns: float = 1.0) -> Trajectory:
    """On the spot at 1 rad/s."""
    count = round(turns * 2.0 * math.pi * 50.0)
    return trajectory(ROBOT, *read(ROBOT, 50.0, np.zeros(count), np.ones(count)))


def path() -> Trajectory:
    return trajectory(ROBOT, *random_drive(2, rate=10.0), start=Pose(1.0, -2.0, 0.7))


def test_seen_from_the_axle_nothing_is_changed() -> None:
    driven = path()
    seen = shown(driven, View())
    assert seen.x is driven.x
    assert seen.covariance is driven.covariance


def test_on_the_spot_an_arm_goes_round_a_circle() -> None:
    seen = shown(spin(), ARM)
    np.testing.assert_allclose(np.hypot(seen.x, seen.y), math.hypot(0.2, 0.1), rtol=1e-3)
    assert np.ptp(seen.x) == pytest.approx(2.0 * math.hypot(0.2, 0.1), rel=1e-2)


def test_an_axis_askew_shows_in_yaw_alone() -> None:
    driven, seen = path(), shown(path(), View(yaw=0.3))
    np.testing.assert_allclose(seen.yaw, driven.yaw + 0.3, rtol=1e-14)
    np.testing.assert_array_equal(seen.x, driven.x)


@pytest.mark.parametrize("view", [ARM, View(yaw=1.0), ARM._replace(yaw=-2.0, mirrored=True)])
def test_from_the_first_pose_shown_back_to_the_axle(view: View) -> None:
    driven = path()
    seen = shown(driven, view)
    for row in (0, 500):
        back = axle_of(Pose(*(float(part[row]) for part in (seen.x, seen.y, seen.yaw))), view)
        np.testing.assert_allclose(
            back, (driven.x[row], driven.y[row], driven.yaw[row]), atol=1e-12
        )


def test_a_delay_by_whole_rows_shows_the_rows_before() -> None:
    driven, seen = path(), shown(path(), View(delay=0.3))
    for part, late in zip(
        (driven.x, driven.y, driven.yaw), (seen.x, seen.y, seen.yaw), strict=True
    ):
        np.testing.assert_allclose(late[3:], part[:-3], atol=1e-9)
        assert (late[:3] == part[0]).all(), "before the first row it stood"


def test_between_rows_it_goes_along_the_arc() -> None:
    """A circle at 2 rad/s, logged at 2 Hz: chords would miss it by far."""
    circle = trajectory(ROBOT, *read(ROBOT, 2.0, np.full(40, 0.5), np.full(40, 2.0)))
    seen = shown(circle, View(delay=0.21))
    fit = np.linalg.lstsq(
        np.stack([2.0 * circle.x, 2.0 * circle.y, np.ones(circle.x.size)], axis=-1),
        circle.x**2 + circle.y**2,
        rcond=None,
    )[0]
    radius = np.hypot(seen.x - fit[0], seen.y - fit[1])
    np.testing.assert_allclose(radius, 0.25, rtol=2e-3)


def test_a_late_heading_leaves_the_position_alone() -> None:
    driven, seen = path(), shown(path(), View(heading_delay=0.2))
    np.testing.assert_array_equal(seen.x, driven.x)
    np.testing.assert_allclose(seen.yaw[2:], driven.yaw[:-2], atol=1e-9)


def test_a_mirrored_frame_turns_left_into_right() -> None:
    driven, seen = path(), shown(path(), View(mirrored=True))
    np.testing.assert_array_equal(seen.y, -driven.y)
    np.testing.assert_array_equal(seen.yaw, -driven.yaw)
    matrix = np.diag([1.0, -1.0, -1.0])
    flipped = matrix @ driven.covariance.matrix() @ matrix
    np.testing.assert_array_equal(seen.covariance.matrix(), flipped)


@pytest.mark.parametrize("view", [ARM, ARM._replace(mirrored=True, delay=0.05)])
def test_the_covariance_is_that_of_the_point_shown(view: View) -> None:
    """Against the derivative of where the point lies in the axle's pose."""
    driven = path()
    seen = shown(driven, view)
    row = 700
    before = row if view.delay == 0.0 else row - 1
    cov = driven.covariance.matrix()[before]
    yaw = seen.yaw[row] * (-1.0 if view.mirrored else 1.0)
    lever = np.exp(1j * yaw) * complex(view.ahead, view.left) * 1j
    jacobian = np.eye(3)
    jacobian[:2, 2] = lever.real, lever.imag
    hand = np.diag([1.0, -1.0, -1.0]) if view.mirrored else np.eye(3)
    expected = hand @ jacobian @ cov @ jacobian.T @ hand.T
    np.testing.assert_allclose(seen.covariance.matrix()[row], expected, rtol=1e-9, atol=1e-18)
