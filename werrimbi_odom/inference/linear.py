# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What data tell of some columns beside others: projection, rank, score test.

Every question of the estimation is one of these. Columns are derivatives of whitened innovations in
parameters. What nuisance parameters can explain is taken off (Frisch, Waugh and Lovell); what is
left of the columns decides how many numbers the data hold, and by how much they would lower the
squared innovations.

The rank rule, the only one: columns are brought to unit length *before* the nuisances are taken
off. A direction of them is determined if at least `DETERMINED` of it is left.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from werrimbi_odom.model.pose import Floats

DETERMINED = 1e-3
"""Share of a direction that other parameters must leave for it to count as determined.

Derivatives are central differences over steps at which laws bend by parts in 10^4 or less, so a
smaller remainder is theirs. One that is real would have to be known a thousand times better than
the same parameter by itself to mean anything."""

ROUNDING = 1e-6
"""The same for the nuisances themselves, whose directions are taken off down to rounding: one too
many costs a degree of freedom, one too few would be called evidence."""

SILENT = 1e-9
"""Length of a whitened column below which its parameter changes nothing that was measured."""


class Nuisance(NamedTuple):
    """What some columns span, to be taken off others."""

    basis: Floats
    """Orthonormal, shape (n, k)."""

    def residual(self, columns: Floats) -> Floats:
        """Vectors or columns (n, ...) less what the nuisances explain of them."""
        return np.asarray(columns - self.basis @ (self.basis.T @ columns))


class ScoreTest(NamedTuple):
    """What some columns would explain."""

    gain: float
    """Fall of the squared innovations."""
    degrees: int
    """How many directions of the columns are determined."""
    coefficients: Floats
    """By how much to move along each column, the determined directions alone; shape (k,)."""


def nuisance(columns: Floats) -> Nuisance:
    """The span of some columns (n, k)."""
    unit, _ = _unit(columns)
    values, axes = np.linalg.eigh(unit.T @ unit)
    kept = values > ROUNDING**2 * values.max(initial=0.0)
    # Twice, since squaring the columns costs half of the digits.
    basis, _ = np.linalg.qr(unit @ (axes[:, kept] / np.sqrt(values[kept])))
    return Nuisance(np.asarray(basis))


def score_test(columns: Floats, free: Floats, residual: Floats) -> ScoreTest | None:
    """Test whether columns explain a residual; None where nothing of them is determined.

    Parameters
    ----------
    columns : ndarray, shape (n, k)
        Derivatives of the innovations.
    free : ndarray, shape (n, k)
        The same less the nuisances.
    residual : ndarray, shape (n,)
        Innovations less the nuisances.
    """
    _, size = _unit(columns)
    cross = free.T @ residual
    return score_test_of_products(free.T @ free, cross, size)


def score_test_of_products(square: Floats, cross: Floats, size: Floats) -> ScoreTest | None:
    """The same from the products of the free columns with each other and with the residual.

    Parameters
    ----------
    size : ndarray, shape (k,)
        Lengths of the columns before the nuisances were taken off.
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


def solved(columns: Floats, target: Floats) -> Floats:
    """Least squares (k,) of a target (n,); directions that are not determined are not moved."""
    unit, size = _unit(columns)
    found = np.linalg.lstsq(unit, target, rcond=ROUNDING)[0]
    result = np.zeros(columns.shape[-1])
    result[size > 0.0] = found / size[size > 0.0]
    return result


def admitted(
    columns: Floats,
    beside: Nuisance,
    known: Callable[[list[int]], bool] = lambda tried: True,
) -> list[int]:
    """Columns that are determined, taken one after the other; what comes first has precedence.

    Of observationally equivalent parameters the first is kept. One that would not be `known` well
    enough beside those that are kept is passed over, and is in the way of none after it.
    """
    _, size = _unit(columns)
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
    """Covariance (k, k) of the least squares of whitened columns (n, k), all of them determined."""
    unit, size = _unit(columns)
    assert size.min(initial=1.0) > 0.0, "a column that is zero has no covariance"
    inverse = np.linalg.pinv(unit.T @ unit, rcond=ROUNDING**2, hermitian=True)
    return np.asarray(inverse / np.outer(size, size))


def _unit(columns: Floats) -> tuple[Floats, Floats]:
    """Columns of unit length, those of length zero left out, and the lengths of all."""
    size = np.sqrt(np.sum(columns**2, axis=0))
    return columns[:, size > 0.0] / size[size > 0.0], size


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
