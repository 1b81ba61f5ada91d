# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Effect of the terms of a law on the innovations: sums over each leg's steps, whitened.

For each amount only the Gram matrix of the terms and their products with the innovations are kept.
A regression needs no more, and they take little memory.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from werrimbi_odom.inference.diagnosis.evidence import BATCH, summed_over_legs
from werrimbi_odom.inference.diagnosis.step_jacobians import Amount, step_jacobians
from werrimbi_odom.inference.drafting.terms import Term
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import FreeParameter
from werrimbi_odom.inference.fitting.prediction import path_of, predict_all
from werrimbi_odom.inference.fitting.score_tests import residual_innovations
from werrimbi_odom.inference.fitting.whitened_innovations import Point, unexpected
from werrimbi_odom.inference.linear import DETERMINED, SILENT
from werrimbi_odom.model.pose import Floats


class Sums(NamedTuple):
    """Products of the terms of an amount that the data determine."""

    terms: tuple[Term, ...]
    square: Floats
    """Gram matrix of the terms, (k, k): columns of unit length, with the nuisances projected
    out."""
    cross: Floats
    """Products with the projected innovations, (k,)."""
    size: Floats
    """Lengths of the columns, (k,): the coefficient of a term is that of its unit column divided by
    this."""


def sums_of(
    runs: Concatenated,
    point: Point,
    numbers: Sequence[FreeParameter],
    amount: Amount,
    terms: Sequence[Term],
) -> Sums:
    """Sum the errors of all terms along the path, and whiten them.

    `numbers`: nuisance parameters: what they can explain is no evidence.
    """
    prediction = predict_all(point.model, runs)
    frame, rest = residual_innovations(runs, point, numbers, prediction)
    of_left, of_right = step_jacobians(runs, path_of(point.model, runs), [amount], point)
    told = unexpected(runs, point, prediction)
    columns = np.empty((rest.size, len(terms)))
    each = max(1, BATCH // max(runs.run_of_step.size, 1))
    for begin in range(0, len(terms), each):
        some = terms[begin : begin + each]
        change = summed_over_legs(runs, _values(some, 0), of_left)
        if amount.of_wheels:
            change += summed_over_legs(runs, _values(some, 1), of_right)
        marks = told.marks(change)[..., : len(some)]
        columns[:, begin : begin + len(some)] = marks.reshape(rest.size, len(some))
    size = np.sqrt(np.sum(columns**2, axis=0))
    unit = columns / np.where(size > SILENT, size, 1.0)
    explained = frame.basis.T @ unit
    square = unit.T @ unit - explained.T @ explained
    determined = (size > SILENT) & (np.diag(square) > DETERMINED**2)
    kept: list[int] = np.flatnonzero(determined).tolist()
    return Sums(
        tuple(terms[index] for index in kept),
        square[np.ix_(kept, kept)],
        (unit.T @ rest)[kept],
        size[kept],
    )


def _values(terms: Sequence[Term], side: int) -> Floats:
    return np.stack([term.values(side) for term in terms], axis=-1)
