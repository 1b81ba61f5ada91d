# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What the covariance of a piece must obey whatever its formula: splitting, symmetries, scales."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from werrimbi_odom.model.covariance import (
    CERTAIN,
    PathNoise,
    PoseCovariance,
    carried,
    noise_of_wheel_variances,
    path_noise,
    piece_covariance,
    plus,
)
from werrimbi_odom.model.motion import BodyMotion, WheelTravel, displacement, wheels_to_body
from werrimbi_odom.model.robot import Robot

Piece = tuple[BodyMotion[float], PathNoise[float]]


def up_to(most: float) -> st.SearchStrategy[float]:
    """Both signs and zero, but nothing so small that its square leaves the range of floats."""
    sizes = st.floats(1e-100, most)
    return st.one_of(st.just(0.0), sizes, sizes.map(lambda size: -size))


lengths = up_to(30.0)
turns = st.one_of(
    st.just(0.0),
    st.floats(-20.0, 20.0),
    st.floats(-1e-3, 1e-3, allow_subnormal=False),
    st.sampled_from([2.0, -2.0, 1e-12, 100.0, -1000.0]),
)
yaws = st.floats(-4.0, 4.0)
wheel_variances = st.floats(1e-10, 1e-2)
tracks = st.floats(0.05, 3.0)


@st.composite
def pieces(draw: st.DrawFn) -> Piece:
    """Any twist, with the noise of two independent wheels."""
    motion = BodyMotion(draw(lengths), draw(st.sampled_from([0.0, 0.0, -0.4, 3.0])), draw(turns))
    return motion, noise_of_wheel_variances(
        draw(wheel_variances), draw(wheel_variances), draw(tracks)
    )


def whole(piece: Piece, yaw: float = 0.0) -> np.ndarray:
    motion, noise = piece
    return piece_covariance(motion, noise, yaw).matrix()


def part(piece: Piece, share: float) -> Piece:
    return BodyMotion(*(share * m for m in piece[0])), PathNoise(*(share * n for n in piece[1]))


def in_parts(piece: Piece, shares: list[float], yaw: float) -> np.ndarray:
    covariance: PoseCovariance[float] = CERTAIN
    for share in shares:
        motion, noise = part(piece, share)
        moved = carried(covariance, *displacement(motion, yaw))
        covariance = plus(moved, piece_covariance(motion, noise, yaw))
        yaw += motion.turn
    return covariance.matrix()


ROUNDING = 1e-12
"""Some dozens of roundings, of the largest entry of a kind, at up to a thousand radians."""


def difference(one: np.ndarray, other: np.ndarray) -> float:
    """Largest difference of an entry, relative to the largest of its kind."""
    return float(np.max(np.abs(one - other) / not_zero(largest_of_kind(other))))


def difference_of_entries(one: np.ndarray, other: np.ndarray) -> float:
    """Largest relative difference of an entry; where it cancels, of the largest of its kind."""
    size = largest_of_kind(other)
    scale = np.where(np.abs(other) > 1e-3 * size, np.abs(other), size)
    return float(np.max(np.abs(one - other) / not_zero(scale)))


def largest_of_kind(covariance: np.ndarray) -> np.ndarray:
    """What an entry can be at most, by the larger deviation of the place and that of the yaw."""
    xx, yy, yawyaw = np.diag(covariance)
    deviations = np.sqrt([max(xx, yy), max(xx, yy), yawyaw])
    return np.outer(deviations, deviations)


def not_zero(size: np.ndarray) -> np.ndarray:
    return np.where(size > 0.0, size, 1.0)


# Splitting: the paper's point.


@settings(max_examples=150)
@given(pieces(), st.lists(st.floats(0.01, 1.0), min_size=2, max_size=40), yaws)
def test_splitting_a_piece_anywhere_any_number_of_times_changes_nothing(
    piece: Piece, cuts: list[float], yaw: float
) -> None:
    shares = [cut / sum(cuts) for cut in cuts]
    assert difference_of_entries(in_parts(piece, shares, yaw), whole(piece, yaw)) < 1e-9


@pytest.mark.parametrize("parts", [2, 10, 1000])
@pytest.mark.parametrize(
    "travel", [(4.0, 4.0), (-4.0, -4.0), (3.0, 3.5), (-0.4, 0.5)], ids=lambda t: f"{t}"
)
class TestTwoModelsCutIntoParts:
    """The same pieces, cut into equal parts; the classical model given the best of inputs."""

    def test_the_closed_form_gives_the_same(self, travel: tuple[float, float], parts: int) -> None:
        assert disagreement(closed_form, WheelTravel(*travel), parts) < 1e-9

    def test_the_classical_model_per_stage_does_not(
        self, travel: tuple[float, float], parts: int
    ) -> None:
        assert disagreement(classical, WheelTravel(*travel), parts) > 0.05


