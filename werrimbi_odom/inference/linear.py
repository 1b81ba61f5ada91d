# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Linear algebra of the estimation: projection of nuisance parameters, numerical rank, score test.

Columns are those of the Jacobian of the whitened innovations in the parameters. The span of the
nuisance parameters is projected out (theorem of Frisch, Waugh and Lovell). What remains of the
columns decides how many parameters are identifiable, and by how much they would lower the sum of
squared innovations.

There is one rank rule: columns are scaled to unit length *before* the nuisances are projected out.
A direction is determined if at least `DETERMINED` of it remains.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from werrimbi_odom.model.pose import Floats

DETERMINED = 1e-3
"""Share of a direction that must remain after projection for it to count as determined.

Derivatives are central differences, over steps at which the models are nonlinear by parts in 10^4
or less, so a smaller remainder is an artefact of these. A real one would mean something only if the
parameter were known a thousand times better than by itself."""

ROUNDING = 1e-6
"""The same threshold for the nuisances themselves, whose directions are projected out down to
rounding: one too many costs a degree of freedom, one too few would be taken for evidence."""

SILENT = 1e-9
"""Norm of a whitened column below which its parameter has no effect on what was measured."""


class Nuisance(NamedTuple):
    """Column space of the nuisance parameters, to be projected out of others."""

    basis: Floats
    """Orthonormal basis, shape (n, k)."""

    def residual(self, columns: Floats) -> Floats:
        """Project the nuisances out of vectors or columns (n, ...)."""
        return np.asarray(columns - self.basis @ (self.basis.T @ columns))


class ScoreTest(NamedTuple):
    """Result of a score test (Lagrange multiplier test)."""

    gain: float
    """Test statistic: predicted fall of the sum of squared innovations."""
    degrees: int
    """Degrees of freedom: determined directions of the columns."""
    coefficients: Floats
    """Step of each parameter, along the determined directions only; shape (k,)."""


def nuisance(columns: Floats) -> Nuisance:
    """Orthonormal basis of the span of some columns (n, k)."""
    unit, _ = _unit(columns)
    values, axes = np.linalg.eigh(unit.T @ unit)
    kept = values > ROUNDING**2 * values.max(initial=0.0)
    # Orthogonalised twice, since forming the Gram matrix costs half of the digits.
    basis, _ = np.linalg.qr(unit @ (axes[:, kept] / np.sqrt(values[kept])))
    return Nuisance(np.asarray(basis))


def score_test(columns: Floats, free: Floats, residual: Floats) -> ScoreTest | None:
    """Score test of whether columns explain a residual; None if no direction is determined.

    `columns` (n, k): Jacobian of the innovations in the tested parameters. `free` (n, k): the same
    with the nuisances projected out. `residual` (n,): innovations with the nuisances projected out.
    """
    return score_test_of_products(free.T @ free, free.T @ residual, _lengths(columns))


def score_test_of_products(square: Floats, cross: Floats, size: Floats) -> ScoreTest | None:
    """Score test from the normal equations: `free.T @ free` and `free.T @ residual`.

    `square` (k, k): Gram matrix of the free columns. `cross` (k,): products of the free columns
    with the residual. `size` (k,): norms of the columns before the nuisances were projected out.
    """
    heard = size > SILENT
    if not heard.any():
        return None
    lengths = size[heard]
    values, axes = np.linalg.eigh(square[np.ix_(heard, heard)] / np.outer(lengths, lengths))
    kept = values > DETERMINED**2
    if not kept.any():
        return None
    root = np.sqrt(values[kept])
    shares = axes[:, kept].T @ (cross[heard] / lengths) / root
    coefficients = np.zeros(size.size)
    coefficients[heard] = -(axes[:, kept] @ (shares / root)) / lengths
    return ScoreTest(float(shares @ shares), int(kept.sum()), coefficients)


def within_reach(free: Floats, residual: Floats, reach: Floats) -> Floats:
    """Coefficients (k,) of columns that explain a residual, with standard deviations known before.

    Where columns do nearly the same, their difference takes any value for a little of noise. The
    prior keeps it, and hardly moves what the columns determine. `free` (n, k). `residual` (n,).
    `reach` (k,): prior standard deviations about zero.
    """
    square = free.T @ free + np.diag(reach**-2.0)
    return np.asarray(np.linalg.solve(square, -(free.T @ residual)))


