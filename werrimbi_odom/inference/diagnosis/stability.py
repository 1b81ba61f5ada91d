# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Stability of a verdict: whether halves of the data prefer another effect.

Innovations of a filter are independent from leg to leg, so the log-likelihood of a model is a sum
over legs, and any half of them can be evaluated by itself. Every fitted effect is compared in every
half. One that beats the chosen effect in a half by the margin for rivals is a rival.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference.diagnosis.forward_selection import Round
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.whitened_innovations import unexpected
from werrimbi_odom.inference.rules import HALF_PARTS, RIVAL
from werrimbi_odom.model.pose import Floats


def rivals_in_halves(runs: Concatenated, this: Round, best: Fitted) -> tuple[str, ...]:
    """Effects of a round that explain some half of the legs better than the overall best."""
    others = [fit for fit in this.tried if fit is not best and not fit.at_bound]
    if not others:
        return ()
    chosen = _cost_of_legs(runs, best)
    found: dict[str, None] = {}
    costs = [_cost_of_legs(runs, fit) for fit in others]
    for half in halves(runs):
        for fit, cost in zip(others, costs, strict=True):
            dearer = (best.penalty - fit.penalty) * best.scatter
            ahead = float(np.sum((chosen - cost)[half])) + 0.5 * dearer
            if ahead > RIVAL * best.scatter:
                found[fit.names[-1]] = None
    return tuple(found)


def _cost_of_legs(runs: Concatenated, fit: Fitted) -> Floats:
    return np.asarray(unexpected(runs, fit.point).cost_of_legs()[0])


def halves(runs: Concatenated) -> Iterator[NDArray[np.bool_]]:
    """Odd and even parts of every drive, and each drive's first and second half; masks (m,)."""
    first = runs.legs[runs.run_of_leg]
    count = np.diff(runs.legs)[runs.run_of_leg]
    number = np.arange(runs.count) - first
    for half in ((number * HALF_PARTS // count) % 2 == 0, 2 * number < count):
        yield half
        yield ~half
