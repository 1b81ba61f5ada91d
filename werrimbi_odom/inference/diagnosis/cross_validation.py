# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Cross-validation over parts of drives: the cost of a model on legs left out of its fit.

Whether an effect is accepted is decided on the fitted drives alone. The held-out drives are for
reporting only and never choose. Every drive is cut into parts, which are dealt to the folds in
turn. So each fold holds some of every drive, and the motion that excites an effect is in all of
them. The model is linearised at the fit, so leaving out a fold takes linear algebra and no new fit.

Source: Stone, "Cross-validatory choice and assessment of statistical predictions", J. R. Stat. Soc.
B 36 (1974).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS

_RANK = 1e-6


def cross_validated_cost(runs: Concatenated, fit: Fitted) -> float:
    """Minus two log-likelihood of a fitted model on legs left out of its fit, one fold at a time.

    Parameters that the other folds do not determine (the phase of a run that lies in one fold) are
    fitted to the fold itself, at a penalty of 2 each (Akaike): one for what the fit took from the
    noise, one for what it would take from new noise. The same holds for a per-run parameter, or a
    size (of a drive with one spin, the base), about which the fold has more information than all
    others together: carried over from them it would cost more than 2 by the noise alone
    (`FOLD_TELLS`). Directions that the fit did not move stay: the runs do not determine them, and
    other folds would send them anywhere.
    """
    white, flat = fit.design.flat()
    slopes = flat @ fit.moves
    rows = np.repeat(fold_of_leg(runs), 3)
    size = np.sqrt(np.sum(slopes**2, axis=0))
    scaled = slopes[:, size > 0.0] / size[size > 0.0]
    of_run = np.array([run >= 0 for _, run in fit.design.columns])
    of_size = np.array([number.name in MULTIPLIERS for number, _ in fit.design.columns])
    in_run, in_size, elsewhere = (
        np.any(fit.moves[columns], axis=0) for columns in (of_run, of_size, ~(of_run | of_size))
    )
    of_fold = (in_run | (in_size & ~elsewhere))[size > 0.0]
    change = 0.0
    for fold in range(rules.FOLDS):
        here = rows == fold
        if not here.any():
            continue
        learnt, seen = scaled[~here], scaled[here]
        told = np.sum(learnt**2, axis=0)
        here_alone = (told <= _RANK**2) | (of_fold & (told < 1.0 - rules.FOLD_TELLS))
        step = np.linalg.lstsq(learnt, -white[~here], rcond=_RANK)[0]
        left = white[here] + seen[:, ~here_alone] @ step[~here_alone]
        own = seen[:, here_alone]
        if own.shape[1]:
            taken = np.linalg.lstsq(own, -left, rcond=_RANK)
            left = left + own @ taken[0]
            change += rules.USELESS_NUMBER * float(taken[2])
        change += float(left @ left - white[here] @ white[here])
    return fit.cost + change


def fold_of_leg(runs: Concatenated) -> NDArray[np.intp]:
    """Fold of each leg, (m,): the parts of every run, dealt in turn."""
    first = runs.legs[runs.run_of_leg]
    count = np.diff(runs.legs)[runs.run_of_leg]
    part = (np.arange(runs.count) - first) * rules.FOLDS * rules.FOLD_PARTS // count
    return np.asarray((part + runs.run_of_leg) % rules.FOLDS, dtype=np.intp)


def holds_when_cross_validated(runs: Concatenated, before: Fitted, after: Fitted) -> bool:
    """Whether the cross-validated likelihood is higher for `after` than for `before`."""
    return cross_validated_cost(runs, after) < cross_validated_cost(runs, before)
