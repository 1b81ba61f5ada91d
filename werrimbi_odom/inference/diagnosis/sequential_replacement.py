# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Effects found early are dropped, narrowed or exchanged where those found later do their part.

Forward selection alone keeps what it took first (Miller, "Subset selection in regression", 2002,
section 3.5): of a wheel that is oval and off its centre, a bump on its tread explains the most by
itself, and beside the oval that is found next an eccentric axle does better. A castor that swings
into spins looks like tyres that slip when they start to turn, and beside it these do nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from werrimbi_odom.effects.lookup import find
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.forward_selection import (
    Round,
    best_of_each,
    extension_p_value,
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


def rounds_of(names: Sequence[str], found: Sequence[str], rounds: Sequence[Round]) -> list[Round]:
    """The rounds of the effects that a model holds, in their order.

    An effect that gave way to one that extends it has none. The first round has what was before any
    effect, and stays the first.

    Parameters
    ----------
    found
        The effect that each round found.
    """
    kept = [this for this, name in zip(rounds, found, strict=True) if name in names]
    if kept and kept[0] is not rounds[0]:
        tried = [fit for fit in kept[0].tried if fit.names[-1] == names[0]]
        known = any(fit.names[-1] == names[0] for fit in rounds[0].tried)
        kept[0] = rounds[0] if known else replace(rounds[0], tried=(*tried, *rounds[0].tried))
    return kept


def reconsidered(
    runs: Concatenated, fit: Fitted, rounds: Sequence[Round], given: Robot
) -> tuple[Fitted, list[Round]]:
    """The model without an earlier effect, or with another for it, and the rounds of that.

    Unchanged where every one of them is needed, and no other does better.
    """
    for at in range(len(fit.names) - 1):
        if _needless(fit, fit.names[at]):
            less, kept = _without(runs, fit, at, rounds, given)
            if less is not None and less.total < fit.total:
                return reconsidered(runs, refit_to_rest(runs, less, given), kept, given)
    for at, name in enumerate(fit.names[:-1]):
        wider = applied_of(fit.point.model.robot.effects, name).effect
        if wider.extends and extension_p_value(fit, wider) > rules.SURE:
            less, kept = _narrowed(runs, fit, at, rounds, given)
            if less is not None:
                return reconsidered(runs, refit_to_rest(runs, less, given), kept, given)
    return _exchanged(runs, fit, rounds, given)


def _needless(fit: Fitted, name: str) -> bool:
    """Whether an effect does not pay for its parameters, by the curvature at the fit."""
    its = sum(number.name.rpartition(".")[0] == name for number in fit.numbers)
    return fit.importance[name] < its * fit.penalty_of_one


def _without(
    runs: Concatenated, fit: Fitted, at: int, rounds: Sequence[Round], given: Robot
) -> tuple[Fitted | None, list[Round]]:
    """Fit without an earlier effect, and the rounds as if it had not been found."""
    later = fit.names[at + 1 :]
    first = _with_the_later_ones(runs, rounds[at].before, fit, later[:1], given)
    if first is None:
        return None, []
    others = [each for each in rounds[at].tried if each.names[-1] not in (fit.names[at], later[0])]
    tried = tuple(sorted([first, *others], key=lambda each: each.total))
    kept = [*rounds[:at], replace(rounds[at], tried=tried), *rounds[at + 2 :]]
    return _with_the_later_ones(runs, first, fit, later[1:], given), kept


def _narrowed(
    runs: Concatenated, fit: Fitted, at: int, rounds: Sequence[Round], given: Robot
) -> tuple[Fitted | None, list[Round]]:
    """Fit with what an earlier effect extends in its place, and the rounds of that."""
    extended = find(applied_of(fit.point.model.robot.effects, fit.names[at]).effect.extends)
    first = _beside(runs, rounds[at].before, extended, given)
    if first is None:
        return None, []
    others = [each for each in rounds[at].tried if each.names[-1] != fit.names[at]]
    kept = [*rounds[:at], replace(rounds[at], tried=(first, *others)), *rounds[at + 1 :]]
    return _with_the_later_ones(runs, first, fit, fit.names[at + 1 :], given), kept


def _exchanged(
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
    later = (applied_of(fit.point.model.robot.effects, each).effect for each in fit.names[at + 1 :])
    not_it = {*fit.names[at:], *(effect.extends for effect in later)}
    return [each for each in fits if each.names[-1] not in not_it and each.total < least]


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