ROBOT = Robot(0.35, 0.05, 2000, 2000)
Model = Callable[[np.ndarray, WheelTravel[float], float], np.ndarray]


def closed_form(covariance: np.ndarray, travel: WheelTravel[float], yaw: float) -> np.ndarray:
    motion = wheels_to_body(travel, ROBOT.track)
    dx, dy = displacement(motion, yaw)
    lever = np.array([[1.0, 0.0, -dy], [0.0, 1.0, dx], [0.0, 0.0, 1.0]])
    own = piece_covariance(motion, path_noise(ROBOT, *travel), yaw).matrix()
    return lever @ covariance @ lever.T + own


def classical(covariance: np.ndarray, travel: WheelTravel[float], yaw: float) -> np.ndarray:
    """Equations 1 to 3 of the paper: a rotation δ, then a translation D, with independent errors.

    Their variances are those that the wheels' noise has over the stage, so they add up right.
    """
    motion, noise = wheels_to_body(travel, ROBOT.track), path_noise(ROBOT, *travel)
    heading = yaw + motion.turn
    dx, dy = motion.along * math.cos(heading), motion.along * math.sin(heading)
    by_state = np.array([[1.0, 0.0, -dy], [0.0, 1.0, dx], [0.0, 0.0, 1.0]])
    by_input = np.array([[-dy, math.cos(heading)], [dx, math.sin(heading)], [1.0, 0.0]])
    inputs = np.diag([noise.b, noise.a])
    return by_state @ covariance @ by_state.T + by_input @ inputs @ by_input.T


def disagreement(model: Model, travel: WheelTravel[float], parts: int) -> float:
    """Between a piece in one go and in equal parts, relative."""
    at_once = model(np.zeros((3, 3)), travel, 0.3)
    covariance, yaw = np.zeros((3, 3)), 0.3
    step = WheelTravel(travel.left / parts, travel.right / parts)
    for _ in range(parts):
        covariance = model(covariance, step, yaw)
        yaw += wheels_to_body(step, ROBOT.track).turn
    return difference_of_entries(covariance, at_once)


# No threshold.


@given(pieces(), st.sampled_from([2.0, -2.0]), st.integers(1, 4))
def test_nothing_jumps_where_the_series_hands_over_to_the_closed_form(
    piece: Piece, seam: float, away: int
) -> None:
    motion, noise = piece
    # A few neighbouring floats on either side, so that only a jump can make a difference.
    inside = seam * (1.0 - away * 2.0**-53)
    outside = seam * (1.0 + away * 2.0**-52)
    one, other = (whole((motion._replace(turn=turn), noise)) for turn in (inside, outside))
    assert difference(one, other) < ROUNDING


@given(pieces(), st.sampled_from([5e-324, 1e-300, 1e-160, 1e-100, 1e-30, 1e-17]), yaws)
def test_nothing_jumps_as_an_arc_becomes_a_line(piece: Piece, turn: float, yaw: float) -> None:
    motion, noise = piece
    line = whole((motion._replace(turn=0.0), noise), yaw)
    for sign in (1.0, -1.0):
        arc = whole((motion._replace(turn=sign * turn), noise), yaw)
        assert difference(arc, line) < ROUNDING


@given(pieces(), st.floats(1e-12, 30.0), yaws)
def test_a_slightly_larger_turn_changes_the_covariance_slightly(
    piece: Piece, turn: float, yaw: float
) -> None:
    motion, noise = piece
    one, other = (
        whole((motion._replace(turn=t), noise), yaw) for t in (turn, turn * (1.0 + 1e-12))
    )
    assert np.abs(one - other).max() <= 1e-10 * np.abs(one).max()


# A covariance is a covariance.


@settings(max_examples=150)
@given(
    left=up_to(1e4),
    right=up_to(1e4),
    sideways=up_to(1e3),
    track=st.floats(1e-2, 1e2),
    noise=st.tuples(*2 * [st.just(0.0) | st.floats(1e-9, 1.0)]),
    yaw=yaws,
)
@example(left=1.0, right=1.0, sideways=0.0, track=0.3, noise=(0.0, 0.0), yaw=0.0)
@example(left=0.0, right=0.0, sideways=0.0, track=0.3, noise=(1e-3, 1e-3), yaw=0.0)
@example(left=0.0, right=1e4, sideways=0.0, track=0.3, noise=(1e-3, 1e-3), yaw=1.0)
def test_no_direction_has_a_negative_variance(
    left: float,
    right: float,
    sideways: float,
    track: float,
    noise: tuple[float, float],
    yaw: float,
) -> None:
    robot = Robot(track, 0.05, 100, 100, left_wheel_noise=noise[0], right_wheel_noise=noise[1])
    motion = wheels_to_body(WheelTravel(left, right), track)._replace(sideways=sideways)
    covariance = piece_covariance(motion, path_noise(robot, left, right), yaw).matrix()
    assert np.isfinite(covariance).all()
    lever = 0.5 * track + abs(motion.along) + abs(sideways)  # [m per rad]: all entries in m²
    covariance = np.diag([1.0, 1.0, lever]) @ covariance @ np.diag([1.0, 1.0, lever])
    assert np.linalg.eigvalsh(covariance)[0] >= -1e-14 * np.trace(covariance)


