# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Precision of a fit's parameters, as a function of the noise estimated with them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.distributions import NORMAL_95, student_quantile
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import FreeParameter
from werrimbi_odom.inference.fitting.likelihood import Variances
from werrimbi_odom.inference.fitting.noise import NoiseEstimate, with_noises
from werrimbi_odom.inference.fitting.whitened_innovations import (
    Design,
    Point,
    jacobian_of,
    unexpected,
    with_columns_per_run,
)
from werrimbi_odom.inference.linear import covariance_of
from werrimbi_odom.model.pose import Floats


@dataclass(frozen=True, slots=True)
class Precision:
    """Jacobian of the fitted parameters, to be whitened by any noise."""

    runs: Concatenated
    point: Point
    local: tuple[FreeParameter, ...]
    """Parameters of the columns of `slopes`."""
    slopes: Floats
    moves: Floats
    """Step of the design's columns for a unit of each free direction, (p, q)."""

    @classmethod
    def of(
        cls, runs: Concatenated, point: Point, local: Sequence[FreeParameter], moves: Floats
    ) -> Precision:
        """Precision at the end point of a fit; start headings are not in `local`."""
        numbers = tuple(local)
        return cls(runs, point, numbers, jacobian_of(runs, point.model, numbers), moves)

    def _design(self, variances: Variances) -> Design:
        point = replace(self.point, variances=variances)
        found = unexpected(self.runs, point)
        marks = found.marks(self.slopes)
        return with_columns_per_run(self.runs, point, found.whitened(), marks, self.local)

    def information(self, variances: Variances) -> float:
        """Log determinant of the information matrix of the free directions."""
        marks = self._design(variances).flat()[1] @ self.moves
        return float(np.linalg.slogdet(marks.T @ marks)[1])

    def _variances_of(self, names: Sequence[str], variances: Variances) -> Floats:
        """Variances of shared parameters."""
        design = self._design(variances)
        columns = design.names
        rows = self.moves[[columns.index(name) for name in names]]
        inside = covariance_of(design.flat()[1] @ self.moves)
        return np.asarray(np.einsum("pi,ij,pj->p", rows, inside, rows))

    def widening(self, noises: Mapping[str, NoiseEstimate], names: Sequence[str]) -> Floats:
        """Factor on the standard deviations of shared parameters, so that 1.96 of them cover 95 %.

        A fit treats its noise estimate as known. Here variances are averaged over the log-normal
        distribution of each noise (law of total variance, three-point Gauss-Hermite quadrature).
        The standard deviations are widened by Student's t, with effective degrees of freedom by
        Satterthwaite (Biometrics 2, 1946).
        """
        given = self.point.variances
        centre = with_noises(given, {name: item.value for name, item in noises.items()})
        fitted = self._variances_of(names, given)
        middle = self._variances_of(names, centre)
        found, scatter = middle, np.zeros(len(names))
        for name, noise in noises.items():
            step = math.sqrt(3.0) * min(noise.share, rules.LEAST_KNOWN)
            if step > 0.0:
                values = [noise.value * math.exp(sign * step) for sign in (1.0, -1.0)]
                more, less = (
                    self._variances_of(names, with_noises(centre, {name: value}))
                    for value in values
                )
                found = found + (more + less - 2.0 * middle) / 6.0
                scatter += np.log(more / less) ** 2 / 12.0  # variance of a log variance
        # With n degrees of freedom it is 2 / n; below three, t has no standard deviation.
        freedom = 2.0 / np.clip(scatter, 1e-6, 0.6)
        wide = np.array([student_quantile(0.975, degrees) for degrees in freedom]) / NORMAL_95
        return np.asarray(wide * np.sqrt(found / fitted))
