# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What terms of a law would do to the innovations: their sums over each leg's steps, whitened.

Of all terms of an amount only the products with each other and with what is left of the innovations
are kept; a regression needs no more, and they take no memory.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from werrimbi_odom.inference.diagnosis.evidence import BATCH, Amount, legs_pushed, pushes_of
from werrimbi_odom.inference.drafting.terms import Term
from werrimbi_odom.inference.fitting.candidates import unexplained
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.design import Point, unexpected
from werrimbi_odom.inference.fitting.free_parameters import FreeParameter
from werrimbi_odom.inference.fitting.prediction import path_of, predict_all
from werrimbi_odom.inference.linear import DETERMINED, SILENT
from werrimbi_odom.model.pose import Floats


class Sums(NamedTuple):
    """Products of the terms of an amount that the drives tell anything of."""

    terms: tuple[Term, ...]
    square: Floats
    """With each other, less what the model can turn, (k, k); of columns brought to unit length."""
    cross: Floats
    """With what is left of the innovations, (k,)."""
    size: Floats
    """Lengths of the columns, (k,): a coefficient of a term is that of its column over it."""


def sums_of(
    runs: Concatenated,
    point: Point,
    numbers: Sequence[FreeParameter],
    amount: Amount,
    terms: Sequence[Term],
) -> Sums:
    """Sum the pushes of all terms along the path, and whiten them.

    Parameters
    ----------
    numbers
        What the model can turn: what they can explain is no evidence.
    """
    prediction = predict_all(point.model, runs)
    frame, rest = unexplained(runs, point, numbers, prediction)
    of_left, of_right = pushes_of(runs, path_of(point.model, runs), [amount], point)
    told = unexpected(runs, point, prediction)
    columns = np.empty((rest.size, len(terms)))
    each = max(1, BATCH // max(runs.run_of_step.size, 1))
    for begin in range(0, len(terms), each):
        some = terms[begin : begin + each]
        change = legs_pushed(runs, _values(some, 0), of_left)
        if amount.of_wheels:
            change += legs_pushed(runs, _values(some, 1), of_right)
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
