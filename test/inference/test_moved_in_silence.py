# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A recording that was paused while somebody put the robot elsewhere."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from test.inference.driven import parts
from test.model.drives import ROBOT
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.inference.legs.aligned_run import record_of
from werrimbi_odom.inference.legs.motion_states import LOST

STOPS, GOES = 20.0, 50.0


def a_drive(moved: float, turned: float, *, ticks_go_on: bool = False) -> Run:
    """Drives 18 s, stands, and after a silence of 30 s drives on: elsewhere by `moved` [m]."""
    time = np.arange(0.0, 80.0, 0.05)
    rolls = (time < 18.0) | (time > 52.0)
    bends = np.where(rolls, 0.5 * np.sin(0.7 * time), 0.0)
    yaw = np.cumsum(0.05 * bends)
    place = np.cumsum(0.05 * 0.3 * rolls * np.exp(1j * yaw))
    left, right = (
        np.rint(np.cumsum(0.05 * (0.3 * rolls + side * bends * 0.5 * ROBOT.track)) / tick)
        for side, tick in ((-1.0, ROBOT.left_tick), (1.0, ROBOT.right_tick))
    )
    later = time > STOPS
    pivot = place[time <= STOPS][-1]
    place = np.where(later, pivot + moved + (place - pivot) * np.exp(1j * turned), place)
    noise = np.random.default_rng(0).normal(0.0, 1e-3, (3, time.size))
    seen = Reference(
        time, place.real + noise[0], place.imag + noise[1], yaw + turned * later + noise[2]
    )
    there = (time <= STOPS) | (time >= GOES)
    counted = np.ones_like(there) if ticks_go_on else there
    ticks = Ticks(time[counted], left[counted], right[counted])
    return Run("paused", Path("paused"), ticks, seen.chosen(there))


@pytest.mark.parametrize("ticks_go_on", [False, True])
@pytest.mark.parametrize("which", ["poses", "positions", "yaw"])
def test_who_moves_a_robot_in_a_pause_of_the_recording_makes_no_leg_of_it(
    which: str, ticks_go_on: bool
) -> None:
    """Its wheels stood: to a sound robot a wheel was said to grow with the place on the floor."""
    run = parts(a_drive(0.6, 1.309, ticks_go_on=ticks_go_on), which)
    record = record_of(run, ROBOT)
    [found] = [part for part in record.left_out if part.words != LOST]
    assert found.why == "carried"
    assert found.begin == pytest.approx(STOPS, abs=0.1)
    assert found.end == pytest.approx(GOES, abs=0.1)
    assert ("0.60 m" in found.words, "75°" in found.words) == (which != "yaw", which != "positions")
    begin, end = record.measured.time[:-1], record.measured.time[1:]
    assert record.gap[(begin < 35.0) & (end > 35.0)].all()


def test_after_such_a_pause_positions_alone_do_not_tell_the_heading() -> None:
    found = record_of(parts(a_drive(0.6, 1.309), "positions"), ROBOT).left_out
    assert [part.words == LOST for part in sorted(found, key=lambda part: part.begin)] == [
        True,
        False,
    ]


@pytest.mark.parametrize("which", ["poses", "positions", "yaw"])
def test_a_robot_that_stands_through_a_pause_is_where_it_was(which: str) -> None:
    assert not record_of(parts(a_drive(0.0, 0.0), which), ROBOT).left_out


def test_a_late_reference_that_fell_silent_before_it_stood_is_no_move() -> None:
    """Half a second late, it shows 0.15 m of the way before the pause after it."""
    run = a_drive(0.0, 0.0, ticks_go_on=True)
    seen = run.reference
    assert seen is not None
    late = replace(seen, time=seen.time + 0.45)
    heard = late.chosen((late.time < 18.05) | (late.time > GOES))
    assert not [
        part
        for part in record_of(replace(run, reference=heard), ROBOT).left_out
        if part.why == "carried"
    ]
