# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Two models over the same legs, leg by leg: by how much one errs more, and what of it is chance.

Both err by the same noise on the same leg, so what they differ by tells far more than two totals
do. On each leg one model's error is the other's less a known difference δ of their predictions, and
of that difference the drives want a share β: 1 where the second model is right, 0 where the first
is; below one half its squared errors are the larger ones. β is found by least squares, and its
scatter from what is left, taken together in parts of each run, since errors are alike for seconds.

Sources: the encompassing test of two predictions (Chong and Hendry, Rev. Econ. Stud. 53, 1986);
scatter from sums over parts (Liang and Zeger, Biometrika 73, 1986).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from werrimbi_odom.inference.chances import student_above
from werrimbi_odom.inference.comparison.judged_legs import Legs, statistics_of
from werrimbi_odom.inference.fitting.parts import parts_of
from werrimbi_odom.inference.rules import HELD_OUT_FALL, SURE_WHEN_ASKED

Unit = Literal["m", "rad"]


@dataclass(frozen=True, slots=True)
class Sides:
    """A figure before and after."""

    before: float
    after: float
    unit: Unit = "m"
    """Radians where headings alone were measured, and errors are those of the heading."""
    chance: float = 1.0
    """How often chance would raise the errors of these legs as much; 1 where none rose."""

    @property
    def fell(self) -> bool:
        """Whether the error is lower after."""
        return self.after < self.before * (1.0 - HELD_OUT_FALL)

    @property
    def rose(self) -> bool:
        """Whether it is higher, by more than chance."""
        return self.chance < SURE_WHEN_ASKED


def sides_of(before: Legs, after: Legs, unit: Unit) -> Sides:
    """Root mean square errors of two models over the same legs, and the chance of the rise.

    That is told over legs in which nothing happened at once: where it did, a robot ends anywhere.

    Parameters
    ----------
    unit
        "m" for errors of position, "rad" for those of heading.
    """
    errors = error_of(before, unit), error_of(after, unit)
    quiet = ~(before.event | after.event)  # each model has its own view of what happened at once
    before, after = before.chosen(quiet), after.chosen(quiet)
    if not error_of(after, unit) > error_of(before, unit) * (1.0 + HELD_OUT_FALL):
        return Sides(*errors, unit)
    return Sides(*errors, unit, _chance(before, after, unit))


def error_of(legs: Legs, unit: Unit) -> float:
    """Root mean square error of legs, of positions [m] or of headings [rad]."""
    figures = statistics_of(legs)
    return figures.rmse_position_m if unit == "m" else figures.rmse_yaw_rad


def median_of(legs: Legs, unit: Unit) -> float:
    """Median size of the errors of all legs, jumps of the reference among them."""
    if unit == "m":
        return statistics_of(legs).median_position_m
    turned = np.abs(legs.errors.error[:, 2])
    known = turned[np.isfinite(turned)]
    return float(np.median(known)) if known.size else float("nan")


def _chance(before: Legs, after: Legs, unit: Unit) -> float:
    """That two models which are as good as each other differ so much, the second erring more."""
    own = slice(0, 2) if unit == "m" else slice(2, 3)
    first, second = (legs.errors.error[:, own] for legs in (before, after))
    kept = ~(before.outlier | after.outlier) & np.isfinite(first - second).all(axis=1)
    first, second = first[kept], second[kept]
    difference = first - second
    size = float(np.sum(difference**2))
    parts = np.unique(parts_of(before.run[kept]), return_inverse=True)[1] if kept.any() else kept
    count = int(parts.max()) + 1 if kept.any() else 0
    if count < 2 or not size > 0.0:
        return 1.0
    share = float(np.sum(difference * first)) / size
    left = np.sum(difference * (first - share * difference), axis=1)
    scatter = math.sqrt(float(np.sum(np.bincount(parts, left) ** 2)) * count / (count - 1)) / size
    return student_above((0.5 - share) / max(scatter, 1e-12), count - 1)
