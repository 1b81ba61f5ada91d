# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Changes between the drives of one diagnosis, beside everything that it found.

A change is reported if it passes four tests: the drives need it (`change_points`); the parts of the
drives before it agree with each other, as do those after it (`homogeneity`); no other effect
explains as much; and it remains significant beside other dependences of the errors. Held-out drives
have no part in it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.run import ReferenceKind
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.changes.change_evidence import Evidence, evidence_of
from werrimbi_odom.inference.changes.change_points import (
    ChangePoints,
    GroupChange,
    find_changes,
    only_these,
)
from werrimbi_odom.inference.changes.parameter_groups import DELAY, PARTS, groups_of, tell_the_scale
from werrimbi_odom.inference.changes.shapes import Kind, Shape
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.diagnosis.evidence import Dependence
from werrimbi_odom.inference.diagnosis.homogeneity import lasting_columns, pattern_of
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import CALIBRATION, MULTIPLIERS, FreeParameter
from werrimbi_odom.inference.fitting.score_tests import Score, candidates, scores
from werrimbi_odom.inference.linear import nuisance, score_test
from werrimbi_odom.inference.set_up.misentered_values import is_ordinary
from werrimbi_odom.model.effect import Effect, extended_by


@dataclass(frozen=True, slots=True)
class ParameterChange:
    """A parameter that changes at a drive, or differs in one drive alone."""

    what: str
    """Name of the parameter: a multiplier, or effect.parameter."""
    group: str
    """The group that changed, see `Group.what`."""
    kind: Kind
    last_before: str
    """The last drive that was surely before the change."""
    from_run: str
    """The likeliest drive at which it begins."""
    surely_from: str
    """The first drive that is surely after it."""
    before: float
    after: float
    before_std: float
    after_std: float
    unit: str
    p_value: float


def changes_between(diagnosis: Diagnosis, effects: Sequence[Effect]) -> tuple[ParameterChange, ...]:
    """Changes between the fitted drives, in the order in which they were driven.

    First with everything found in the model. If that leaves no change, with calibration alone: a
    change that explains more than any effect does is not caused by one.
    """
    runs, final = diagnosis.runs, diagnosis.final
    if len(runs.runs) < 2:
        return ()
    found = _beside(diagnosis, final, diagnosis.remaining, effects)
    first = diagnosis.rounds[0].before
    if not found and first is not final:
        found = _beside(diagnosis, first, diagnosis.rounds[0].dependences, effects)
    # What an effect has anew in each drive is no change.
    anew = extended_by(final.point.model.robot.effects)
    return tuple(each for each in found if each.group not in anew)


def _beside(
    diagnosis: Diagnosis, fit: Fitted, dependences: Sequence[Dependence], effects: Sequence[Effect]
) -> tuple[ParameterChange, ...]:
    """Changes beside a model, unless one more effect or a dependence explains them.

    `dependences`: evidence map of the model.
    """
    runs = diagnosis.runs
    evidence = evidence_of(runs, fit)
    order = driven_in_order([float(run.counters.time[0]) for run in runs.runs])
    drives = evidence.drives(np.arange(order.size, dtype=np.float64)).chosen(order)
    groups = groups_of(
        [number.name for number in evidence.numbers],
        evidence.values,
        len(drives.names),
        sized=tell_the_scale(drives.information, drives.names, evidence.values),
    )
    found = find_changes(drives, groups, evidence.values, fit.penalty_of_one)
    place = np.argsort(order)
    steps = [
        step
        for step in found.steps
        if of_several(step, len(runs.runs), fit.point.options.reference_kind)
        and _lasts(runs, evidence, found.steps, step, place)
    ]
    if not steps:
        return ()
    tried = {each.candidate.name: each for each in _scores_of(diagnosis, fit, effects)}
    of_clocks = any(step.group.what == DELAY for step in steps) and DELAY in tried
    # Where clocks differ, one delay for all is their mean: a part of what they explain, no rival.
    mean = [tried.pop(DELAY)] if of_clocks else []
    worth = sum(step.gain - fit.penalty_of_one * (step.degrees + 1) for step in steps)
    rest = max(
        _worth_of([*tried.values()], fit) + rules.RIVAL,
        rules.WORTH_OF_A_CHANGE * _worth_of(dependences, fit),
    )
    if worth < rules.RIVAL or worth + _worth_of(mean, fit) < rest:
        return ()
    more = [cell for cell in dependences if _worth_of([cell], fit) > worth]
    if not all(_stands_beside(diagnosis, fit, evidence, steps, place, cell) for cell in more):
        return ()
    if len(steps) < len(found.steps):
        found = only_these(drives, found, steps, evidence.values, fit.penalty_of_one)
    names = [runs.runs[index].name for index in order.tolist()]
    moved = parameter_changes_of(found, evidence.numbers, drives.names, names)
    # The levels are linear in the derivatives: beyond what is possible, these do not hold.
    bounds = {
        number.name: number.bounds_about(float(value))
        for number, value in zip(evidence.numbers, evidence.values, strict=False)
    }
    return moved if all(is_within(each, bounds) for each in moved) else ()


def is_within(moved: ParameterChange, bounds: Mapping[str, tuple[float, float]]) -> bool:
    """Whether a parameter is within its physical limits on either side of a change.

    No base doubles from drive to drive: on lines, a turn that coarse counters show is their own.
    """
    low, high = bounds.get(moved.what, (-math.inf, math.inf))
    there = low <= min(moved.before, moved.after) and max(moved.before, moved.after) <= high
    return there and (moved.what not in MULTIPLIERS or is_ordinary(moved.after / moved.before))


