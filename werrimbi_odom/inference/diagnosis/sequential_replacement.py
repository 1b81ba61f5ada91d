# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Exchange of an effect found early for one that does better beside those found after it.

Forward selection alone keeps what it took first (Miller, "Subset selection in regression", 2002,
section 3.5): of a wheel that is oval and off its centre, a bump on its tread explains the most by
itself, and beside the oval that is found next an eccentric axle does better.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.forward_selection import (
    Round,
    best_of_each,
    fitted_beside,
    refit_to_rest,
)
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.fitting.candidate_starts import started_with
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import CALIBRATION
from werrimbi_odom.inference.fitting.score_tests import candidates, scores
from werrimbi_odom.model.effect import Effect, applied_of
from werrimbi_odom.model.robot import Robot


def exchanged(
    runs: Concatenated, fit: Fitted, rounds: Sequence[Round], given: Robot
) -> tuple[Fitted, list[Round]]:
    """The model with one earlier effect exchanged for another of its round, and the rounds of that.

    Unchanged, unless the other is better by more than rivals differ. What had to go is no rival of
    what took its place.
    """
    tried = [
        (_with_the_later_ones(runs, start, fit, fit.names[at + 1 :], given), at)
        for at in range(len(fit.names) - 1)
        for start in _nearly_as_good(fit, at, rounds[at])
    ]
    limit = fit.total - rules.RIVAL * fit.scatter
    better = [(other, at) for other, at in tried if other is not None and other.total < limit]
    if not better:
        return fit, list(rounds)
    best, at = min(better, key=lambda each: each[0].total)
    kept = tuple(each for each in rounds[at].tried if each.names[-1] != fit.names[at])
    before, after = rounds[:at], rounds[at + 1 :]
    return refit_to_rest(runs, best, given), [*before, replace(rounds[at], tried=kept), *after]


def _nearly_as_good(fit: Fitted, at: int, this: Round) -> list[Fitted]:
    """Fits of a round with what was not found, that explained a good part of what was taken did."""
    fits = [each for each in this.tried if not each.at_bound]
    name = fit.names[at]
    taken = next((each.total for each in fits if each.names[-1] == name), this.before.total)
    least = this.before.total - rules.EXCHANGED * (this.before.total - taken)
    found = fit.names[at:]
    return [each for each in fits if each.names[-1] not in found and each.total < least]


def _with_the_later_ones(
    runs: Concatenated, start: Fitted, fit: Fitted, later: Sequence[str], given: Robot
) -> Fitted | None:
    """The start with the effects that were found after its round, one after the other."""
    found: Fitted | None = start
    for name in later:
        if found is not None:
            effect = applied_of(fit.point.model.robot.effects, name).effect
            found = _beside(runs, found, effect, given)
    return found


def _beside(runs: Concatenated, before: Fitted, effect: Effect, given: Robot) -> Fitted | None:
    """Fit with one more effect, from its best score; None if it is not determined."""
    point = before.point
    held = [applied.name for applied in point.model.robot.effects]
    tried = candidates([effect], held, runs.channels, len(runs.runs))
    found = best_of_each(scores(runs, point, (*CALIBRATION, *before.numbers), tried))
    if not found:
        return None
    (score,) = found
    fit = fitted_beside(runs, before, started_with(runs, point, score), score, given)
    return fit if fit.determined and not fit.at_bound else None
