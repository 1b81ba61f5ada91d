# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""One even turn by one wheel, which agrees with the wheels at any lag: nobody holds the robot."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from test.inference.driven import of_headings, run_of
from test.inference.test_held_or_carried import held
from test.inference.test_late_clock import later
from test.model.drives import ROBOT
from werrimbi_odom.files.run import Run, Ticks
from werrimbi_odom.inference.legs.usable_run import with_no_driving

TURNED = (12.4, 16.0, 16.3, 13.5, 12.9, 13.5, 13.1, 13.1, 14.0, 15.5)
"""A Roomba's turn by its one turning wheel in each second [degrees]; its gyro saw 17.4 in all."""


def one_wheel_turns() -> Run:
    """A rest of two seconds, and ten of a turn in which counts are missing, now more, now fewer."""
    time = np.arange(0.0, 12.0, 0.02)
    wheel = np.interp(time, np.arange(2.0, 13.0), np.cumsum([0.0, *np.radians(TURNED)]))
    counts = np.round(wheel * ROBOT.track / ROBOT.right_tick)
    yaw = np.radians(17.4) * np.maximum(time - 2.0, 0.0)
    seen = of_headings(time, yaw, "incremental")
    return replace(run_of(ROBOT, 0, 10), ticks=Ticks(time, 0.0 * counts, counts), reference=seen)


def test_an_uneven_counter_in_an_even_turn_is_no_hold() -> None:
    """The gyro was taken for one of 3 s before, as the file's law had more of the turn there.

    So the robot was "carried from -3.0 s to 2.0 s", and held for three seconds after.
    """
    assert with_no_driving(one_wheel_turns(), ROBOT).no_driving == ()


def test_what_is_left_out_lies_within_the_record() -> None:
    """By a reference whose stamps are half a second early, the hold seems to begin before it."""
    run, *_ = held(run_of(ROBOT, 1, 40), 0.0, 6.0)
    found = with_no_driving(later(run, -0.5), ROBOT).no_driving
    assert found
    assert all(part.begin >= run.ticks.time[0] for part in found)
