# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""When in a turn each beam was seen: as the messages say, or otherwise, if the walls say so.

A lidar that turns clockwise fills its arrays from the end, and some of their drivers state the time
between beams as if it did not (a TurtleBot3's LDS-02 among them). Others leave the time between
beams at zero, as if the lidar saw all at once (some of a Neato's). Deskewed wrongly, a scan of a
robot that turns is bent: its echoes lie farther from the walls. So all ways are matched side by
side until the walls have told.
"""

from __future__ import annotations

from collections import deque
from dataclasses import replace
from typing import Literal

import numpy as np

from werrimbi_odom.scans.limits import LONGEST_SWEEP, ORDER_FEWEST, ORDER_MOST, ORDER_SURE
from werrimbi_odom.scans.path import INTERVALS, USUAL, ScanMatcher, ScanPath
from werrimbi_odom.scans.sweep import Sweep

Order = Literal["stated", "first to last", "last to first"]
"""The order in which the beams of a turn were seen."""


class AnyOrder:
    """Takes scans in the order of time, as a `ScanMatcher` does."""

    def __init__(self) -> None:
        self._matcher = ScanMatcher()
        self._others: dict[Order, ScanMatcher] | None = None
        self._intervals: deque[float] = deque(maxlen=INTERVALS)
        self._last = np.nan
        self._asked = 0
        self.order: Order = "stated"
        """As it is known so far."""
        self.at_once = False
        """Whether the messages state all beams of a turn at one instant."""

    def take(self, sweep: Sweep) -> None:
        """Take a scan, as `sweep_of` reads its message."""
        if self._others is None:
            self.at_once = sweep.duration == 0.0
            ways: tuple[Order, ...] = ("first to last",) if self.at_once else ()
            self._others = {way: ScanMatcher() for way in (*ways, "last to first")}
        if self.at_once and 0.0 < sweep.time - self._last <= LONGEST_SWEEP:
            self._intervals.append(sweep.time - self._last)
        self._last = sweep.time
        turn = float(np.median(self._intervals)) if self._intervals else USUAL
        self._matcher.take(_seen(sweep, self.order, turn))
        for order, other in self._others.items():
            other.take(_seen(sweep, order, turn))
        if self._others:
            self._decide(self._others)

    def path(self) -> ScanPath:
        """The path of all scans that were taken; the last call of all."""
        return self._matcher.path()

    def _decide(self, others: dict[Order, ScanMatcher]) -> None:
        """By the sign test: in how many scans the echoes lie nearer to the walls."""
        both = set.intersection(*({*each.scatter} for each in (self._matcher, *others.values())))
        if len(both) < max(ORDER_FEWEST, self._asked + 1):
            return
        self._asked = len(both)
        for order, other in list(others.items()):
            nearer = [np.sign(self._matcher.scatter[time] - other.scatter[time]) for time in both]
            sure = float(np.sum(nearer)) / np.sqrt(len(both))
            if sure > ORDER_SURE:
                self._matcher, self.order = other, order
                others.clear()
                return
            if sure < -ORDER_SURE or len(both) >= ORDER_MOST:
                del others[order]


def _seen(sweep: Sweep, order: Order, turn: float) -> Sweep:
    """A sweep in another order; over a turn of so many seconds where it states none."""
    if order == "stated":
        return sweep
    sign = -1.0 if order == "last to first" else 1.0
    return replace(sweep, duration=sign * (sweep.duration or turn))
