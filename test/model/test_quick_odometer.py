# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The odometer with machine code is the odometer, to the last bit, whatever happens to it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any
from unittest.mock import patch

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from test.model.drives import ROBOT, random_drive, square
from test.model.records import Record, records
from werrimbi_odom.effects import find
from werrimbi_odom.model import quick_odometer
from werrimbi_odom.model.compiled import compiled
from werrimbi_odom.model.covariance import PoseCovariance
from werrimbi_odom.model.encoder_online import EncoderLimits
from werrimbi_odom.model.end_of_piece import PieceTolerance
from werrimbi_odom.model.odometer import Estimate, Odometer
from werrimbi_odom.model.pose import Pose
from werrimbi_odom.model.quick_odometer import QuickEstimate, QuickOdometer
from werrimbi_odom.model.robot import Robot

ELSEWHERE = Pose(3.0, -2.0, 1.0), PoseCovariance(0.1, 0.01, 0.0, 0.2, 0.0, 0.05)


def both(
    robot: Robot, limits: EncoderLimits, way: Callable[..., Any] | None, patience: int
) -> tuple[Odometer, QuickOdometer]:
    with (
        patch.object(quick_odometer, "compiled", lambda function: way),
        patch.object(quick_odometer, "PATIENCE", patience),
    ):
        return Odometer(robot, limits=limits), QuickOdometer(robot, limits=limits)


def assert_same(one: Estimate | None, other: Estimate | None) -> None:
    assert (one is None) == (other is None)
    if one is None or other is None:
        return
    for name in (
        "time",
        "late",
        "late_motion",
        "pose",
        "distance",
        "closed",
        "robot",
        "errors",
        "covariance",
        "mean_shift",
        "twist",
        "twist_covariance",
    ):
        assert getattr(one, name) == getattr(other, name), name


def assert_same_state(one: Odometer, other: Odometer) -> None:
    assert one.tally == other.tally
    assert one.piece == other.piece
    assert one.errors() == other.errors()
    assert one.covariance() == other.covariance()
    assert one.distance == other.distance


@settings(max_examples=15, deadline=None)
@given(
    records(),
    st.sampled_from([0, 3, 64]),
    st.booleans(),
    st.lists(st.tuples(st.integers(0, 400), st.sampled_from(["pose", "noise", "look"]))),
)
def test_it_is_the_odometer_whatever_the_counters_do(
    record: Record, patience: int, as_written: bool, happens: list[tuple[int, str]]
) -> None:
    robot, limits, ticks = record
    way = quick_odometer.take if as_written else compiled(quick_odometer.take)
    plain, quick = both(robot, limits, way, patience)
    todo = dict(happens)
    with patch.object(quick_odometer, "PATIENCE", patience):
        for row, message in enumerate(zip(*(column.tolist() for column in ticks), strict=True)):
            assert_same(plain.update(*message), quick.update(*message))
            if todo.get(row) == "pose":
                assert plain.set_pose(*ELSEWHERE) == quick.set_pose(*ELSEWHERE)
            elif todo.get(row) == "noise":
                robot = replace(robot, left_wheel_noise=2.0 * robot.left_wheel_noise)
                others = robot, PieceTolerance(), limits
                assert plain.retune(*others) == quick.retune(*others)
            elif todo.get(row) == "look":
                assert_same_state(plain, quick)
    assert_same_state(plain, quick)


@pytest.mark.parametrize("drive", [square(), random_drive(3)])
def test_nearly_all_messages_of_a_drive_are_in_no_doubt(drive: Any) -> None:
    """Else nothing would be gained; and pieces end there too."""
    pytest.importorskip("numba")
    odometer = QuickOdometer(ROBOT)
    estimates = [odometer.update(*row) for row in zip(*(c.tolist() for c in drive), strict=True)]
    quick = [each for each in estimates if isinstance(each, QuickEstimate)]
    assert len(quick) > 0.9 * len(estimates)
    assert any(each.closed for each in quick)


@pytest.mark.parametrize(
    "robot",
    [
        replace(ROBOT, effects=(find("sideways_drift").using(angle=0.01),)),
        replace(ROBOT, effects=(find("wheels_swapped").using(),)),
        replace(ROBOT, covariance_order="exact"),
    ],
)
def test_what_it_has_no_machine_code_for_is_the_odometers(robot: Robot) -> None:
    plain, quick = both(robot, EncoderLimits(), quick_odometer.take, 0)
    for row in zip(*(column.tolist() for column in random_drive(2)), strict=True):
        assert_same(plain.update(*row), quick.update(*row))
    assert_same_state(plain, quick)


def test_counts_beyond_what_floats_hold_stay_whole() -> None:
    plain, quick = both(ROBOT, EncoderLimits(), quick_odometer.take, 0)
    for step in range(200):
        count = 2**53 - 500 + 7 * step
        assert_same(
            plain.update(0.02 * step, count, count), quick.update(0.02 * step, count, count)
        )
    assert_same_state(plain, quick)


def test_without_numba_it_goes_on_in_the_readable_lines() -> None:
    plain, quick = both(ROBOT, EncoderLimits(), None, 0)
    for row in zip(*(column.tolist() for column in random_drive(5)), strict=True):
        assert_same(plain.update(*row), quick.update(*row))
    assert np.isfinite(quick.covariance().yawyaw)
