# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Combines the wheels of one side of the robot into one counter."""

from __future__ import annotations

import math
from collections.abc import Sequence

from werrimbi_odom.model.counter_wraps import wrapped

COUNTER_LIMIT = 2.0**63
"""Limit of all counters (64 bits); larger values are broken messages, and their squares
overflow."""


class WheelSide:
    """Mean of several wheels' counters, with wraps and resets handled per wheel.

    The mean of raw counters would jump when one wheel's counter wraps or its driver restarts, so
    each wheel's increments are summed. If a single wheel falls to near zero, it is assumed to have
    rolled like the others of its side. If all of them fall, the mean falls too, and the model's
    encoder detects the reset.

    `bits` is the width at which the counters wrap, to be unwrapped here; 0: they do not wrap, or
    the model's encoder unwraps them.
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
        """Counts of the side, given the positions of its wheels; NaN if any is not finite."""
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