def solved(columns: Floats, target: Floats, least: float = ROUNDING) -> Floats:
    """Least-squares solution (k,) for a target (n,), zero along undetermined directions.

    `least`: singular value of the columns at unit length, relative to the largest, below which a
    direction is undetermined.
    """
    unit, size = _unit(columns)
    found = np.linalg.lstsq(unit, target, rcond=least)[0]
    result = np.zeros(columns.shape[-1])
    result[size > 0.0] = found / size[size > 0.0]
    return result


def admitted(
    columns: Floats, beside: Nuisance, known: Callable[[list[int]], bool] = lambda tried: True
) -> list[int]:
    """Select identifiable columns greedily; earlier columns have precedence.

    Of observationally equivalent parameters the first is kept. A column for which `known` is false,
    as its parameter would be too uncertain beside those kept, is skipped and does not block later
    ones.
    """
    size = _lengths(columns)
    free = beside.residual(columns)
    kept: list[int] = []
    for column in range(columns.shape[-1]):
        if size[column] <= SILENT:
            continue
        others = nuisance(free[:, kept]).residual(free[:, column])
        if float(np.sqrt(others @ others)) > DETERMINED * size[column] and known([*kept, column]):
            kept.append(column)
    return kept


def covariance_of(columns: Floats) -> Floats:
    """Covariance (k, k) of the least-squares estimate for whitened columns (n, k) of full rank."""
    unit, size = _unit(columns)
    assert size.min(initial=1.0) > 0.0, "a column that is zero has no covariance"
    inverse = np.linalg.pinv(unit.T @ unit, rcond=ROUNDING**2, hermitian=True)
    return np.asarray(inverse / np.outer(size, size))


def _unit(columns: Floats) -> tuple[Floats, Floats]:
    """Scale columns to unit length, without those of length zero; also return all lengths."""
    size = _lengths(columns)
    return columns[:, size > 0.0] / size[size > 0.0], size


def _lengths(columns: Floats) -> Floats:
    return np.asarray(np.sqrt(np.sum(columns**2, axis=0)))


def inverse_root(covariance: Floats) -> Floats:
    """Inverse of the lower Cholesky factor of each of many covariances, (..., 3, 3).

    By the formulas, for all at once: LAPACK, asked for each, takes ten times as long.

    Raises
    ------
    numpy.linalg.LinAlgError
        When one is not positive definite.
    """
    with np.errstate(invalid="ignore", divide="ignore"):
        first = 1.0 / np.sqrt(covariance[..., 0, 0])
        low, lowest = covariance[..., 1, 0] * first, covariance[..., 2, 0] * first
        second = 1.0 / np.sqrt(covariance[..., 1, 1] - low * low)
        lower = (covariance[..., 2, 1] - lowest * low) * second
        third = 1.0 / np.sqrt(covariance[..., 2, 2] - lowest * lowest - lower * lower)
    root = np.zeros(covariance.shape)
    root[..., 0, 0], root[..., 1, 1], root[..., 2, 2] = first, second, third
    root[..., 1, 0], root[..., 2, 1] = -low * first * second, -lower * second * third
    root[..., 2, 0] = (low * second * lower - lowest) * first * third
    if not np.isfinite(root).all():
        raise np.linalg.LinAlgError("a covariance is not positive definite")
    return root


def square_and_volume(covariance: Floats, value: Floats) -> tuple[Floats, Floats]:
    """Squares of vectors (..., 3) against covariances (..., 3, 3), and logarithms of their sizes.

    That is v' C^-1 v and log |det C|, by cofactors: where rounding has left a matrix that is no
    covariance, numbers come out all the same.
    """
    a, b, c = (covariance[..., 0, column] for column in range(3))
    d, e, f = covariance[..., 1, 1], covariance[..., 1, 2], covariance[..., 2, 2]
    x, y, z = (value[..., axis] for axis in range(3))
    aa, ab, ac = d * f - e * e, c * e - b * f, b * e - c * d
    size = a * aa + b * ab + c * ac
    square = x * x * aa + y * y * (a * f - c * c) + z * z * (a * d - b * b)
    square += 2.0 * (x * y * ab + x * z * ac + y * z * (b * c - a * e))
    return np.asarray(square / size), np.log(np.abs(size))
