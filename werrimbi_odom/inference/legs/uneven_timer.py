# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Estimate how uneven the timer was that read the counters, where stamps tell arrival only.

A program that sleeps between readings wakes up a millisecond or two early or late. Its own stamps
would tell; of stamps of arrival, `even_stamps` can only make those of an even timer. What remains
moves the counts of both wheels by their rates at once: a wheel that turns evenly seems to jump
ahead and fall back, and its acceleration by such counts is mostly that error. Longitudinal slip and
backlash were named where there were none.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded

from werrimbi_odom.inference import rules
from werrimbi_odom.model.encoder_online import Counts
from werrimbi_odom.model.pose import Floats


def with_uneven_timer(time: Floats, left: Counts, right: Counts) -> Floats:
    """Move the readings of a timer that is taken for even to when both wheels say they were made.

    `time` (n,): ascending times [s] of an even timer; `left`, `right` (n,): cumulative counts.
    Result (n,): ascending times [s], the same if the timer was even.

    Readings are moved such that third differences of the counts become small: penalised least
    squares, with a normal prior of the timer and a Cauchy likelihood of the counts, as robots start
    and stop suddenly. The prior's standard deviation is chosen by cross-validation: times by the
    one wheel must make the counts of the other smoother. Of those within a standard error of the
    best it is the smallest (Breiman et al. 1984, "Classification and Regression Trees", 3.4.3).
    """
    counts = np.stack([left, right]).astype(np.float64)
    if time.size < rules.EVEN_MESSAGES or not np.isfinite(counts).all():
        return time
    period = float(np.median(np.diff(time)))
    rates = np.gradient(counts, axis=1) / period
    one_on = np.abs(np.diff(time) / period - 1.0) < rules.UNEVEN_NEXT
    kept = one_on[:-2] & one_on[1:-1] & one_on[2:]
    wheels = _Wheels(counts[:1], rates[:1], kept), _Wheels(counts[1:], rates[1:], kept)
    spreads = [0.0, *(share * period for share in rules.UNEVEN_SHARES)]
    gains = np.zeros((len(spreads), int(kept.sum())))
    for number, spread in enumerate(spreads[1:], 1):
        for one, other in (wheels, wheels[::-1]):
            gains[number] += other.gain(one.moved(spread))
    best = gains[np.argmax(gains.sum(axis=1))]
    error = np.std(best) * np.sqrt(best.size)
    if best.sum() <= rules.EVEN_SURE * error:
        return time
    spread = spreads[int(np.argmax(gains.sum(axis=1) >= best.sum() - error))]
    tenth = 0.1 * period * np.arange(float(time.size))  # keeps readings in order
    moved = time + _Wheels(counts, rates, kept).moved(spread)
    return np.asarray(np.maximum.accumulate(moved - tenth) + tenth)


@dataclass(frozen=True)
class _Wheels:
    """One wheel or both: counts (k, n), their rates [1/s], and whether readings follow at once."""

    counts: Floats
    rates: Floats
    kept: NDArray[np.bool_]

    @cached_property
    def rough(self) -> Floats:
        """Third differences of the counts as they were told, (k, n - 3)."""
        return _third(self.counts)

    def moved(self, spread: float) -> Floats:
        """Deviations of the readings from an even timer, (n,) [s], whose std is `spread` [s]."""
        size = self.counts.shape[1]
        slope = np.stack(
            [
                weight * self.rates[:, first : first + size - 3]
                for first, weight in enumerate(_third(np.eye(4))[:, 0])
            ]
        )
        least = rules.UNEVEN_REST * self._scale(self.rough)
        moved = np.zeros(size)
        for _ in range(rules.UNEVEN_STEPS):
            rest = self.rough - _third(self.rates * moved)
            weight = self.kept / (np.maximum(self._scale(rest), least) ** 2 + rest**2)
            matrix, right = np.zeros((4, size)), np.zeros(size)
            matrix[3] = spread**-2.0
            for i in range(4):
                right[i : i + size - 3] += (weight * slope[i] * self.rough).sum(axis=0)
                for j in range(i, 4):
                    both = (weight * slope[i] * slope[j]).sum(axis=0)
                    matrix[3 - (j - i), j : j + size - 3] += both
            moved = solveh_banded(matrix, right)
        return np.asarray(moved)

    def gain(self, moved: Floats) -> Floats:
        """Gain of log-likelihood of a wheel's third differences by deviations `moved`, (n,) [s]."""
        left = self.rough - _third(self.rates * moved)
        square = self._scale(self.rough) ** 2
        gain = np.log1p(self.rough**2 / square) - np.log1p(left**2 / square)
        return np.asarray(gain[:, self.kept].sum(axis=0))

    def _scale(self, rest: Floats) -> Floats:
        """Typical size of what is left of the third differences of a wheel that turns, (k, 1)."""
        turns = self.kept & (self.rough != 0.0)
        left = [np.abs(of_wheel[when]) for of_wheel, when in zip(rest, turns, strict=True)]
        return np.array([[np.median(size) if size.size else 1.0] for size in left])


def _third(values: Floats) -> Floats:
    """Third differences along the last axis, (..., n - 3)."""
    return np.asarray(np.diff(values, n=3, axis=-1))