@given(st.floats(-30.0, 30.0).filter(lambda turn: abs(turn) > 1e-3), yaws)
def test_about_a_wheel_at_rest_every_error_is_a_turn(turn: float, yaw: float) -> None:
    """The right wheel stands still, so the body can only be elsewhere on a circle about it."""
    travel = WheelTravel(-ROBOT.track * turn, 0.0)
    motion, noise = wheels_to_body(travel, ROBOT.track), path_noise(ROBOT, *travel)
    end = yaw + turn
    from_wheel = 0.5 * ROBOT.track * np.array([-math.sin(end), math.cos(end)])
    circle = np.array([-from_wheel[1], from_wheel[0], 1.0])
    expected = noise.b * np.outer(circle, circle)
    assert np.abs(whole((motion, noise), yaw) - expected).max() < 1e-12 * noise.b


# Symmetries.


@given(pieces(), yaws)
def test_a_mirrored_robot_has_the_mirrored_errors(piece: Piece, yaw: float) -> None:
    motion, noise = piece
    swapped = BodyMotion(motion.along, -motion.sideways, -motion.turn), noise._replace(c=-noise.c)
    flip = np.diag([1.0, -1.0, -1.0])
    assert difference(flip @ whole(swapped, -yaw) @ flip, whole(piece, yaw)) < ROUNDING


@given(pieces())
def test_driven_back_a_piece_has_the_errors_of_the_inverse_pose(piece: Piece) -> None:
    """Seen from the end, the start is as uncertain as the end seen from the start."""
    motion, noise = piece
    dx, dy = displacement(motion, 0.0)
    cos, sin = math.cos(motion.turn), math.sin(motion.turn)
    back = np.array([[cos, sin], [-sin, cos]])
    inverse = np.zeros((3, 3))
    inverse[:2, :2] = -back
    inverse[:2, 2] = back @ [-dy, dx]
    inverse[2, 2] = -1.0
    reverse = BodyMotion(*(-m for m in motion)), noise
    seen_from_the_end = inverse @ whole(piece) @ inverse.T
    size = np.abs(seen_from_the_end).max() + np.abs(whole(piece)).max()
    assert np.abs(whole(reverse) - seen_from_the_end).max() < ROUNDING * size


@given(pieces(), yaws, yaws)
def test_turning_the_frame_turns_the_covariance(piece: Piece, yaw: float, angle: float) -> None:
    cos, sin = math.cos(angle), math.sin(angle)
    turn = np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
    assert difference(whole(piece, yaw + angle), turn @ whole(piece, yaw) @ turn.T) < ROUNDING


# Scales.


@given(pieces(), st.floats(1e-3, 1e3), yaws)
def test_a_robot_of_another_size_has_its_errors_in_proportion(
    piece: Piece, size: float, yaw: float
) -> None:
    """All lengths times `size`, the wheels' deviations too; angles stay, and their errors."""
    motion, noise = piece
    larger = (
        BodyMotion(size * motion.along, size * motion.sideways, motion.turn),
        PathNoise(size * size * noise.a, noise.b, size * noise.c),
    )
    units = np.diag([size, size, 1.0])
    assert difference(whole(larger, yaw), units @ whole(piece, yaw) @ units) < ROUNDING


@given(pieces(), st.floats(1e-6, 1e6), yaws)
def test_variances_grow_in_proportion_to_the_noise(piece: Piece, factor: float, yaw: float) -> None:
    motion, noise = piece
    louder = PathNoise(*(factor * n for n in noise))
    assert difference(whole((motion, louder), yaw), factor * whole(piece, yaw)) < ROUNDING


@given(lengths, lengths, lengths, lengths, yaws)
def test_two_independent_noises_add(
    left: float, right: float, more_left: float, more_right: float, yaw: float
) -> None:
    motion = BodyMotion(1.5, -0.2, 0.8)
    one, other = path_noise(ROBOT, left, right), path_noise(ROBOT, more_left, more_right)
    both = PathNoise(*(a + b for a, b in zip(one, other, strict=True)))
    separate = whole((motion, one), yaw) + whole((motion, other), yaw)
    assert difference(whole((motion, both), yaw), separate) < ROUNDING
