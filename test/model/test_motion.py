# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""From two wheels to a motion of the body, and along its arc to another place."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from werrimbi_odom.model.motion import (
    BodyMotion,
    WheelTravel,
    displacement,
    sinc,
    wheels_to_body,
)
from werrimbi_odom.model.pose import Pose, compose, inverse

lengths = st.floats(-10.0, 10.0)
angles = st.floats(-20.0, 20.0) | st.sampled_from([0.0, 1e-300, 1e-9, -1e-9])
motions = st.builds(BodyMotion, lengths, lengths, angles)


def end(motion: BodyMotion[float], yaw: float = 0.0) -> Pose:
    return Pose(*displacement(motion, yaw), yaw + motion.turn)


@given(lengths, lengths, st.floats(0.05, 5.0))
def test_the_body_goes_the_mean_of_the_wheels_and_turns_by_their_difference(
    left: float, right: float, track: float
) -> None:
    motion = wheels_to_body(WheelTravel(left, right), track)
    assert motion.along - 0.5 * track * motion.turn == pytest.approx(left, abs=1e-12)
    assert motion.along + 0.5 * track * motion.turn == pytest.approx(right, abs=1e-12)
    assert motion.sideways == 0.0


@pytest.mark.parametrize(
    ("motion", "place"),
    [
        (BodyMotion(2.0, 0.0, 0.0), (2.0, 0.0)),
        (BodyMotion(0.0, 2.0, 0.0), (0.0, 2.0)),
        (BodyMotion(0.0, 0.0, 1.0), (0.0, 0.0)),
        (BodyMotion(0.5 * math.pi, 0.0, 0.5 * math.pi), (1.0, 1.0)),
        (BodyMotion(0.5 * math.pi, 0.0, -0.5 * math.pi), (1.0, -1.0)),
        (BodyMotion(-0.5 * math.pi, 0.0, 0.5 * math.pi), (-1.0, -1.0)),
        (BodyMotion(math.pi, 0.0, math.pi), (0.0, 2.0)),
        (BodyMotion(3.0, -1.0, 2.0 * math.pi), (0.0, 0.0)),
    ],
)
def test_arcs_that_anyone_can_draw(motion: BodyMotion[float], place: tuple[float, float]) -> None:
    assert displacement(motion, 0.0) == pytest.approx(place, abs=1e-15)


@given(motions, angles)
def test_an_arc_is_what_many_small_straight_steps_come_to(
    motion: BodyMotion[float], yaw: float
) -> None:
    """Euler's rule with the heading half way through each of 4000 steps."""
    steps = 4000
    heading = yaw + motion.turn * (np.arange(steps) + 0.5) / steps
    along, sideways = motion.along / steps, motion.sideways / steps
    x = np.sum(along * np.cos(heading) - sideways * np.sin(heading))
    y = np.sum(along * np.sin(heading) + sideways * np.cos(heading))
    rule = (abs(motion.along) + abs(motion.sideways)) * motion.turn**2 / (24.0 * steps**2)
    assert displacement(motion, yaw) == pytest.approx((x, y), abs=1.01 * rule + 1e-12)


@given(motions, st.floats(0.0, 1.0))
def test_an_arc_in_two_parts_ends_in_the_same_place(
    motion: BodyMotion[float], share: float
) -> None:
    first = end(BodyMotion(*(share * part for part in motion)))
    second = end(BodyMotion(*((1.0 - share) * part for part in motion)))
    assert compose(first, second) == pytest.approx(end(motion), abs=1e-11)


@given(motions)
def test_the_reverse_motion_leads_back(motion: BodyMotion[float]) -> None:
    back = BodyMotion(*(-part for part in motion))
    assert end(back) == pytest.approx(inverse(end(motion)), abs=1e-11)


@given(motions, angles)
def test_displacements_turn_with_the_heading(motion: BodyMotion[float], yaw: float) -> None:
    assert end(motion, yaw) == pytest.approx(compose(Pose(0.0, 0.0, yaw), end(motion)), abs=1e-11)


@given(st.lists(st.tuples(motions, angles), min_size=1))
def test_arrays_go_where_single_motions_go(many: list[tuple[BodyMotion[float], float]]) -> None:
    together = displacement(
        BodyMotion(*np.array([motion for motion, _ in many]).T), np.array([yaw for _, yaw in many])
    )
    single = [displacement(motion, yaw) for motion, yaw in many]
    assert np.abs(np.array(together).T - single).max() < 1e-14 * 20.0


@pytest.mark.parametrize("x", [0.0, 5e-324, 1e-200, 1e-8, 1e-4, 1.0, math.pi, 1e4])
def test_sinc_is_even_and_one_at_zero_and_its_series_near_it(x: float) -> None:
    assert sinc(x) == sinc(-x) == sinc(np.array([x]))[0]
    if x < 1e-3:
        assert sinc(x) == pytest.approx(1.0 - x * x / 6.0, rel=1e-15)
    else:
        assert sinc(x) == math.sin(x) / x
