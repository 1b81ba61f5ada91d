# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The wheels of one side of the robot as one counter."""

from __future__ import annotations

import math
from collections.abc import Sequence

from werrimbi_odom.model.counter_wraps import wrapped

COUNTER_LIMIT = 2.0**63
"""No counter has more bits; what lies beyond is a broken message, and its square overflows."""


class WheelSide:
    """Mean of several wheels' counters, each wrapped and reset on its own.

    The mean of counters that wrap would jump at each wrap, and so would it when the driver of one
    wheel restarts; so every wheel is counted on by its steps. A wheel that alone falls to near zero
    is taken to have rolled like the others of its side. When all of them fall, the mean falls too:
    that is a reset for the model's encoder to judge.

    Parameters
    ----------
    counts_per_unit : float
        Counts for one unit of position.
    counts_per_revolution : float
    bits : int
        Width at which the counters wrap, to be unwrapped here; 0: they do not, or the model's
        encoder does it.
    """

    def __init__(self, counts_per_unit: float, counts_per_revolution: float, bits: int = 0) -> None:
        self.wraps = 0
        self.resets = 0
        self._scale = counts_per_unit
        self._turn = counts_per_revolution
        self._bits = bits
        self._last: list[float] = []
        self._total: list[float] = []

    def count(self, positions: Sequence[float]) -> float:
        """Counts of the side, for positions of its wheels; not a number if any of them is not."""
        if len(positions) == 1 and not self._bits:
            return positions[0] * self._scale
        counts = [position * self._scale for position in positions]
        if not all(abs(count) < COUNTER_LIMIT for count in counts):
            return math.nan
        if not self._last:
            self._last, self._total = counts, list(counts)
        else:
            self._count_on(counts)
        return math.fsum(self._total) / len(counts)

    def _count_on(self, counts: list[float]) -> None:
        raw = [new - old for new, old in zip(counts, self._last, strict=True)]
        steps = [wrapped(step, self._bits) for step in raw]
        fell = [abs(new) < self._turn < abs(step) for new, step in zip(counts, steps, strict=True)]
        self._last = counts
        if all(fell):
            self._total = list(counts)
            return
        self.wraps += sum(step != unwrapped for step, unwrapped in zip(raw, steps, strict=True))
        if any(fell):
            self.resets += sum(fell)
            rolled = [step for step, fallen in zip(steps, fell, strict=True) if not fallen]
            mean = math.fsum(rolled) / len(rolled)
            steps = [mean if fallen else step for step, fallen in zip(steps, fell, strict=True)]
        self._total = [total + step for total, step in zip(self._total, steps, strict=True)]
