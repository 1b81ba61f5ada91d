# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The verdict: what was found, and what cannot be told apart."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import NamedTuple

from werrimbi_odom.files.tables.compared_ways import ways_of_one_scale
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.calibration_parametrisation import name_of_base
from werrimbi_odom.inference.comparison.another_drive import (
    of_another_drive,
    turns_alike,
    unturned,
)
from werrimbi_odom.inference.comparison.judged_legs import far_above_noise
from werrimbi_odom.inference.comparison.prepared_runs import PreparedRuns
from werrimbi_odom.inference.comparison.reference_checks import remarks_on
from werrimbi_odom.inference.comparison.reference_remark import ReferenceRemark
from werrimbi_odom.inference.diagnosis.calibration_selection import sizes_needed
from werrimbi_odom.inference.diagnosis.evidence import Dependence
from werrimbi_odom.inference.diagnosis.forward_selection import Round
from werrimbi_odom.inference.diagnosis.holdout import Begun
from werrimbi_odom.inference.diagnosis.instead_of_calibration import Instead
from werrimbi_odom.inference.diagnosis.misfit import Misfit
from werrimbi_odom.inference.diagnosis.p_values import deviations_from, p_value_of_size
from werrimbi_odom.inference.diagnosis.paired_comparison import Sides
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.diagnosis.ranking import ranking_of
from werrimbi_odom.inference.diagnosis.result import Diagnosis, Verdict
from werrimbi_odom.inference.diagnosis.rivals import (
    own_scale_instead,
    possible_twins,
    rivals_of,
    rivals_of_others,
    torn_by_halves,
)
from werrimbi_odom.inference.diagnosis.told_sizes import (
    as_told,
    doubted_effects,
    goes_without,
    plain,
)
from werrimbi_odom.inference.diagnosis.what_is_left import what_is_left
from werrimbi_odom.inference.distributions import bonferroni
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import Model
from werrimbi_odom.model.robot import Robot


class _Answer(NamedTuple):
    """What is named; fields as in `Diagnosis`."""

    verdict: Verdict
    found: tuple[str, ...] = ()
    rivals: tuple[str, ...] = ()
    torn: tuple[str, ...] = ()


def diagnosis_of(
    begun: Begun,
    given: Robot,
    rounds: tuple[Round, ...],
    final: Fitted,
    beyond: Dependence | None,
    remaining: tuple[Dependence, ...],
    laid: Concatenated,
    instead: tuple[Instead, ...],
) -> Diagnosis:
    """Combine all results into the diagnosis.

    `final`: the last accepted fit. `beyond`: the dependence that no effect of the library explains.
    `remaining`: evidence map of `final`. `instead`: effects in place of the calibration, where no
    effect was found.
    """
    judge, mended = begun.judge, begun.set_up.robot
    mistakes = tuple(finding.effect for finding in begun.set_up.findings)
    # What an effect that was found has anew in each drive is no mistake.
    begun = replace(begun, set_up=begun.set_up.beside(final.point.model.robot.effects))
    as_given = Model(given, judge.nothing_of_own)
    another = all(
        of_another_drive(judge.train, model)
        for model in (plain(final, mended), as_given)  # a fit of few poses may be far off
    )
    answered = partial(_answer, begun, given, rounds, final, beyond, laid, instead)
    answer = _Answer("unknown") if another else answered()
    before = judge.of(as_given)
    told = as_told(final, mended, answer.found, laid, rounds)

    def unsure_of() -> list[str]:
        return doubted_effects(told, given, [each for each in answer.found if each not in mistakes])

    doubted: tuple[str, ...] = ()
    unsure = unsure_of()
    while unsure:
        fewer = (*doubted, unsure.pop(0))
        shorter = answered(fewer)
        without = as_told(final, mended, shorter.found, laid, rounds)
        if goes_without(without, mended, fewer[-1]):
            answer, told, doubted = shorter, without, fewer
            unsure = unsure_of()
    after = judge.of(told.point.model)
    of_set_up = judge.of(Model(mended, judge.nothing_of_own)) if mistakes else before
    further = any(name not in mistakes for name in answer.found)
    fell = of_set_up.to(after).fell and after.quiet[0] < of_set_up.quiet[0]
    if further and not fell and far_above_noise(judge.train, told.point.model):
        # It suits a part of the drives alone, and what is left there is no noise.
        answer = answer._replace(found=mistakes) if mistakes else _Answer("unknown")
        at = rounds[0].before if mistakes else final
        told = as_told(at, mended, answer.found, laid, rounds)
        after = judge.of(told.point.model)
    by_noise = judge.by_the_wander_of(told.point.model) if answer.found else judge
    promising = after if by_noise is judge else by_noise.of(told.point.model)
    # What is beyond the library stands beside what was found, and `add` will say it too.
    beside = beyond if answer.verdict in ("named", "ambiguous") else None
    return Diagnosis(
        verdict=answer.verdict,
        misfit=None if beside is None else Misfit(None, beside, None),
        effect=answer.found[0] if answer.found else None,
        found=answer.found,
        ranking=tuple(
            ranking_of(answer.found, begun.set_up, rounds, final, judge, before, laid, given, told)
        ),
        rivals=answer.rivals,
        torn=answer.torn,
        set_up=begun.set_up,
        otherwise=begun.otherwise,
        depends_on=() if another else rounds[0].dependences,
        remaining=() if another else remaining,
        given=given,
        rounds=rounds,
        final=final,
        told=told,
        runs=laid,
        train=Sides(before.train, after.train, before.unit),
        holdout=before.to(after),
        headings=(
            Sides(before.yaw[0], after.yaw[0], "rad"),
            Sides(before.yaw[1], after.yaw[1], "rad"),
        ),
        quiet=(
            Sides(before.quiet[0], after.quiet[0], before.unit),
            Sides(before.quiet[1], after.quiet[1], before.unit),
        ),
        left=None
        if another
        else what_is_left(
            (judge.train, after.fitted_legs, promising.fitted_legs),
            (judge.holdout, after.legs, promising.legs),
            after.unit,
            laid,
            final.point,
        ),
        rivals_of_others=rivals_of_others(answer.found, answer.rivals, rounds, final, given, laid),
        left_out=judge.left_out,
        remarks=(_nothing_in_common(judge.train, as_given),)
        if another
        else remarks_on(judge.train),
    )


