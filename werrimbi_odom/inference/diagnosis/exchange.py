# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Exchange of an effect found early for one that does better beside those found after it.

Forward selection alone keeps what it took first (Miller, "Subset selection in regression", 2002,
section 3.5): of a wheel that is oval and off its centre, a bump on its tread explains the most by
itself, and beside the oval that is found next an eccentric axle does better.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.forward_selection import (
    Round,
    best_of_each,
    refit_to_rest,
)
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted, fitted
from werrimbi_odom.inference.fitting.candidate import names_with
from werrimbi_odom.inference.fitting.candidate_starts import started_with
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import CALIBRATION
from werrimbi_odom.inference.fitting.score_tests import candidates, parameters_with, scores
from werrimbi_odom.model.effect import Effect, applied_of
from werrimbi_odom.model.robot import Robot


def exchanged(
    runs: Concatenated, fit: Fitted, rounds: Sequence[Round], given: Robot
) -> tuple[Fitted, list[Round]]:
    """The model with one earlier effect exchanged for another of its round, and the rounds of that.

    Unchanged, unless the other is better by more than rivals differ. What had to go is no rival of
    what took its place.
    """
    better = [
        (other, at)
        for at, name in enumerate(fit.names[:-1])
        for start in _nearly_as_good(name, rounds[at])
        for other in _with_the_later_ones(runs, start, fit, fit.names[at + 1 :], given)
        if other.total < fit.total - rules.RIVAL * fit.scatter
    ]
    if not better:
        return fit, list(rounds)
    best, at = min(better, key=lambda each: each[0].total)
    kept = tuple(each for each in rounds[at].tried if each.names[-1] != fit.names[at])
    before, after = rounds[:at], rounds[at + 1 :]
    return refit_to_rest(runs, best, given), [*before, replace(rounds[at], tried=kept), *after]


def _nearly_as_good(name: str, this: Round) -> list[Fitted]:
    """Fits of a round that explained a good part of what the effect did that was taken."""
    fits = [each for each in this.tried if not each.at_bound]
    taken = next((each.total for each in fits if each.names[-1] == name), this.before.total)
    least = this.before.total - rules.EXCHANGED * (this.before.total - taken)
    return [each for each in fits if each.names[-1] != name and each.total < least]


def _with_the_later_ones(
    runs: Concatenated, start: Fitted, fit: Fitted, later: Sequence[str], given: Robot
) -> Iterator[Fitted]:
    """The start with the effects that were found after its round, one after the other; or none."""
    found: Fitted | None = start
    for name in later:
        if found is None or start.names[-1] in later:
            return
        effect = applied_of(fit.point.model.robot.effects, name).effect
        found = _beside(runs, found, effect, given)
    if found is not None:
        yield found


def _beside(runs: Concatenated, before: Fitted, effect: Effect, given: Robot) -> Fitted | None:
    """Fit with one more effect, from its best score; None if it is not determined."""
    point = before.point
    held = [applied.name for applied in point.model.robot.effects]
    tried = candidates([effect], held, runs.channels, len(runs.runs))
    for score in best_of_each(scores(runs, point, (*CALIBRATION, *before.numbers), tried)):
        start, candidate = started_with(runs, point, score), score.candidate
        names = names_with(before.names, candidate)
        found = fitted(runs, start, names, parameters_with(before.numbers, candidate), given)
        return found if found.determined and not found.at_bound else None
    return None
