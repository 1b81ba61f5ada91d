# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Thousands of robots end where the closed form says they do; and the paper's own limits of it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from werrimbi_odom.model.covariance import PathNoise, path_noise, piece_covariance
from werrimbi_odom.model.motion import BodyMotion, WheelTravel, displacement, wheels_to_body
from werrimbi_odom.model.robot import Robot

ROBOTS, STEPS = 20_000, 200
YAW = 0.4

PIECES = {
    "line": WheelTravel(5.0, 5.0),
    "line, backwards": WheelTravel(-5.0, -5.0),
    "gentle arc": WheelTravel(4.0, 4.4),
    "tight arc to the right, backwards": WheelTravel(-2.0, -0.8),
    "two turns on the spot": WheelTravel(-2.2, 2.2),
    "half a turn about a slow right wheel": WheelTravel(1.2, 0.1),
    "ten rounds": WheelTravel(18.0, 40.0),
}


def robot_with(noise: float) -> Robot:
    return Robot(0.35, 0.05, 2000, 2000, left_wheel_noise=noise, right_wheel_noise=1.5 * noise)


def true_errors(robot: Robot, travel: WheelTravel[float], seed: int) -> np.ndarray:
    """True minus nominal (x, y, yaw) of noisy robots, shape (ROBOTS, 3); arcs step by step."""
    random = np.random.default_rng(seed)
    x, y, yaw = np.zeros(ROBOTS), np.zeros(ROBOTS), np.full(ROBOTS, YAW)
    for _ in range(STEPS):
        left, right = (
            part / STEPS + k * np.sqrt(abs(part) / STEPS) * random.standard_normal(ROBOTS)
            for part, k in zip(
                travel, (robot.left_wheel_noise, robot.right_wheel_noise), strict=True
            )
        )
        half = 0.5 * (right - left) / robot.track
        chord = 0.5 * (left + right) * np.sinc(half / np.pi)
        x += chord * np.cos(yaw + half)
        y += chord * np.sin(yaw + half)
        yaw += 2.0 * half
    motion = wheels_to_body(travel, robot.track)
    dx, dy = displacement(motion, YAW)
    return np.stack([x - dx, y - dy, yaw - YAW - motion.turn], axis=-1)


def closed_form(robot: Robot, travel: WheelTravel[float]) -> np.ndarray:
    motion = wheels_to_body(travel, robot.track)
    return piece_covariance(motion, path_noise(robot, *travel), YAW).matrix()


def departure(sample: np.ndarray, covariance: np.ndarray) -> np.ndarray:
    """Of the whitened sample's covariance from the unit matrix, in standard deviations."""
    white = np.linalg.solve(np.linalg.cholesky(covariance), sample.T)
    spread = np.sqrt((1.0 + np.eye(3)) / (len(sample) - 1))
    return (np.cov(white) - np.eye(3)) / spread


def robot_uncertain_by(heading: float, travel: WheelTravel[float]) -> Robot:
    """Whose heading has this standard deviation [rad] at the end of a piece."""
    return robot_with(heading / np.sqrt(path_noise(robot_with(1.0), *travel).b))


@pytest.mark.parametrize(
    ("piece", "heading"),
    [
        pytest.param(piece, heading, marks=[pytest.mark.evidence] * ((row + column) % 3 > 0))
        for row, piece in enumerate(PIECES)
        for column, heading in enumerate((0.0003, 0.001, 0.003))
    ],
)
def test_noisy_robots_scatter_as_the_closed_form_says(piece: str, heading: float) -> None:
    """In every direction of (x, y, yaw), at three sizes of the heading's error at the end."""
    travel = PIECES[piece]
    robot = robot_uncertain_by(heading, travel)
    covariance = closed_form(robot, travel)
    assert covariance[2, 2] == pytest.approx(heading**2)
    assert np.abs(departure(true_errors(robot, travel, seed=1), covariance)).max() < 4.0


def test_the_statement_above_would_notice_five_percent() -> None:
    travel = PIECES["gentle arc"]
    robot = robot_uncertain_by(0.001, travel)
    sample = true_errors(robot, travel, seed=1)
    assert np.abs(departure(sample, 1.05 * closed_form(robot, travel))).max() > 4.0


@pytest.mark.parametrize("heading", [0.03, 0.1], ids=lambda s: f"{s} rad")
def test_along_a_line_first_order_fails_once_the_scatter_to_the_side_nears_the_track(
    heading: float,
) -> None:
    travel = PIECES["line"]
    robot = robot_uncertain_by(heading, travel)
    ahead = np.array([np.cos(YAW), np.sin(YAW), 0.0])
    scatter = np.var(true_errors(robot, travel, seed=2) @ ahead)
    first_order = ahead @ closed_form(robot, travel) @ ahead
    missed = (travel.left * heading / robot.track) ** 2 / 3.0
    assert scatter / first_order - 1.0 == pytest.approx(missed, rel=0.1, abs=0.03)


@pytest.mark.parametrize(
    ("heading", "least", "most"), [(0.03, -0.04, 0.04), (0.3, 0.05, 0.15), (0.9, 0.4, 1.0)]
)
def test_across_a_line_first_order_overstates_the_scatter_by_a_tenth_at_a_third_of_a_radian(
    heading: float, least: float, most: float
) -> None:
    travel = PIECES["line"]
    robot = robot_uncertain_by(heading, travel)
    across = np.array([-np.sin(YAW), np.cos(YAW), 0.0])
    scatter = np.var(true_errors(robot, travel, seed=2) @ across)
    first_order = across @ closed_form(robot, travel) @ across
    assert least < first_order / scatter - 1.0 < most


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
