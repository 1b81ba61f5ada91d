# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Which physical effect is missing: the set-up search first, then forward selection of effects.

Each round scores all effects of the library and all cells of the evidence map at once. If a plain
dependence on a measured variable explains far more than any effect can, the library does not hold
the missing effect, and none is named. Otherwise the best few effects are fitted in full. The best
of them is accepted if its gain exceeds its penalty on the fitted drives, and in cross-validation.
Held-out drives have no part in this: they are for reporting only.

An abrupt error that the final model does not explain is an event. Events without a common cause are
left out, and the whole search is repeated without them. If a wandering reference explains what is
left where independent poses were assumed, all is repeated with such a reference. If one wheel took
what is left, or events come with the driving, something is missing (`no_noise`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from werrimbi_odom.errors import TooFewLegsError
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.calibration_parametrisation import robot_for_cutting
from werrimbi_odom.inference.comparison.prepared_runs import for_fit
from werrimbi_odom.inference.diagnosis.ahead_or_behind import ahead_or_behind
from werrimbi_odom.inference.diagnosis.cross_validation import holds_when_cross_validated
from werrimbi_odom.inference.diagnosis.effect_support import askable, support_of
from werrimbi_odom.inference.diagnosis.effects_of_robot_file import (
    needless_of_held,
    outdated,
    rivals_of_held,
)
from werrimbi_odom.inference.diagnosis.evidence import Dependence, dependences, fall_of_cost
from werrimbi_odom.inference.diagnosis.forward_selection import (
    Round,
    fit_calibration,
    refit_to_rest,
    search_round,
)
from werrimbi_odom.inference.diagnosis.holdout import Judge, begin
from werrimbi_odom.inference.diagnosis.homogeneity import homogeneity_of_effect, lasting
from werrimbi_odom.inference.diagnosis.instead_of_calibration import Instead, instead_of_calibration
from werrimbi_odom.inference.diagnosis.misfit import misfit_of_found, misfit_of_held_law
from werrimbi_odom.inference.diagnosis.no_noise import with_what_is_no_noise
from werrimbi_odom.inference.diagnosis.p_values import chance, disagreeing, p_value_by_parts
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.diagnosis.result import Diagnosis, Verdict
from werrimbi_odom.inference.diagnosis.sequential_replacement import reconsidered, rounds_of
from werrimbi_odom.inference.diagnosis.verdict import diagnosis_of
from werrimbi_odom.inference.diagnosis.wandering_reference import (
    error_may_wander,
    explains_all,
    wander_of,
    wanders_far,
)
from werrimbi_odom.inference.diagnosis.without_events import events_beside, refit_without_events
from werrimbi_odom.inference.events.events import Events
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated, concatenated
from werrimbi_odom.inference.fitting.free_parameters import CALIBRATION
from werrimbi_odom.inference.legs.cutting import with_stated_noise
from werrimbi_odom.inference.set_up.search import SetUp
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.progress import Show, silent

__all__ = ["Diagnosis", "Verdict", "diagnose"]


def diagnose(
    runs: Sequence[Run],
    robot: Robot,
    effects: Sequence[Effect],
    options: EvaluationOptions = EvaluationOptions(),
    *,
    holdout: Sequence[Run] = (),
    show: Show = silent,
) -> Diagnosis:
    """Diagnose what a model is missing.

    `runs`: recorded drives with a reference. `robot`: the model to be diagnosed. `effects`:
    candidate effects: the library and the user's own. `options`: how drives are cut into legs and
    judged. `holdout`: runs for judging only. If empty, a part of `runs` is held out. InputError
    when a run has no usable reference or no ticks, or is in degrees or millimetres; when there are
    too few legs for any verdict.
    """

    def search(
        runs: Sequence[Run], holdout: Sequence[Run], first: bool
    ) -> tuple[Diagnosis, Events]:
        shown = show if first else partial(_once_more, show)
        found, judge = _searched(runs, holdout, robot, effects, options, shown)
        if found.of_another_drive:
            return found, Events()
        found.runs.cache.forget_steps()
        show(0.95, "what happened at once")
        return found, events_beside(found.runs, found.final.point, judge)

    found, happened = refit_without_events(search, runs, holdout)
    nothing_left = found.verdict == "none" and found.misfit is None
    competing = () if nothing_left else found.remaining
    if not found.of_another_drive and error_may_wander(found.runs, found.final):
        on_map = replace(options, reference_kind="local_map")
        again = diagnose(runs, robot, effects, on_map, holdout=holdout, show=show)
        # A reference that wanders explains all that is left, and no small wander lets something be
        # named that was not; else it is the robot that errs so.
        explained = not any(cell.p_value < rules.VERY_SURE for cell in again.remaining)
        law = found.misfit is not None and found.misfit.effect is not None
        explained = explained and explains_all(
            found.runs, found.final, again.final, competing, of_a_law=law
        )
        variances = again.final.point.variances
        told = again.verdict == "none" or not nothing_left or wanders_far(variances)
        if explained and told:
            alone = again.runs.positions_alone
            return replace(again, wander=wander_of(variances, positions_alone=alone))
    return with_what_is_no_noise(found, happened)


def _once_more(show: Show, _: float, words: str) -> None:
    show(0.95, f"{words}, without what happened at once")


def _searched(
    runs: Sequence[Run],
    holdout: Sequence[Run],
    robot: Robot,
    effects: Sequence[Effect],
    options: EvaluationOptions,
    show: Show,
) -> tuple[Diagnosis, Judge]:
    """One complete search for missing effects, and the judge of its models."""
    show(0.0, "set-up")
    begun = begin(runs, holdout, robot, options)
    judge, set_up = begun.judge, begun.set_up
    cutter = robot_for_cutting(set_up.robot, robot)
    laid = concatenated(for_fit(judge.train, cutter))
    _refuse_few(laid, set_up, judge)
    effects = askable(effects, laid, set_up.robot)
    show(0.1, "calibration")
    fit = fit_calibration(laid, set_up.robot, with_stated_noise(options, laid.runs))
    rounds: list[Round] = []
    beyond = misfit = None
    for number in range(rules.ROUNDS):
        show(0.2 + 0.7 * number / rules.ROUNDS, f"effects, round {number + 1}")
        this = search_round(laid, fit, effects, set_up.robot)
        rounds.append(this)
        best, beyond = _chosen(this, laid)
        misfit = misfit_of_held_law(this, best, beyond, laid)
        if misfit is not None:
            beyond = None
            break
        further: list[Round] = []
        if best is None or beyond is not None:
            best, further = _together(this, laid, effects, set_up.robot)
            beyond = beyond if best is None else None
        if best is None or beyond is not None or not holds_when_cross_validated(laid, fit, best):
            break
        found_by = (*fit.names, *(each.before.names[-1] for each in further), best.names[-1])
        rounds = rounds_of(best.names, found_by, (*rounds, *further))
        fit = refit_to_rest(laid, best, set_up.robot)
        fit, rounds = reconsidered(laid, fit, rounds, set_up.robot)
    remaining = (
        rounds[-1].dependences
        if rounds[-1].before is fit
        else dependences(laid, fit.point, (*CALIBRATION, *fit.numbers))
    )
    show(0.92, "what would explain it as well")
    instead: tuple[Instead, ...] = ()
    if not fit.names and fit.calibrated and beyond is None:
        instead = instead_of_calibration(laid, fit, effects, set_up.robot)
    if misfit is None and beyond is None:
        certain = [cell for cell in remaining if cell.p_value < rules.VERY_SURE]
        misfit = misfit_of_found(fit, certain, laid)
    found = diagnosis_of(begun, robot, tuple(rounds), fit, beyond, remaining, laid, instead)
    misfit = misfit or found.misfit
    asked = found.verdict == "none" and misfit is None
    held = rivals_of_held(laid, fit, effects, set_up.robot) if asked else {}
    needless = needless_of_held(laid, fit, held, set_up.robot)
    old = outdated(fit, robot) if found.verdict == "none" and found.holdout.fell_much else ()
    either = ahead_or_behind(laid, fit, set_up.robot)
    found = replace(found, misfit=misfit, rivals_of_held=held, needless_of_held=needless)
    return replace(found, outdated=old, ahead_or_behind=either), judge


def _refuse_few(laid: Concatenated, set_up: SetUp, judge: Judge) -> None:
    """Raise where legs are so few that no cause but a set-up mistake could ever be significant."""
    count = int(np.count_nonzero(~laid.gap))
    if count >= rules.LEGS_OF_A_PART or set_up.findings:
        return
    legs = f"{count} leg{'' if count == 1 else 's'}"
    raise TooFewLegsError(
        f"{', '.join(str(run.path) for run in judge.fitted_on)}: too little to diagnose: from pose "
        f"to pose the drives have {legs} to fit, and {rules.LEGS_OF_A_PART} are "
        "the least. Measure the robot more often on its way, or drive more"
    )


def _significant(this: Round) -> Fitted | None:
    """The cheapest model of a round, if its likelihood ratio is significant."""
    fit = next((fit for fit in this.tried if not fit.at_bound), None)
    if fit is None:
        return None
    before = this.before.cost + this.before.needless_gain + this.before.penalty * fit.scatter
    significant = fit.total < before and chance(fit, this.before, this.number) < rules.SURE
    return fit if significant else None


def _chosen(this: Round, runs: Concatenated) -> tuple[Fitted | None, Dependence | None]:
    """The model that a round finds, or the dependence that is beyond the library, if any.

    Few parts of the drives may show an effect: of a late clock on one long circle, those with
    starts and stops. So few cannot prove it alone, even if they agree. But if a dependence lasts,
    something is missing, and the effect competes for it, if the parts speak for it at all; so do
    other dependences, which need speak no louder. What a law of the model leaves in its own
    variables is no such sign.
    """
    best = _significant(this)
    if best is not None and p_value_by_parts(runs, best, best.names[-1], this.number) < rules.SURE:
        return best, _beyond_the_library(this, best, runs)
    lasts = _beyond_the_library(this, None, runs)
    if lasts is None or best is None or disagreeing(best, best.names[-1]):
        return None, lasts
    if homogeneity_of_effect(runs, best, best.names[-1]) > rules.SURE_WHEN_ASKED:
        return None, lasts
    rest = misfit_of_held_law(this, None, lasts, runs)
    if rest is not None and rest.effect is not None:
        return None, lasts
    beyond = _beyond_the_library(this, best, runs, rules.SURE_WHEN_ASKED)
    return (best, None) if beyond is None else (None, beyond)


def _together(
    this: Round, runs: Concatenated, effects: Sequence[Effect], given: Robot
) -> tuple[Fitted | None, list[Round]]:
    """Effects that hold only beside one another, and the rounds that found them.

    Where several are missing, the parts of the drives disagree on each of them alone: what the
    others do differs from part to part. And one dependence may be the sum of what several do: a
    mount that is askew and beside the axle errs with the rate of turning as neither alone does. So
    the best is taken on trial, and the next ones too, until all of them hold and explain together
    what no single one did, or no more are significant.
    """
    first, rounds = this, list[Round]()
    fit = _significant(this)
    while fit is not None and len(rounds) < rules.TOGETHER:
        this = search_round(runs, refit_to_rest(runs, fit, given), effects, given)
        rounds.append(this)
        fit = _significant(this)
        if fit is None or _beyond_the_library(this, fit, runs) is not None:
            continue
        trial = fit.names[-len(rounds) - 1 :]
        if any(p_value_by_parts(runs, fit, name, this.number) >= rules.SURE for name in trial):
            continue
        if _beyond_the_library(first, fit, runs) is None:
            return fit, rounds
    return None, []


def _beyond_the_library(
    this: Round, best: Fitted | None, runs: Concatenated, limit: float = rules.SURE
) -> Dependence | None:
    """The dependence, if any, that explains more than a correct law could leave unexplained.

    Then no effect of the library is the missing one. The dependence competes with the best effect
    as a model of its own, by the same reduction of the cost and the same penalty for each
    parameter. `limit`: the p-value by parts of the drives below which it lasts.
    """
    score = next(
        (
            score
            for score in this.scores
            if best is not None and score.candidate.name == best.names[-1]
        ),
        None,
    )
    certain = [cell for cell in this.dependences if cell.p_value < rules.VERY_SURE]
    if score is not None and best is not None:
        support = support_of(score.candidate, runs.drive(this.before.point.model.robot))
        data, of_one, of_own = runs.data, this.before.penalty_of_one, this.before.penalty_of_own
        whole = this.before.squares
        fall = max(fall_of_cost(score.gain, data, whole), this.before.cost - best.cost)
        worth = fall - (best.penalty - this.before.penalty)

        def more_than_a_law_leaves(cell: Dependence) -> bool:
            own = cell.channel in support.outputs and bool(
                support.inputs & set(cell.variable.looks_at)
            )
            share = rules.OWN_LAW_SHARE if own else rules.LAW_SHARE
            penalty = cell.degrees * (of_own if cell.variable.per_run else of_one)
            left = share * (fall_of_cost(cell.gain, data, whole) - penalty)
            return left > worth + rules.RIVAL

        certain = [cell for cell in certain if more_than_a_law_leaves(cell)]
    numbers = (*CALIBRATION, *this.before.numbers)
    found = lasting(runs, this.before.point, numbers, certain[: rules.CELLS_ASKED])
    return next((each.cell for each in found if each.p_value < limit and not each.only_in), None)
