# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Pairs the counts of two wheels that arrive in separate messages."""

from __future__ import annotations

import math
from dataclasses import dataclass


class Pairing:
    """Pairs counts by arrival, each with the nearest of the other wheel within a window.

    A count is paired with the other wheel's waiting one; a later count that is closer in time
    replaces it. So pairing that is off by one message, after a lost one, corrects itself. A count
    without a partner is dropped; the next one contains its motion. `window`: largest time between
    the two counts of one reading [ns].
    """

    def __init__(self, window: int) -> None:
        self._window = window
        self._newest = [_Count(), _Count()]
        self.unpaired = 0
        """Number of counts without a partner."""
        self.earlier = 0
        """Number of counts that waited for their partner: the earlier one of each pair."""

    @property
    def waiting(self) -> int:
        """Number of counts that may still find a partner."""
        return sum(count.waits for count in self._newest)

    def take(self, side: int, value: int, arrival: int) -> tuple[int, int] | None:
        """Add a count; return the left and the right count if it has a partner.

        `side`: 0 for left, 1 for right. `arrival`: [ns].
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
    """A count of one wheel, and the time distance of its partner."""

    value: int = 0
    arrival: int = -(10**18)
    """[ns]"""
    apart: float = math.inf
    """[ns]; infinite without a partner."""

    @property
    def waits(self) -> bool:
        return self.apart == math.inf and self.arrival > -(10**18)
