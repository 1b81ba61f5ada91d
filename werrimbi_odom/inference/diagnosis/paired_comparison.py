# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Paired comparison of two models over the same legs: the change of the error, and its p-value.

Both models have the same noise on a leg, so their difference is far more precise than their two
totals. On each leg the errors differ by the known difference δ of the predictions. The data
determine its best weight β, by least squares: 1 where the second model is right, 0 where the first
is. Below one half, the second has the larger squared error. The standard error of β is the larger
of two. One is cluster-robust: residuals are summed over parts of each run, since errors are
correlated over seconds. But two models often differ on a few legs alone; β is then fitted to these,
which leaves hardly a residual there. So the other is by the covariance that the legs promise,
scaled to the residuals of all.

Sources: the encompassing test of two predictions (Chong and Hendry, Rev. Econ. Stud. 53, 1986);
cluster-robust standard errors (Liang and Zeger, Biometrika 73, 1986), and their fault where few
observations decide (Chesher and Jewitt, Econometrica 55, 1987).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.judged_legs import Legs, statistics_of
from werrimbi_odom.inference.distributions import student_survival
from werrimbi_odom.inference.fitting.clusters import parts_of
from werrimbi_odom.model.pose import Floats

Unit = Literal["m", "rad"]


@dataclass(frozen=True, slots=True)
class Sides:
    """An error measure before and after."""

    before: float
    after: float
    unit: Unit = "m"
    """Radians where only headings were measured."""
    chance: float = 1.0
    """P-value of the rise of the error on these legs; 1 where it did not rise."""
    length: float = 0.0
    """Median path length of these legs, longer than asked for where poses are rare [m]."""

    @property
    def fell(self) -> bool:
        """Whether the error fell."""
        return self.after < self.before * (1.0 - rules.HELD_OUT_FALL)

    @property
    def fell_much(self) -> bool:
        """Whether it fell by what a user sees; true where there are no legs to tell."""
        return not self.after > self.before * (1.0 - rules.OUTDATED_FALL)

    @property
    def rose(self) -> bool:
        """Whether the error rose, significantly."""
        return self.chance < rules.SURE_WHEN_ASKED


def sides_of(before: Legs, after: Legs, unit: Unit) -> Sides:
    """Root mean square errors of two models over the same legs, and the p-value of a rise.

    The p-value is of legs without an abrupt event: after an event the end pose may be anything.
    `unit`: "m" for errors of position, "rad" for those of heading.
    """
    errors = error_of(before, unit), error_of(after, unit)
    length = float(np.median(before.errors.length)) if before.errors.length.size else 0.0
    quiet = ~(before.event | after.event)  # each model has its own view of which legs have an event
    before, after = before.chosen(quiet), after.chosen(quiet)
    if not error_of(after, unit) > error_of(before, unit) * (1.0 + rules.HELD_OUT_FALL):
        return Sides(*errors, unit, length=length)
    return Sides(*errors, unit, _chance(before, after, unit), length)


def error_of(legs: Legs, unit: Unit) -> float:
    """Root mean square error of legs, of positions [m] or of headings [rad]."""
    figures = statistics_of(legs)
    return figures.rmse_position_m if unit == "m" else figures.rmse_yaw_rad


def promised_of(legs: Legs, unit: Unit, *, wheels: bool = True) -> float:
    """Root mean square error of legs that their covariance predicts, in the same unit."""
    variances = promised_variances(legs, unit, wheels=wheels)
    return float(np.sqrt(np.mean(variances))) if variances.size else float("nan")


def promised_variances(legs: Legs, unit: Unit, *, wheels: bool = True) -> Floats:
    """Mean square error of each leg that its covariance predicts, (k,), in the square of the unit.

    Without the few legs that begin with an unknown heading, or hold an abrupt event. Without the
    noise of the wheels it is what the reference and the rounding of the counts make.
    """
    quiet = legs.quiet
    errors = quiet.errors.chosen(~quiet.outlier)
    own = slice(0, 2) if unit == "m" else slice(2, 3)
    measured = np.isfinite(errors.error[:, own]).all(axis=1)
    covariance = errors.covariance if wheels else errors.covariance - errors.wheels
    promised = np.trace(covariance[measured, own, own], axis1=1, axis2=2)
    if promised.size == 0:
        return np.zeros(0)
    return np.asarray(promised[promised <= rules.UNUSUAL_PROMISE * np.median(promised)])


def _chance(before: Legs, after: Legs, unit: Unit) -> float:
    """P-value of the second model's larger error, if both models are equally good."""
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
    weight = float(np.sum(difference * first)) / size
    rest = first - weight * difference
    left = np.bincount(parts, np.sum(difference * rest, axis=1))
    promised = after.errors.covariance[kept, own, own]
    dispersion = float(np.sum(rest**2) / np.sum(np.trace(promised, axis1=1, axis2=2)))
    by_promise = dispersion * float(np.einsum("ki,kij,kj", difference, promised, difference))

    def p_value(variance: float, freedom: int) -> float:
        return student_survival((0.5 - weight) * size / max(math.sqrt(variance), 1e-12), freedom)

    by_parts = float(np.sum(left**2)) * count / (count - 1)
    return max(p_value(by_parts, count - 1), p_value(by_promise, rest.size - 1))
