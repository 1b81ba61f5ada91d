# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Consistency of a covariance (Bar-Shalom): one rule for all commands and the node.

The normalised estimation error squared (NEES) is error' Σ⁻¹ error over its degrees of freedom. Its
expectation is one if the covariance is consistent. It may deviate by the factor `HONEST_WITHIN`, or
by what is due to chance with so few legs, whichever is more.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from statistics import NormalDist
from typing import Literal

from werrimbi_odom.inference import rules

Consistency = Literal["honest", "too small", "too large", "unknown"]
"""Result of the test of a covariance."""

Trend = Literal["longer", "shorter", "between"]
"""Whether NEES strictly grows with leg length, strictly falls, or neither."""


@dataclass(frozen=True, slots=True)
class AtLength:
    """NEES of the legs of one length."""

    leg: float
    """[m]"""
    count: int
    nees: float
    freedom: int
    """Degrees of freedom: measured coordinates of all errors."""
    median: float = 0.0
    """Median path of the legs, longer than `leg` where poses are rare [m]."""

    @property
    def says(self) -> Consistency:
        """Whether the covariance is consistent at this length."""
        return (
            consistency(self.nees, self.freedom) if self.count >= rules.FEWEST_LEGS else "unknown"
        )


def consistency(nees: float, freedom: int) -> Consistency:
    """Test a covariance by the NEES of errors with `freedom` degrees of freedom in total."""
    if freedom < 1 or not math.isfinite(nees):
        return "unknown"
    low, high = honest_bounds(freedom)
    return "too small" if nees > high else "too large" if nees < low else "honest"


def honest_bounds(freedom: int) -> tuple[float, float]:
    """Interval of NEES that counts as consistent."""
    low, high = chance_bounds(freedom, rules.HONEST_CHANCE)
    return min(low, 1.0 / rules.HONEST_WITHIN), max(high, rules.HONEST_WITHIN)


def chance_bounds(freedom: int, share: float) -> tuple[float, float]:
    """Interval that holds the NEES of a consistent covariance with probability `share`."""
    low, high = (chi_squared_quantile(0.5 + side * share / 2, freedom) for side in (-1, 1))
    return low / freedom, high / freedom


def of_all(lengths: Sequence[AtLength]) -> Consistency:
    """Combined result of the lengths with enough legs: the worst."""
    said = {item.says for item in lengths} - {"unknown"}
    for worst in ("too small", "too large", "honest"):
        if worst in said:
            return worst
    return "unknown"


def judged_lengths(lengths: Sequence[AtLength]) -> tuple[AtLength, ...]:
    """Lengths with enough legs, ascending."""
    return tuple(
        sorted((item for item in lengths if item.says != "unknown"), key=lambda item: item.leg)
    )


def trend_of(lengths: Sequence[AtLength]) -> Trend:
    """Trend of NEES with leg length, for two lengths or more."""
    values = [item.nees for item in judged_lengths(lengths)]
    steps = [after - before for before, after in pairwise(values)]
    if steps and all(step > 0.0 for step in steps):
        return "longer"
    return "shorter" if steps and all(step < 0.0 for step in steps) else "between"


def chi_squared_quantile(probability: float, freedom: int) -> float:
    """Chi-squared quantile by Wilson and Hilferty (1931), as the node does without scipy.

    Exact to 0.5 % in the middle 95 %; with 15 degrees of freedom the alarm thresholds are 7 % low
    and 1 % high.
    """
    part = 2.0 / (9.0 * freedom)
    root = 1.0 - part + NormalDist().inv_cdf(probability) * math.sqrt(part)
    return freedom * max(root, 0.0) ** 3