def _answer(
    begun: Begun,
    given: Robot,
    rounds: tuple[Round, ...],
    final: Fitted,
    beyond: Dependence | None,
    laid: Concatenated,
    instead: tuple[Instead, ...],
    doubted: tuple[str, ...] = (),
) -> _Answer:
    """What the fitted drives say: set-up mistakes first, then effects and sizes by importance.

    `doubted`: names of sizes that are within what is stated as their uncertainty.
    """
    set_up = begun.set_up
    mistakes = [finding.effect for finding in set_up.findings]
    sizes = [
        name
        for name in final.calibrated
        if _is_news(name, final, rounds[0].number, given, set_up.robot)
    ]
    if not final.design.sized and set(_OF_ONE_WHEEL) <= set(sizes):
        sizes = _without_needless_base(sizes, final, set_up.robot)
    effects = sorted([*final.names, *sizes], key=lambda name: -final.importance[name])
    names = {"track_width": name_of_base(final.point.model.robot)}
    told = [names.get(name, name) for name in effects]
    found = tuple(dict.fromkeys([*mistakes, *(name for name in told if name not in doubted)]))
    if not found:
        wrong = beyond is not None or far_above_noise(begun.judge.train, plain(final, set_up.robot))
        return _Answer("unknown" if wrong else "none")
    if beyond is not None and not mistakes and len(rounds) == 1:
        return _Answer("unknown")
    rivals: tuple[str, ...] = ()
    torn: tuple[str, ...] = ()
    if mistakes:
        twins = possible_twins(set_up.findings[0])
        rivals = (mistakes[0], *twins) if twins else ()
    else:
        rivals = rivals_of(found[0], rounds, final, instead)
        torn = torn_by_halves(found[0], rounds, final, laid)
        others = (*torn, *own_scale_instead(found[0], final, given, laid))
        rivals = tuple(dict.fromkeys((*(rivals or (found[0],)), *others))) if others else rivals
    return _Answer("ambiguous" if len(rivals) > 1 else "named", found, rivals, torn)


def _nothing_in_common(train: PreparedRuns, given: Model) -> ReferenceRemark:
    """What a reference has in common with the wheels at most: its turns, its way, or neither."""
    if turns_alike(train, given):
        return ReferenceRemark("places", 0.0)
    if (turns := unturned(train, given)) is not None:
        return ReferenceRemark("no_turn", *turns)
    ways = [ways_of_one_scale(run, given.robot) for run in train.runs]
    if alike := [each for each in ways if each is not None]:
        rolled, seen = (sum(each) for each in zip(*alike, strict=True))
        if max(rolled, seen) > rules.ORDINARY * min(rolled, seen):
            return ReferenceRemark("scale", seen, rolled)
    return ReferenceRemark("another_drive", 0.0)


def _is_news(name: str, final: Fitted, tried: int, given: Robot, start: Robot) -> bool:
    """Whether a size is a finding: significant, with a gain well above its penalty."""
    worth = final.importance[name]
    certain = bonferroni(tried, p_value_of_size(final, name, given, start)) < rules.SURE
    differs = deviations_from(given, final, name) > rules.SIGNIFICANT
    return certain and differs and worth > rules.CALIBRATION_WORTH * final.penalty_of_one


_OF_ONE_WHEEL = ("track_width", "unequal_wheel_radii")
"""What is seen of one wheel that is larger where no length is measured: both, for each wheel is
known over the base."""


def _without_needless_base(sizes: list[str], final: Fitted, given: Robot) -> list[str]:
    """Without the base, if one wheel alone is the simpler cause of its ratio to both wheels."""
    base, ratio = _OF_ONE_WHEEL
    alone = sizes_needed(final, given, (ratio,)).parts in (("", "left"), ("", "right"))
    return [name for name in sizes if name != base or not alone]
