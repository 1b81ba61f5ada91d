# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Which way a lidar's beams were seen: first to last, as their messages say, or last to first.

A lidar that turns clockwise fills its arrays from the end, and some of their drivers state the time
between beams as if it did not (a TurtleBot3's LDS-02 among them). Deskewed the wrong way, a scan of
a robot that turns is bent by twice what it was: its echoes lie farther from the walls. So both ways
are matched until the walls have told.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from werrimbi_odom.scans.limits import ORDER_FEWEST, ORDER_MOST, ORDER_SURE
from werrimbi_odom.scans.path import ScanMatcher, ScanPath
from werrimbi_odom.scans.sweep import Sweep


class EitherOrder:
    """Takes scans in the order of time, as a `ScanMatcher` does."""

    def __init__(self) -> None:
        self._matcher = ScanMatcher()
        self._other: ScanMatcher | None = ScanMatcher()
        self._asked = 0
        self.backwards = False
        """Whether the beams were seen last to first; as it is known so far."""

    def take(self, sweep: Sweep) -> None:
        """Take a scan, as `sweep_of` reads its message."""
        self._matcher.take(_backwards(sweep) if self.backwards else sweep)
        if sweep.after.size and not sweep.after.any():
            self._other = None  # all beams at once
        if self._other is not None:
            self._other.take(_backwards(sweep))
            self._decide(self._other)

    def path(self) -> ScanPath:
        """The path of all scans that were taken; the last call of all."""
        return self._matcher.path()

    def _decide(self, other: ScanMatcher) -> None:
        """By the sign test: in how many scans the echoes lie nearer to the walls."""
        both = self._matcher.scatter.keys() & other.scatter.keys()
        if len(both) < max(ORDER_FEWEST, self._asked + 1):
            return
        self._asked = len(both)
        nearer = [np.sign(self._matcher.scatter[time] - other.scatter[time]) for time in both]
        sure = float(np.sum(nearer)) / np.sqrt(len(both))
        if sure > ORDER_SURE:
            self._matcher, self.backwards = other, True
        if abs(sure) > ORDER_SURE or len(both) >= ORDER_MOST:
            self._other = None


def _backwards(sweep: Sweep) -> Sweep:
    return replace(sweep, after=-sweep.after)
