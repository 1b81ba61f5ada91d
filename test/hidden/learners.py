# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""General learners, as they come: what is left of a leg, learnt from what was measured in it.

- sindy: PySINDy's sequentially thresholded least squares, on products of speeds and yaw rates with
  each measured thing.
- omp: orthogonal matching pursuit on the same (scikit-learn).
- boosting: histogram gradient boosting (scikit-learn).
- gp: a Gaussian process with a length for each measured thing (scikit-learn).

How freely they learn they choose by cross-validation over drives, each coordinate for itself.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from werrimbi_odom.model.pose import Floats

CHOICES: dict[str, tuple[float, ...]] = {
    "sindy": (0.1, 0.2, 0.4, 0.8, 1.6),
    "omp": (1, 2, 3, 4, 6, 8, 12, 16),
    "boosting": (30, 100, 300),
    "gp": (1.0,),
}
"""How freely each may learn: threshold over noise, number of terms, number of trees; beside not
learning at all, which cross-validation may choose too."""
RIDGE = 0.01
"""Of SINDy, for each leg, where each term has a mean square of 1: many terms are much alike."""
POINTS = {"lengths": 300, "all": 1500}
"""Of a Gaussian process: legs from which its lengths are learnt, and legs that it is fitted to."""


class Legs(NamedTuple):
    """Short legs: what was measured in them, and what the calibrated robot leaves."""

    plain: Floats
    """Means of what was measured, times and ways, (m, k)."""
    products: Floats
    """Integrals over time of speeds and yaw rates, alone and times a measured thing, (m, j)."""
    left: Floats
    """(m, 3): measured less predicted."""
    run: np.ndarray[Any, np.dtype[np.intp]]


Learnt = Callable[[Legs], Floats]


def learnt(peer: str, legs: Legs) -> Learnt:
    """What a peer learns; how freely, it chooses by leaving out drives."""
    told = np.isfinite(legs.left).all(axis=1)
    legs = Legs(*(column[told] for column in legs))
    noise = np.median(np.abs(legs.left - np.median(legs.left, axis=0)), axis=0) * 1.4826
    folds = [legs.run == run for run in np.unique(legs.run)]
    best: tuple[Floats, list[float | None]] = (np.full(3, np.inf), [None] * 3)
    if peer == "gp":
        return _fit(peer, 1.0, legs, noise)
    for choice in (None, *CHOICES[peer]):
        scores = np.zeros(3)
        for out in folds:
            kept_in, held = (Legs(*(column[which] for column in legs)) for which in (~out, out))
            found = _fit(peer, choice, kept_in, noise)(held) if choice else 0.0
            scores += np.sum((held.left - found) ** 2, axis=0)
        for axis in range(3):
            if scores[axis] < best[0][axis]:
                best[0][axis], best[1][axis] = scores[axis], choice
    fits = {choice: _fit(peer, choice, legs, noise) for choice in set(best[1]) if choice}

    def foretold(other: Legs) -> Floats:
        each = {choice: fit(other) for choice, fit in fits.items()}
        none = np.zeros(len(other.run))
        return np.column_stack([each[c][:, axis] if c else none for axis, c in enumerate(best[1])])

    return foretold


def _fit(peer: str, choice: float, legs: Legs, noise: Floats) -> Learnt:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return {"sindy": _sindy, "omp": _omp, "boosting": _boosting, "gp": _gp}[peer](
            choice, legs, noise
        )


def _sindy(threshold: float, legs: Legs, noise: Floats) -> Learnt:
    from pysindy import STLSQ

    size = _sizes(legs.products)
    fits = []
    for axis in range(3):
        fit = STLSQ(threshold=threshold * noise[axis], alpha=RIDGE * len(legs.run), unbias=False)
        fits.append(fit.fit(legs.products / size, legs.left[:, axis : axis + 1]))
    return lambda other: np.column_stack(
        [np.ravel(fit.predict(other.products / size)) for fit in fits]
    )


def _omp(terms: float, legs: Legs, noise: Floats) -> Learnt:
    from sklearn.linear_model import OrthogonalMatchingPursuit

    size = _sizes(legs.products)
    fit = OrthogonalMatchingPursuit(n_nonzero_coefs=min(int(terms), size.size), fit_intercept=False)
    fit.fit(legs.products / size, legs.left / noise)
    return lambda other: np.asarray(fit.predict(other.products / size)) * noise


def _boosting(trees: float, legs: Legs, noise: Floats) -> Learnt:
    from sklearn.ensemble import HistGradientBoostingRegressor

    fits = [
        HistGradientBoostingRegressor(
            learning_rate=0.06, max_iter=int(trees), max_leaf_nodes=12, random_state=0
        ).fit(legs.plain, legs.left[:, axis])
        for axis in range(3)
    ]
    return lambda other: np.column_stack([fit.predict(other.plain) for fit in fits])


def _gp(_: float, legs: Legs, noise: Floats) -> Learnt:
    from sklearn.gaussian_process import GaussianProcessRegressor
    from sklearn.gaussian_process.kernels import RBF, ConstantKernel, WhiteKernel

    middle = legs.plain.mean(axis=0)
    size = _sizes(legs.plain - middle)
    inputs, count = (legs.plain - middle) / size, len(legs.run)
    order = np.random.default_rng(0).permutation(count)
    few, many = order[: POINTS["lengths"]], order[: POINTS["all"]]
    fits = []
    for axis in range(3):
        told = legs.left[:, axis] / noise[axis]
        start = ConstantKernel(1.0) * RBF(np.full(inputs.shape[1], 3.0), (0.1, 1e3)) + WhiteKernel(
            1.0, (1e-2, 1e2)
        )
        lengths = GaussianProcessRegressor(start, normalize_y=False).fit(inputs[few], told[few])
        fit = GaussianProcessRegressor(lengths.kernel_, optimizer=None)
        fits.append(fit.fit(inputs[many], told[many]))
    return lambda other: (
        np.column_stack([fit.predict((other.plain - middle) / size) for fit in fits]) * noise
    )


def _sizes(columns: Floats) -> Floats:
    size = np.sqrt(np.mean(columns**2, axis=0))
    return np.where(size > 0.0, size, 1.0)
