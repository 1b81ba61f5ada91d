# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Poses are a group: composing, undoing and seeing from elsewhere hang together."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from werrimbi_odom.model.pose import Pose, between, compose, inverse, wrap, wrap_all

metres = st.floats(-1e3, 1e3)
angles = st.floats(-50.0, 50.0)
poses = st.builds(Pose, metres, metres, angles)
ORIGIN = Pose()


def same(one: Pose, other: Pose) -> bool:
    return one == pytest.approx(other, rel=1e-12, abs=1e-9)


@given(poses)
def test_the_origin_changes_nothing(a: Pose) -> None:
    assert compose(a, ORIGIN) == a
    assert same(compose(ORIGIN, a), a)


@given(poses)
def test_a_pose_and_its_inverse_undo_each_other(a: Pose) -> None:
    assert same(compose(a, inverse(a)), ORIGIN)
    assert same(compose(inverse(a), a), ORIGIN)
    assert same(inverse(inverse(a)), a)


@given(poses, poses, poses)
def test_chaining_may_be_bracketed_in_any_way(a: Pose, b: Pose, c: Pose) -> None:
    assert same(compose(compose(a, b), c), compose(a, compose(b, c)))


@given(poses, poses)
def test_what_is_seen_from_a_pose_leads_from_it_to_the_other(a: Pose, b: Pose) -> None:
    assert same(compose(a, between(a, b)), b)
    assert same(between(b, a), inverse(between(a, b)))


@given(poses, poses, poses)
def test_what_is_seen_does_not_depend_on_the_frame(frame: Pose, a: Pose, b: Pose) -> None:
    assert same(between(compose(frame, a), compose(frame, b)), between(a, b))


def test_x_is_ahead_and_y_to_the_left_and_angles_turn_left() -> None:
    facing_left = Pose(1.0, 2.0, 0.5 * math.pi)
    assert compose(facing_left, Pose(1.0, 0.0, 0.0)) == pytest.approx((1.0, 3.0, 0.5 * math.pi))
    assert compose(facing_left, Pose(0.0, 1.0, 0.1)) == pytest.approx(
        (0.0, 2.0, 0.5 * math.pi + 0.1)
    )


@given(st.floats(-1e6, 1e6))
def test_a_wrapped_angle_is_the_same_direction_and_within_half_a_turn(angle: float) -> None:
    wrapped = wrap(angle)
    assert abs(wrapped) <= math.pi
    assert math.cos(wrapped) == pytest.approx(math.cos(angle), abs=1e-9)
    assert math.sin(wrapped) == pytest.approx(math.sin(angle), abs=1e-9)


@given(st.lists(st.floats(-1e4, 1e4)))
def test_many_angles_wrap_as_single_ones(angles: list[float]) -> None:
    together = wrap_all(np.array(angles, dtype=float))
    for angle, wrapped in zip(angles, together.tolist(), strict=True):
        assert abs(wrapped) <= math.pi + 1e-9
        assert math.remainder(wrapped - wrap(angle), 2.0 * math.pi) == pytest.approx(0.0, abs=1e-9)


def test_wrapping_keeps_the_shape() -> None:
    assert wrap_all(np.full((2, 3, 4), 7.0)).shape == (2, 3, 4)
