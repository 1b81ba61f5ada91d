# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A clock that is set forward in mid-run changes neither what was driven nor what was held.

A robot's computer goes on from the date at which it was switched off until a network tells another.
"""

from __future__ import annotations

import tracemalloc
from dataclasses import replace

import numpy as np
import pytest

from test.inference.driven import run_of
from test.inference.test_held_or_carried import held
from test.model.drives import ROBOT
from werrimbi_odom.files.run import Run
from werrimbi_odom.files.tables.mislabelled_columns import refuse_wrong_columns
from werrimbi_odom.inference.legs.count_interpolation import counters_of
from werrimbi_odom.inference.legs.motion_states import driven
from werrimbi_odom.inference.legs.usable_run import with_no_driving

FEW_BYTES = 50_000_000
LEAPS = [(0.01, 1.7e9), (40.0, 9e6)]


def leapt(run: Run, after: float, leap: float) -> Run:
    """Both clocks set forward at a time."""
    ticks, seen = run.ticks, run.reference
    assert seen is not None
    times = (np.where(each.time > after, each.time + leap, each.time) for each in (ticks, seen))
    ticks, seen = (
        replace(each, time=time) for each, time in zip((ticks, seen), times, strict=True)
    )
    return replace(run, ticks=ticks, reference=seen)


@pytest.mark.parametrize(("after", "leap"), LEAPS)
def test_a_robot_is_held_as_long_as_by_a_clock_that_goes_on(after: float, leap: float) -> None:
    """The years were looked through in steps of a tenth of a second, which no memory holds."""
    run, begin, end = held(run_of(ROBOT, 3, 60), 20.0, 30.0)
    begin, end = (at + leap * (at > after) for at in (begin, end))
    tracemalloc.start()
    found = with_no_driving(leapt(run, after, leap), ROBOT).no_driving
    took = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert found
    assert (found[0].begin, found[-1].end) == pytest.approx((begin, end), abs=0.5)
    assert {part.why for part in found} == {"held"}
    assert took < FEW_BYTES


@pytest.mark.parametrize(("after", "leap"), LEAPS)
def test_it_drove_as_far_and_stood_the_longer(after: float, leap: float) -> None:
    run = run_of(ROBOT, 3, 60)
    before, now = (
        driven(counters_of(each, ROBOT, None), ROBOT, ()) for each in (run, leapt(run, after, leap))
    )
    assert (now.way, now.turned) == pytest.approx((before.way, before.turned), rel=0.01)
    assert now.reversals == before.reversals
    stood = [
        sum(part.end - part.begin for part in each.spans if part.what == "stood")
        for each in (before, now)
    ]
    assert stood[1] - stood[0] == pytest.approx(leap, abs=1.0)


def test_columns_are_looked_at_in_little_memory() -> None:
    """A hundred days were half a gigabyte for each column."""
    tracemalloc.start()
    refuse_wrong_columns(leapt(run_of(ROBOT, 3, 60), 30.0, 9e6), ROBOT)
    took = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert took < FEW_BYTES
