# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Mean speeds over steps whose stamps may be wrong, one step at a time and for a whole run.

A driver that blocks and then sends several messages at once makes steps of a few microseconds.
Their travel divided by that would be hundreds of metres a second, and an effect that reads the
speed would throw the robot across the room. So the speed of a step that is much too early is the
mean over the last steps that together last as long as a usual one: as if its counters were read
when it came. Or it is its own travel in a usual interval, if that is more: as if they were read in
time, and waited.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from itertools import accumulate
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.drive import RawStep
from werrimbi_odom.model.pace import PAUSE, REMEMBERED
from werrimbi_odom.model.pose import Floats

EARLY = 0.2
"""A step is much too early if it lasts less than this share of a usual one: timers jitter by less,
and messages in a burst are closer."""
AT_FIRST = (0.01,) * 10
"""Assumed intervals before the first message [s]: those of a quick sender, whose speed must not be
taken for less than it is; and so many that a record which begins in a burst does not pass for one
of a quicker sender."""


class StepSpeeds(NamedTuple):
    """Mean speeds over a step [m/s, rad/s, m/s, m/s]."""

    along: float
    turn: float
    left: float
    right: float


@dataclass(slots=True)
class SpeedMemory:
    """Recent steps, in constant time and memory."""

    _intervals: deque[float] = field(
        default_factory=lambda: deque(accumulate(AT_FIRST, initial=0.0), maxlen=REMEMBERED + 1)
    )
    """Cumulative duration of the steps that were no pause [s]."""
    _sums: deque[tuple[float, ...]] = field(
        default_factory=lambda: deque(((0.0,) * 6,), maxlen=REMEMBERED + 1)
    )
    """Cumulative duration, way of both wheels, and travel: along, turn, left, right."""

    def step(self, raw: RawStep) -> StepSpeeds:
        """Add a step; return its speeds."""
        known, sums = self._intervals, self._sums
        usual = (known[-1] - known[0]) / (len(known) - 1)
        if raw.duration <= PAUSE:
            known.append(known[-1] + raw.duration)
        rolled = abs(raw.left) + abs(raw.right)
        gone = raw.duration, rolled, raw.along, raw.turn, raw.left, raw.right
        end = tuple(one + more for one, more in zip(sums[-1], gone, strict=True))
        sums.append(end)
        if raw.duration >= EARLY * usual:
            return StepSpeeds(*(travel / raw.duration for travel in gone[2:]))
        begin = next((row for row in reversed(sums) if row[0] <= end[0] - usual), sums[0])
        lasted = end[0] - begin[0]
        if lasted < usual or rolled / usual > (end[1] - begin[1]) / lasted:
            return StepSpeeds(*(travel / usual for travel in gone[2:]))
        return StepSpeeds(*((to - at) / lasted for to, at in zip(end[2:], begin[2:], strict=True)))


class EarlySteps(NamedTuple):
    """Steps of a run that are much too early; k of them."""

    rows: NDArray[np.intp]
    first: NDArray[np.intp]
    """First step of the interval that their speed is the mean of."""
    lasted: Floats
    """Duration of that interval [s]."""
    waited: NDArray[np.bool_]
    """Whether it is the step alone, taken as a usual one."""


def early_steps(duration: Floats, rolled: Floats, *, cut: bool = False) -> EarlySteps:
    """Find the steps of a run that are much too early, as `SpeedMemory` does.

    `duration` (n,) [s], `rolled` (n,): way of both wheels [m]. `cut`: the first step may be a part
    of a message, however short.
    """
    kept = duration <= PAUSE
    assumed = () if cut else AT_FIRST
    known = np.cumsum(np.concatenate([[0.0], assumed, duration[kept]]))
    last = np.cumsum(kept) - kept + len(assumed)
    first = np.maximum(last - REMEMBERED, 0)
    usual = (known[last] - known[first]) / np.maximum(last - first, 1)
    rows = np.flatnonzero(duration < EARLY * usual)
    ends = np.cumsum(np.concatenate([[0.0], duration]))
    end, usual = ends[rows + 1], usual[rows]
    begin = np.searchsorted(ends, end - usual, side="right") - 1
    begin = np.maximum(begin, np.maximum(rows + 1 - REMEMBERED, 0))
    lasted = end - ends[begin]
    ways = np.cumsum(np.concatenate([[0.0], rolled]))
    waited = lasted < usual  # nothing is known of before
    waited |= rolled[rows] / usual > (ways[rows + 1] - ways[begin]) / lasted
    begin, lasted = np.where(waited, rows, begin), np.where(waited, usual, lasted)
    return EarlySteps(rows, begin, lasted, waited)


def mean_speeds(travel: Floats, duration: Floats, early: EarlySteps) -> Floats:
    """Speeds over the steps of a run, (n,), from their travel [m or rad] and duration [s]."""
    speeds = np.asarray(travel / duration)
    if early.rows.size:
        sums = np.cumsum(np.concatenate([[0.0], travel]))
        gone = sums[early.rows + 1] - sums[early.first]
        speeds[early.rows] = np.where(early.waited, travel[early.rows], gone) / early.lasted
    return speeds