def driven_in_order(starts: Sequence[float]) -> NDArray[np.intp]:
    """Order of the drives by their stamps, if these are dates; else as they were given."""
    if all(start > rules.DATED for start in starts):
        return np.argsort(np.array(starts), kind="stable")
    return np.arange(len(starts))


def of_several(step: GroupChange, drives: int, kind: ReferenceKind) -> bool:
    """Whether more than one drive is on either side of a change, where that is required.

    A reference with correlated or accumulating errors now and then errs differently in one drive.
    That is no robot that changed and changed back. And a drive of another kind (starts and stops
    among laps) gives another size of an effect, as far as the form of its law is not exact. So a
    change of an effect must show in several drives on either side: surely before, and surely after.
    """
    if kind == "absolute" and step.group.what in PARTS:
        return True
    several = step.span[0] > rules.MOST_ALONE and step.span[1] < drives - rules.MOST_ALONE
    return several and step.shape.kind != "alone"


def _lasts(
    runs: Concatenated,
    evidence: Evidence,
    steps: Sequence[GroupChange],
    step: GroupChange,
    place: NDArray[np.intp],
) -> bool:
    """Homogeneity test of a change, with the others as nuisances."""
    others = [evidence.columns(other, place) for other in steps if other is not step]
    beside = nuisance(np.concatenate([evidence.shared, evidence.own, *others], axis=-1))
    column = evidence.columns(step, place)
    free, rest = beside.residual(column), beside.residual(evidence.white)
    test = score_test(column, free, rest)
    return (
        test is not None and lasting_columns(runs, test.gain, test.degrees, free, rest) < rules.SURE
    )


def _stands_beside(
    diagnosis: Diagnosis,
    fit: Fitted,
    evidence: Evidence,
    steps: Sequence[GroupChange],
    place: NDArray[np.intp],
    cell: Dependence,
) -> bool:
    """Whether changes remain significant beside a dependence that explains more.

    If a marker was mounted anew between squares and spins, the errors depend on the time since the
    start as well, since squares and spins turn at other times. A tyre that warms up differs between
    drives too, but only because it is warm.
    """
    columns = np.concatenate([evidence.columns(step, place) for step in steps], axis=-1)
    pattern = pattern_of(diagnosis.runs, fit.point, cell) / np.sqrt(fit.scatter)
    beside = nuisance(np.concatenate([evidence.shared, evidence.own, pattern], axis=-1))
    test = score_test(columns, beside.residual(columns), beside.residual(evidence.white))
    penalty = fit.penalty_of_one * len(steps)
    return (
        test is not None and test.gain - fit.penalty_of_one * test.degrees - penalty > rules.RIVAL
    )


def _scores_of(diagnosis: Diagnosis, fit: Fitted, effects: Sequence[Effect]) -> Sequence[Score]:
    """Scores of the effects that are not in the model."""
    this = next((each for each in diagnosis.rounds if each.before is fit), None)
    if this is not None:
        return this.scores
    numbers = (*CALIBRATION, *fit.numbers, *fit.point.model.nuisance_parameters)
    known = {applied.name for applied in fit.point.model.robot.effects}
    tried = candidates(effects, known, diagnosis.runs.channels, len(diagnosis.runs.runs))
    return scores(diagnosis.runs, fit.point, numbers, tried)


def _worth_of(found: Sequence[Score] | Sequence[Dependence], fit: Fitted) -> float:
    worth = (each.gain / fit.scatter - fit.penalty_of_one * each.degrees for each in found)
    return max(worth, default=0.0)


def _as_steps(steps: Sequence[GroupChange]) -> Iterator[GroupChange]:
    """Changes, each at a drive of its own: a step and an odd drive at one are two steps."""
    there = {(each.group.what, each.shape.first) for each in steps if each.shape.kind == "step"}
    for each in steps:
        first = each.shape.first
        if each.shape.kind == "alone" and (each.group.what, first) in there:
            later = Shape("step", first + 1)
            yield replace(each, shape=later, span=(first + 1, first + 1))
        else:
            yield each


def parameter_changes_of(
    found: ChangePoints, numbers: Sequence[FreeParameter], names: Sequence[str], runs: Sequence[str]
) -> tuple[ParameterChange, ...]:
    """List each parameter of each change, once for a drive.

    `runs`: names of the drives, in order.
    """
    declared = {number.name: number for number in numbers}
    told: dict[tuple[str, int], ParameterChange] = {}
    for step in _as_steps(found.steps):
        first = step.shape.first
        before = max(first - 1, 0)
        after = len(runs) - 1 if step.shape.kind == "trend" else first
        if step.shape.kind == "trend":
            before = first
        for name in step.group.numbers:
            index = names.index(name)
            spread = np.sqrt(np.maximum(found.spread[[before, after], index, index], 0.0))
            number = declared.get(name)
            levels = [float(found.levels[run, index]) for run in (before, after)]
            here, there = levels if number is None else map(number.wrapped, levels)
            moved = ParameterChange(
                name,
                step.group.what,
                step.shape.kind,
                runs[max(step.span[0] - 1, 0)],
                runs[first],
                runs[step.span[1]],
                here,
                there,
                float(spread[0]),
                float(spread[1]),
                "" if number is None else number.unit,
                step.p_value,
            )
            told.setdefault((name, first), moved)
    return tuple(told.values())
