# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Counts of two wheels that come in messages of their own: which belong together."""

from __future__ import annotations

import math
from dataclasses import dataclass


class Pairing:
    """Pairs counts by arrival, each with the nearest of the other wheel within a window.

    That is the one that waits, or, when the next one comes closer than that did, this. So a pairing
    that began one message off, after a lost one, mends itself. What finds no partner is dropped,
    and its motion is in the next one.

    Parameters
    ----------
    window : int
        Farthest that two counts of one reading may be apart [ns].
    """

    def __init__(self, window: int) -> None:
        self._window = window
        self._newest = [_Count(), _Count()]
        self.unpaired = 0
        """Counts that found no partner."""
        self.earlier = 0
        """Counts that waited for theirs: each pair has one that came first."""

    @property
    def waiting(self) -> int:
        """Counts that may still find one."""
        return sum(count.waits for count in self._newest)

    def take(self, side: int, value: int, arrival: int) -> tuple[int, int] | None:
        """Take a count; the left and the right one where it has a partner.

        Parameters
        ----------
        side : int
            0 for left, 1 for right.
        arrival : int
            [ns]
        """
        self.unpaired += self._newest[side].waits
        count = self._newest[side] = _Count(value, arrival)
        other = self._newest[1 - side]
        apart = abs(count.arrival - other.arrival)
        if apart > self._window or apart >= other.apart:
            return None
        self.earlier += other.waits
        count.apart = other.apart = apart
        left, right = self._newest
        return left.value, right.value


@dataclass(slots=True)
class _Count:
    """A count of one wheel, and how far in time its partner was."""

    value: int = 0
    arrival: int = -(10**18)
    """[ns]"""
    apart: float = math.inf
    """[ns]; infinite while it has none."""

    @property
    def waits(self) -> bool:
        return self.apart == math.inf and self.arrival > -(10**18)
