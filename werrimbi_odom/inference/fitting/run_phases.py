# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Per-run values (such as a phase whose counter starts anywhere), estimated in each run.

Shared values stay fixed. So all commands judge a robot file without a phase alike, and a model that
was fitted elsewhere is judged on drives outside its fit.
"""

from __future__ import annotations

from dataclasses import replace

from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import ReferenceKind
from werrimbi_odom.inference.fitting.candidate import Candidate
from werrimbi_odom.inference.fitting.candidate_starts import with_candidate
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.fit import fit_model, start_point
from werrimbi_odom.inference.fitting.free_parameters import (
    CALIBRATION,
    NUISANCES,
    FreeParameter,
    Model,
    changed,
    parameters_to_fit,
)
from werrimbi_odom.inference.fitting.identifiable import CALIBRATED, NOT_BY_COURSE
from werrimbi_odom.inference.fitting.score_tests import Score, scores
from werrimbi_odom.inference.fitting.whitened_innovations import Point
from werrimbi_odom.model.effect import AppliedEffect, extended_by


def model_in_runs(model: Model, runs: Concatenated, kind: ReferenceKind) -> Model:
    """Model in other runs, without the nuisance parameters of the references."""
    plain = model.without_nuisances()
    if not any(plain.own) and all(applied.ready for applied in plain.robot.effects):
        return Model(plain.robot, tuple({} for _ in runs.runs))
    return fitted_per_run(model, runs, kind).model.without_nuisances()


def fitted_per_run(model: Model, runs: Concatenated, kind: ReferenceKind) -> Point:
    """Model in other runs: shared values stay, per-run values are fitted."""
    own = sorted({name for mine in model.own for name in mine if name not in NUISANCES})
    effects = tuple(
        replace(
            applied,
            unknown=tuple(
                name for name in applied.effect.parameters if f"{applied.name}.{name}" in own
            )
            or applied.unknown,
        )
        for applied in model.robot.effects
    )
    robot = replace(model.robot, effects=effects)
    point = start_point(runs, robot, EvaluationOptions(reference_kind=kind))
    point, _ = with_own_values(runs, point)
    numbers = (*point.model.nuisance_parameters, *own_parameters(point))
    return fit_model(runs, point, numbers, find_jumps=False, rounds=1).point


def own_parameters(point: Point) -> tuple[FreeParameter, ...]:
    """Free parameters of effects that each run of a point has of its own."""
    return tuple(
        number
        for applied in point.model.robot.effects
        for number in parameters_to_fit(applied.effect)
        if number.per_run and number.name in point.model.own[0]
    )


def with_own_values(runs: Concatenated, point: Point) -> tuple[Point, tuple[FreeParameter, ...]]:
    """Point with the per-run values of the robot's effects, and all their free parameters.

    A phase can be anywhere, so it is found by its score, which needs no start value. What refines a
    law is free where the robot has a value of it.
    """
    numbers: list[FreeParameter] = []
    held = (*CALIBRATED, *extended_by(point.model.robot.effects))
    if runs.has_course_headings:
        held = (*held, *NOT_BY_COURSE)
    for applied in point.model.robot.effects:
        if applied.effect.is_mistake or applied.name in held:
            continue  # sizes are in every fit, and what extends an effect holds all of it
        shared = tuple(
            name
            for name, item in applied.effect.parameters.items()
            if item.per_run and name not in applied.unknown
        )
        as_usual = {
            f"{applied.name}.{name}"
            for name, item in applied.effect.parameters.items()
            if item.is_unrefined(applied.values[name])
        }
        own = parameters_to_fit(applied.effect, shared)
        numbers += (number for number in own if number.name not in as_usual)
        if applied.unknown:
            point = replace(point, model=_learnt(runs, point, applied))
    return point, tuple(numbers)


def _learnt(runs: Concatenated, point: Point, applied: AppliedEffect) -> Model:
    """Model with the phases of an effect in each run."""
    robot = point.model.robot
    others = tuple(item for item in robot.effects if item is not applied)
    bare = replace(point, model=replace(point.model, robot=replace(robot, effects=others)))
    candidate = Candidate(applied.effect, {})
    found = scores(runs, bare, CALIBRATION, [candidate])
    # Bump and flat are equivalent to first order: take the one that the robot has.
    score = next((each for each in found if _of_sign(each, applied)), None)
    if score is None:
        return bare.model
    model = with_candidate(bare.model, score)
    known = {
        f"{applied.name}.{name}": value
        for name, value in applied.values.items()
        if name not in applied.unknown
    }
    return Model(changed(model.robot, known), model.own)


def _of_sign(score: Score, applied: AppliedEffect) -> bool:
    if score.places is None:
        return True
    sizes = [
        applied.values[name] for name, item in applied.effect.parameters.items() if not item.tries
    ]
    return all(size * score.coefficients[0] >= 0.0 for size in sizes)
