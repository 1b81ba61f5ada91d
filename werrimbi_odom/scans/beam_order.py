# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Order in which the beams of a turn were measured: as stated, unless the scans contradict it.

A lidar that turns clockwise fills its arrays from the end, and some of their drivers state a
positive time between beams nevertheless (a TurtleBot3's LDS-02 among them). Others state zero, as
if all beams were simultaneous (some of a Neato's). A wrong order deskews the scan of a turning
robot wrongly, and its echoes lie farther from the walls. So all orders are matched in parallel
until a sign test decides.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Collection, Sequence
from dataclasses import replace
from typing import Literal

import numpy as np

from werrimbi_odom.model.pose import Floats
from werrimbi_odom.scans.limits import (
    LONGEST_SWEEP,
    ORDER_FEWEST,
    ORDER_MOST,
    ORDER_STRETCH,
    ORDER_STRETCHES,
    ORDER_SURE,
)
from werrimbi_odom.scans.sweep import Sweep
from werrimbi_odom.scans.three_pass_odometry import INTERVALS, USUAL, ScanMatcher, ScanPath

Order = Literal["stated", "first to last", "last to first"]
"""Order in which the beams of a turn were measured."""


class AnyOrder:
    """A `ScanMatcher` that estimates the order of the beams; takes scans in the order of time."""

    def __init__(self) -> None:
        self._matcher = ScanMatcher()
        self._others: dict[Order, ScanMatcher] | None = None
        self._intervals: deque[float] = deque(maxlen=INTERVALS)
        self._last = np.nan
        self._asked = 0
        self.order: Order = "stated"
        """The order as decided so far."""
        self.at_once = False
        """Whether the messages give all beams of a turn the same time."""

    def take(self, sweep: Sweep) -> None:
        """Take a scan, as `sweep_of` reads it from its message."""
        if self._others is None:
            self.at_once = sweep.duration == 0.0
            ways: list[Order] = ["first to last"] if sweep.duration <= 0.0 else []
            ways += ["last to first"] if sweep.duration >= 0.0 else []
            self._others = {way: ScanMatcher() for way in ways}
        if self.at_once and 0.0 < sweep.time - self._last <= LONGEST_SWEEP:
            self._intervals.append(sweep.time - self._last)
        self._last = sweep.time
        turn = self._turn
        self._matcher.take(_seen(sweep, self.order, turn))
        for order, other in self._others.items():
            other.take(_seen(sweep, order, turn))
        if self._others:
            self._decide(self._others)

    def headings(self, most: int) -> Floats:
        """Of the last poses so far; see `ScanMatcher.headings`."""
        return self._matcher.headings(most)

    def path(self) -> ScanPath:
        """The path of all scans taken; call it last.

        The stamp is that of the first beam. If the others are not simultaneous with it, although
        the messages say so, the middle of the turn is half a turn later.
        """
        path = self._matcher.path()
        if not self.at_once or self.order == "stated":
            return path
        return replace(path, time=path.time + 0.5 * self._turn)

    @property
    def _turn(self) -> float:
        return float(np.median(self._intervals)) if self._intervals else USUAL

    def _decide(self, others: dict[Order, ScanMatcher]) -> None:
        """Decide by a sign test: in how many scans the echoes lie nearer to the walls.

        One turn in new territory, as of a robot that is carried, is one swing of the map however
        many scans it has: several stretches must agree before a driver is overruled. (One that
        states zero has said nothing.)
        """
        both = set.intersection(*({*each.scatter} for each in (self._matcher, *others.values())))
        if len(both) < max(ORDER_FEWEST, self._asked + 1):
            return
        self._asked = len(both)
        for order, other in list(others.items()):
            nearer = [np.sign(self._matcher.scatter[time] - other.scatter[time]) for time in both]
            sure = float(np.sum(nearer)) / np.sqrt(len(both))
            if sure > ORDER_SURE and (self.at_once or _stretches(both, nearer) >= ORDER_STRETCHES):
                self._matcher, self.order = other, order
                others.clear()
                return
            if sure < -ORDER_SURE or len(both) >= ORDER_MOST:
                del others[order]


def _stretches(times: Collection[float], nearer: Sequence[float]) -> int:
    """In how many more stretches the majority of scans has it than contradicts it."""
    _, stretch = np.unique(np.floor_divide([*times], ORDER_STRETCH), return_inverse=True)
    return int(np.sum(np.sign(np.bincount(stretch, weights=nearer))))


def _seen(sweep: Sweep, order: Order, turn: float) -> Sweep:
    """A sweep with another order of its beams; `turn` is its duration [s] if it states none."""
    if order == "stated":
        return sweep
    sign = -1.0 if order == "last to first" else 1.0
    return replace(sweep, duration=sign * (abs(sweep.duration) or turn))
