# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Pairs the counts of two wheels that arrive in separate messages.

The node pairs them as they arrive. In a recording wheels that are sent at different rates can be
brought to the same instants, since what follows is known too.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.pose import Floats

UNLIKE = 0.1
"""Share by which the intervals of two topics differ from which on they are of different rates: the
counts of a pair are then apart by anything up to half an interval, and that beats. Timers of one
rate differ by less, and what they are apart by is the skew of a pair, which is an effect."""
_FEWEST = 20
"""Counts of each wheel from which on a rate is known."""
_BETWEEN = 4.0
"""Longest gap between the counts of the faster topic [intervals] in which it is on a line."""
_OF_A_PAIR = 3.0
"""Multiple of the median distance of both wheels' counts beyond which the partner is missing."""


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


def at_the_same_instants(
    times: tuple[Floats, Floats], counts: tuple[NDArray[np.int64], NDArray[np.int64]]
) -> tuple[Floats, NDArray[np.int64], NDArray[np.int64]] | None:
    """Counts of both wheels when the slower topic's were read, if their rates differ; else None.

    `times`: of each topic, ascending [s]. `counts`: unwrapped. Those of the faster topic are on the
    line between the counts before and after, rounded.
    """
    if min(each.size for each in times) < _FEWEST:
        return None
    every = [float(np.median(np.diff(each))) for each in times]
    slow = int(every[1] > every[0])
    if every[slow] < (1.0 + UNLIKE) * every[1 - slow]:
        return None
    time, fast = times[slow], times[1 - slow]
    after = np.clip(np.searchsorted(fast, time), 1, fast.size - 1)
    gap = fast[after] - fast[after - 1]
    known = (time >= fast[0]) & (time <= fast[-1]) & (gap <= _BETWEEN * every[1 - slow])
    if not known.any():
        return None
    begun = counts[1 - slow][0]
    line = np.rint(np.interp(time, fast, counts[1 - slow] - begun)).astype(np.int64) + begun
    left, right = (counts[0], line) if slow == 0 else (line, counts[1])
    return time[known], left[known], right[known]


def apart_words(time: Floats, right: NDArray[np.bool_], window: float) -> str:
    """How far apart the counts of both wheels are as a rule, and the window that takes them.

    `time`: of all counts [s]. `right`: which are the right wheel's. `window`: as given [s]. Result:
    the end of a sentence; "" if one wheel is missing.
    """
    left = np.sort(time[~right])
    if left.size < 2 or not right.any():
        return ""
    after = np.searchsorted(left, time[right])
    beside = left[np.stack([np.maximum(after - 1, 0), np.minimum(after, left.size - 1)])]
    gaps = np.abs(beside - time[right]).min(axis=0)
    gap = float(np.median(gaps))
    most = float(gaps[gaps <= _OF_A_PAIR * gap].max())
    return (
        f", {window:g} s; a count of the one wheel and the nearest of the other are "
        f"{gap:.2g} s apart as a rule: pairing_window: {1.2 * most:.2g} takes them"
    )
