# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Sparse regression: select a few terms out of many, with a penalty that allows for the search.

The effect of a term on the innovations is summed over each leg's steps and whitened. Of all terms
of an amount only the Gram matrix and the products with the innovations are kept.

Forward selection by orthogonal least squares: each round adds the term that lowers the squared
innovations most beside the terms already selected (Chen, Billings and Luo, Int. J. Control 50,
1989). It starts with each of the best terms in turn, since the best single term may not be in the
best pair. Among k terms the best null term gains about 2 ln k, so each term must gain that much in
addition to the usual penalty (risk inflation criterion: Foster and George, Ann. Stat. 22, 1994).
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from typing import NamedTuple

import numpy as np

from werrimbi_odom.inference import rules
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
        values = np.stack([term.values(0) for term in some], axis=-1)
        change = summed_over_legs(runs, values, of_left)
        if amount.of_wheels:
            values = np.stack([term.values(1) for term in some], axis=-1)
            change += summed_over_legs(runs, values, of_right)
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


class Selected(NamedTuple):
    """A selected set of terms."""

    terms: tuple[int, ...]
    coefficients: Floats
    """Coefficients of their columns."""
    gain: float
    """Fall of the squared innovations."""

    def worth(self, penalty: float) -> float:
        """Gain less the penalty."""
        return self.gain - penalty * len(self.terms)


def selections(
    square: Floats,
    cross: Floats,
    penalty: float,
    may_join: Callable[[Collection[int], int], bool] = lambda chosen, one: True,
) -> list[Selected]:
    """The best small sets of terms, one for each starting term; the best first.

    `square` (k, k): Gram matrix of the terms' columns, which had unit length before nuisances were
    projected out. `cross` (k,): products of the columns with the response. `penalty`: penalty of a
    term. `may_join`: whether a term may join a set of selected terms.
    """
    alone = cross**2 / np.diag(square)
    found: dict[tuple[int, ...], Selected] = {}
    for first in np.argsort(-alone)[: rules.FIRST_TERMS].tolist():
        chosen = [first]
        while len(chosen) < rules.MOST_TERMS:
            more = _gains(square, cross, chosen)
            joins = [may_join(chosen, one) for one in range(cross.size)]
            more[~np.array(joins)] = 0.0
            if more.max(initial=0.0) <= penalty:
                break
            chosen.append(int(np.argmax(more)))
        kept = _thinned(square, cross, chosen, penalty)
        found.setdefault(kept.terms, kept)
    return sorted(found.values(), key=lambda each: -each.worth(penalty))


def _gains(square: Floats, cross: Floats, chosen: list[int]) -> Floats:
    """Fall of the squared innovations for each further term."""
    solved = np.linalg.solve(
        square[np.ix_(chosen, chosen)], np.column_stack([square[chosen], cross[chosen]])
    )
    left = np.diag(square) - np.sum(square[chosen] * solved[:, :-1], axis=0)
    toward = cross - square[:, chosen] @ solved[:, -1]
    told = left > DETERMINED
    return np.where(told, toward**2 / np.where(told, left, 1.0), 0.0)


def _thinned(square: Floats, cross: Floats, chosen: list[int], penalty: float) -> Selected:
    """Backward elimination: drop terms that later ones made needless."""
    best = _solved(square, cross, chosen)
    for one in chosen:
        others = [other for other in best.terms if other != one]
        if others and one in best.terms:
            without = _solved(square, cross, others)
            best = max(without, best, key=lambda each: each.worth(penalty))
    return best


def _solved(square: Floats, cross: Floats, chosen: list[int]) -> Selected:
    terms = sorted(chosen)
    solution = np.linalg.solve(square[np.ix_(terms, terms)], cross[terms])
    return Selected(tuple(terms), np.asarray(-solution), float(cross[terms] @ solution))
