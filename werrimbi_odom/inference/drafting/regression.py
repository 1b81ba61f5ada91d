# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Sparse regression: few terms out of many, each of which earns a price that counts them all.

Forward selection by orthogonal least squares: in each round the term that lowers the squared
innovations most beside those that are there (Chen, Billings and Luo, Int. J. Control 50, 1989). It
begins with each of the best terms in turn, since the one that is best alone may be none of a pair.
Among k terms the best useless one gains about 2 ln k, so that is what each must be worth beside
what any number costs (risk inflation: Foster and George, Ann. Stat. 22, 1994).
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import NamedTuple

import numpy as np

from werrimbi_odom.inference.linear import DETERMINED
from werrimbi_odom.inference.rules import FIRST_TERMS, MOST_TERMS
from werrimbi_odom.model.pose import Floats


class Selected(NamedTuple):
    """Terms that were taken."""

    terms: tuple[int, ...]
    coefficients: Floats
    """Of their columns."""
    gain: float
    """Fall of the squared innovations."""

    def worth(self, price: float) -> float:
        """Its gain less its price."""
        return self.gain - price * len(self.terms)


def selections(
    square: Floats,
    cross: Floats,
    price: float,
    may_join: Callable[[Collection[int], int], bool] = lambda chosen, one: True,
) -> list[Selected]:
    """The best small sets of terms, one for each of the first terms; the best first.

    Parameters
    ----------
    square : ndarray, shape (k, k)
        Products of the terms' columns with each other; the columns were of unit length.
    cross : ndarray, shape (k,)
        With what is to be explained.
    price : float
        What each term must gain.
    may_join
        Whether a term may join those that are chosen.
    """
    alone = cross**2 / np.diag(square)
    found: dict[tuple[int, ...], Selected] = {}
    for first in np.argsort(-alone)[:FIRST_TERMS].tolist():
        chosen = [first]
        while len(chosen) < MOST_TERMS:
            more = _gains(square, cross, chosen)
            joins = [may_join(chosen, one) for one in range(cross.size)]
            more[~np.array(joins)] = 0.0
            if more.max(initial=0.0) <= price:
                break
            chosen.append(int(np.argmax(more)))
        kept = _thinned(square, cross, chosen, price)
        found.setdefault(kept.terms, kept)
    return sorted(found.values(), key=lambda each: -each.worth(price))


def _gains(square: Floats, cross: Floats, chosen: list[int]) -> Floats:
    """By how much each further term would lower the squared innovations."""
    solved = np.linalg.solve(
        square[np.ix_(chosen, chosen)], np.column_stack([square[chosen], cross[chosen]])
    )
    left = np.diag(square) - np.sum(square[chosen] * solved[:, :-1], axis=0)
    toward = cross - square[:, chosen] @ solved[:, -1]
    told = left > DETERMINED
    return np.where(told, toward**2 / np.where(told, left, 1.0), 0.0)


def _thinned(square: Floats, cross: Floats, chosen: list[int], price: float) -> Selected:
    """Without terms that others made needless after they had been taken."""
    best = _solved(square, cross, chosen)
    for one in chosen:
        others = [other for other in best.terms if other != one]
        if others and one in best.terms:
            without = _solved(square, cross, others)
            best = max(without, best, key=lambda each: each.worth(price))
    return best


def _solved(square: Floats, cross: Floats, chosen: list[int]) -> Selected:
    terms = sorted(chosen)
    solution = np.linalg.solve(square[np.ix_(terms, terms)], cross[terms])
    return Selected(tuple(terms), np.asarray(-solution), float(cross[terms] @ solution))
