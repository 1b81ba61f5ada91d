# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""One rule for an honest covariance (Bar-Shalom: a consistent one), for every verb and the node.

The NEES of legs, error' Σ⁻¹ error over their degrees of freedom, is one where the covariance is
honest. It may be off by `HONEST_WITHIN`, and by what chance does to so few legs.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from statistics import NormalDist
from typing import Literal

from werrimbi_odom.inference.rules import FEWEST_LEGS, HONEST_CHANCE, HONEST_WITHIN

Consistency = Literal["honest", "too small", "too large", "unknown"]
"""What is to be said of a covariance."""

Trend = Literal["longer", "shorter", "between"]
"""With which legs NEES grows: strictly with the longer, with the shorter, or neither."""


@dataclass(frozen=True, slots=True)
class AtLength:
    """What legs of one length say of the covariance."""

    leg: float
    """[m]"""
    count: int
    nees: float
    freedom: int
    """Measured coordinates of all errors."""

    @property
    def says(self) -> Consistency:
        """Whether the covariance is honest at this length."""
        return consistency(self.nees, self.freedom) if self.count >= FEWEST_LEGS else "unknown"


def consistency(nees: float, freedom: int) -> Consistency:
    """Whether a covariance is honest whose errors have so many degrees of freedom in all."""
    if freedom < 1 or not math.isfinite(nees):
        return "unknown"
    low, high = honest_bounds(freedom)
    return "too small" if nees > high else "too large" if nees < low else "honest"


def honest_bounds(freedom: int) -> tuple[float, float]:
    """Between which NEES is called honest."""
    low, high = chance_bounds(freedom, HONEST_CHANCE)
    return min(low, 1.0 / HONEST_WITHIN), max(high, HONEST_WITHIN)


def chance_bounds(freedom: int, share: float) -> tuple[float, float]:
    """Between which the NEES of an exactly honest covariance is with this probability."""
    low, high = (chi_squared_quantile(0.5 + side * share / 2, freedom) for side in (-1, 1))
    return low / freedom, high / freedom


def of_all(lengths: Sequence[AtLength]) -> Consistency:
    """What the lengths of which there are legs enough say together."""
    said = {item.says for item in lengths} - {"unknown"}
    for worst in ("too small", "too large", "honest"):
        if worst in said:
            return worst
    return "unknown"


def told(lengths: Sequence[AtLength]) -> tuple[AtLength, ...]:
    """Those of which there are legs enough, the shortest first."""
    return tuple(
        sorted((item for item in lengths if item.says != "unknown"), key=lambda item: item.leg)
    )


def trend_of(lengths: Sequence[AtLength]) -> Trend:
    """How NEES goes with the length of the legs, of which there are two at least."""
    values = [item.nees for item in told(lengths)]
    steps = [after - before for before, after in pairwise(values)]
    if steps and all(step > 0.0 for step in steps):
        return "longer"
    return "shorter" if steps and all(step < 0.0 for step in steps) else "between"


def chi_squared_quantile(probability: float, freedom: int) -> float:
    """Quantile of chi-squared, by Wilson and Hilferty (1931): the node does without scipy.

    To 0.5 % in the middle 95 %; with 15 degrees of freedom the alarms are 7 % low and 1 % high.
    """
    part = 2.0 / (9.0 * freedom)
    root = 1.0 - part + NormalDist().inv_cdf(probability) * math.sqrt(part)
    return freedom * max(root, 0.0) ** 3
