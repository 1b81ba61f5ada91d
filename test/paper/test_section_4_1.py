# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The paper's own limits of equation 17 (section 4.1): straight line and turn on the spot."""

from __future__ import annotations

import math

import numpy as np
import pytest

from werrimbi_odom.model.covariance import PathNoise, path_noise, piece_covariance
from werrimbi_odom.model.motion import BodyMotion, WheelTravel, wheels_to_body
from werrimbi_odom.model.robot import Robot

WERRIMBI = Robot(0.35, 0.05, 2000, 2000)  # k_L and k_R of section 5.2 are the defaults


def covariance(left: float, right: float) -> tuple[np.ndarray, PathNoise[float]]:
    motion, noise = (
        wheels_to_body(WheelTravel(left, right), 0.35),
        path_noise(WERRIMBI, left, right),
    )
    return piece_covariance(motion, noise, 0.0).matrix(), noise


@pytest.mark.parametrize("distance", [10.0, -10.0, 0.01])
def test_straight_line(distance: float) -> None:
    matrix, (a, b, c) = covariance(distance, distance)
    assert a == pytest.approx((0.0004**2 + 0.00058**2) * abs(distance) / 4.0)
    assert b == pytest.approx((0.0004**2 + 0.00058**2) * abs(distance) / 0.35**2)
    assert c == pytest.approx((0.00058**2 - 0.0004**2) * abs(distance) / 0.7)
    expected = [
        [a, 0.5 * c * distance, c],
        [0.5 * c * distance, b * distance**2 / 3.0, 0.5 * b * distance],
        [c, 0.5 * b * distance, b],
    ]
    assert matrix == pytest.approx(np.array(expected), rel=1e-14)


def test_the_error_across_a_line_grows_with_the_cube_of_the_distance() -> None:
    near, far = (covariance(distance, distance)[0] for distance in (2.0, 20.0))
    assert far[1, 1] / near[1, 1] == pytest.approx(1000.0)
    assert far[0, 0] / near[0, 0] == pytest.approx(10.0)
    assert far[2, 2] / near[2, 2] == pytest.approx(10.0)


@pytest.mark.parametrize("turn", [0.5 * math.pi, -math.pi, 20.0])
def test_turn_on_the_spot(turn: float) -> None:
    """In the frame of the heading half way, as the paper gives it."""
    travel = 0.5 * 0.35 * turn
    noise = path_noise(WERRIMBI, -travel, travel)
    matrix = piece_covariance(BodyMotion(0.0, 0.0, turn), noise, -0.5 * turn).matrix()
    whole, half = math.sin(turn) / turn, math.sin(0.5 * turn) / (0.5 * turn)
    expected = [
        [0.5 * noise.a * (1.0 + whole), 0.0, noise.c * half],
        [0.0, 0.5 * noise.a * (1.0 - whole), 0.0],
        [noise.c * half, 0.0, noise.b],
    ]
    assert matrix == pytest.approx(np.array(expected), rel=1e-13, abs=1e-21)


def test_after_many_turns_on_the_spot_the_place_is_uncertain_alike_in_all_directions() -> None:
    matrix, (a, _, _) = covariance(-500.0, 500.0)
    assert matrix[:2, :2] == pytest.approx(0.5 * a * np.eye(2), rel=1e-3, abs=1e-3 * a)
