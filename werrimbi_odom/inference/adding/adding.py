# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Add effects to a model: fitted together with all calibration, judged on held-out drives.

An effect is accepted if it lowers the held-out error by more than calibration alone does, differs
significantly from null, and stays within its physical bounds. Otherwise the objection is reported,
and only the user can put the effect in.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.adding.added import WHEEL_NOISES, Added, JudgedSide
from werrimbi_odom.inference.adding.fits import Fits, fits_without_jumps
from werrimbi_odom.inference.adding.fitted_parameters import (
    moved_values,
    parameters_of,
    std_of,
    to_write,
    with_other_sign,
)
from werrimbi_odom.inference.adding.objection import Question
from werrimbi_odom.inference.adding.start_values import FitDrives, drives_of, with_set_up
from werrimbi_odom.inference.calibration_parametrisation import base_name, robot_for_cutting
from werrimbi_odom.inference.comparison.compare import compare
from werrimbi_odom.inference.comparison.judged_legs import Legs, in_runs, judged_legs
from werrimbi_odom.inference.comparison.prepared_runs import PreparedRuns
from werrimbi_odom.inference.diagnosis.ahead_or_behind import ahead_or_behind
from werrimbi_odom.inference.diagnosis.calibration_selection import (
    FreeSizes,
    sizes_needed,
    with_sizes,
)
from werrimbi_odom.inference.diagnosis.either_sign import variances_by_sign
from werrimbi_odom.inference.diagnosis.evidence import Dependence, dependences
from werrimbi_odom.inference.diagnosis.holdout import Begun, Judge, begin
from werrimbi_odom.inference.diagnosis.misfit import Misfit, misfit_of_found
from werrimbi_odom.inference.diagnosis.paired_comparison import Sides, sides_of
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.diagnosis.uncertainty import (
    as_written,
    noises_of,
    with_spread,
)
from werrimbi_odom.inference.diagnosis.without_events import events_beside, refit_without_events
from werrimbi_odom.inference.events.events import Events
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated, concatenated
from werrimbi_odom.inference.fitting.free_parameters import (
    CALIBRATION,
    MULTIPLIERS,
    NUISANCES,
    Model,
)
from werrimbi_odom.inference.fitting.identifiable import CALIBRATED, NOT_BY_COURSE
from werrimbi_odom.inference.fitting.noise import NoiseEstimate, beyond_wheel_noise, with_noise
from werrimbi_odom.inference.set_up.search import SetUp
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.progress import Show, silent


class _Together(NamedTuple):
    """Effects fitted to drives, and what they were prepared for."""

    started: Begun
    also: tuple[str, ...]
    """Set-up mistakes that are corrected with them."""
    drives: FitDrives
    fits: Fits


def add_effects(
    effects: Sequence[Effect],
    runs: Sequence[Run],
    robot: Robot,
    options: EvaluationOptions = EvaluationOptions(),
    *,
    given: Robot | None = None,
    holdout: Sequence[Run] = (),
    show: Show = silent,
) -> Added:
    """Fit effects together with all calibration, and judge each of them.

    `effects`: distinct effects; calibration effects and set-up mistakes may be among them. `runs`:
    recorded drives with a reference. `robot`: the model that the fit begins with. `options`: how
    drives are cut into legs and judged. `given`: Robot by whose travel legs are cut, and with whose
    errors the fit is compared; by default `robot`. `holdout`: runs for judging only. If empty,
    parts of `runs` are held out. InputError when a run cannot be used, or is in other units; when a
    channel that an effect reads was not measured, or the drives do not determine an effect at all.
    """
    held = {item.name for item in robot.effects}
    for effect in effects:
        _refuse_unmeasured(effect, [*runs, *holdout])
        if effect.name in held and effect.is_mistake:
            raise InputError(
                f"the robot file lists {effect.name} already; a mistake put right twice is made "
                "again"
            )
    if any(base_name(effect) is not None for effect in effects):
        robot = replace(robot, wheels_a_side=max(robot.wheels_a_side, 2))  # the request implies it

    def fit_them(
        runs: Sequence[Run], holdout: Sequence[Run], first: bool
    ) -> tuple[_Together, Events]:
        told = show if first else silent
        told(0.0, "set-up")
        started = begin(runs, holdout, robot, options, given=given)
        judge, set_up = started.judge, started.set_up
        begun, also = with_set_up(effects, robot, set_up)
        told(0.15, "calibration")
        drives = drives_of(judge.train, robot_for_cutting(begun, robot), options)
        drives, fits = fits_without_jumps(effects, drives, begun, robot, also, told)
        found = _Together(started, also, drives, fits)
        return found, events_beside(drives.laid, fits.all.point, judge)

    (started, also, drives, fits), happened = refit_without_events(fit_them, runs, holdout)
    fit, set_up = fits.all, started.set_up
    wanted = _calibrations_wanted(effects, set_up)
    sizes = sizes_needed(fit, robot, wanted)
    fit = with_sizes(drives.laid, fit, robot, sizes)
    show(0.75, "judging")
    judge = started.by_the_clock_of(fit.point.model.robot)
    noises, remaining, misfit, sane = _noise(drives.laid, as_written(drives.laid, fit, robot))
    explained = misfit is None and sane
    noisy = with_noise(robot, {name: _told(noises[name]) for name in WHEEL_NOISES})
    noise: dict[str, Any] = {
        name: getattr(noisy if explained else robot, name) for name in WHEEL_NOISES
    }
    train, kept = _judged(judge, fits.none, fit, noise)
    alone = {name: _at_home(judge, each, kept, noise) for name, each in fits.without.items()}
    question = Question(tuple(effects), drives, fits, fit, robot, also, kept, alone, set_up)
    chances, objections = question.chances, question.objections
    model = fit.point.model
    per_run = tuple(sorted(set(model.own[0]) - set(NUISANCES))) if model.own else ()
    written = fit
    by_sign = variances_by_sign(drives.laid, fits.either.values(), robot, wanted)
    if not holdout:
        show(0.9, "all runs")
        drives, written = _on_all(judge, drives, fit, robot, sizes)
    known = with_spread(effects, drives.laid, written, robot, wanted, sizes, noises, by_sign)
    final = replace(to_write(written.point.model, robot), **noise)
    show(0.95, "comparing")
    kept_back = [replace(run, happened=()) for run in judge.kept_back]
    compared = compare(kept_back if holdout else runs, final, options)
    return Added(
        effects=tuple(effects),
        fitted={
            effect.name: with_other_sign(
                parameters_of(effect, known, robot), effect.name, fits.either.get(effect.name)
            )
            for effect in effects
        },
        moved=moved_values([effect.name for effect in effects], known, robot),
        also=tuple(name for name in also if name not in chances),
        given=robot,
        robot=final,
        multiplier_stds={name: std_of(known, name) or None for name in MULTIPLIERS},
        ratio_std=known.std_of_size("unequal_wheel_radii"),
        train=train,
        holdout=kept,
        without={name: sides.before for name, sides in alone.items()},
        set_aside=() if holdout else tuple(run.name for run in judge.kept_back),
        written_from_all=not holdout,
        noises=noises,
        explained=explained,
        remaining=remaining,
        misfit=misfit,
        ahead_or_behind=ahead_or_behind(drives.laid, written, robot),
        set_up=set_up,
        per_run=per_run,
        chances=chances,
        objections=objections,
        left_out=judge.left_out,
        happened=happened,
        compared=compared,
    )


def _calibrations_wanted(effects: Sequence[Effect], set_up: SetUp) -> set[str]:
    """Sizes that are fitted regardless of their gain: asked for, or far off in the file."""
    names = {effect.name for effect in effects} | {item.effect for item in set_up.findings}
    as_base = {effect.name for effect in effects if base_name(effect) is not None}
    return (names | ({"track_width"} if as_base else set())) & set(CALIBRATED)


def _refuse_unmeasured(effect: Effect, runs: Sequence[Run]) -> None:
    for run in runs:
        columns = run.ticks.channels.items()
        measured = [name for name, values in columns if np.isfinite(values).any()]
        for channel in effect.lacks(measured):
            raise InputError(
                f"{effect.name} looks at the measured channel {channel}, a column of "
                f"ticks.csv, and {run.name} has none"
            )
        laid = run.reference is not None and run.reference.by_course
        if effect.name in NOT_BY_COURSE and laid:
            raise InputError(
                f"{effect.name} is an angle between heading and path, and the headings of "
                f"{run.name} were laid upon its path: they tell nothing of it"
            )


def _judged(
    judge: Judge, base: Fitted, fit: Fitted, noise: Mapping[str, Any]
) -> tuple[JudgedSide, JudgedSide]:
    """Legs of the fitted and the held-out drives; per-run parameters are fitted run by run."""
    plain = Model(judge.given, judge.nothing_of_own)
    final = _noisy(fit, noise)
    by_noise = judge.by_the_wander_of(final)
    after = _legs(judge.train, final)
    train = JudgedSide(
        _legs(judge.train, in_runs(judge.train, plain)),
        _legs(judge.train, base.point.model),
        after,
        after if by_noise is judge else _legs(by_noise.train, final),
    )
    models = [judge.fitted_per_run(each).model for each in (plain, base.point.model, final)]
    before, calibrated, after = (_legs(judge.holdout, each) for each in models)
    promising = after if by_noise is judge else _legs(by_noise.holdout, models[-1])
    return train, JudgedSide(before, calibrated, after, promising)


def _at_home(judge: Judge, without: Fitted, kept: JudgedSide, noise: Mapping[str, Any]) -> Sides:
    """Change of the held-out error from a model without one effect to that with all."""
    legs = _legs(judge.holdout, judge.fitted_per_run(_noisy(without, noise)).model)
    return sides_of(legs, kept.after, kept.unit)


def _noisy(fit: Fitted, noise: Mapping[str, Any]) -> Model:
    """The fitted model with the wheel noise of the file that is written."""
    model = fit.point.model
    return Model(replace(model.robot, **noise), model.own)


def _legs(prepared: PreparedRuns, model: Model) -> Legs:
    return judged_legs(prepared, model.without_nuisances(), prepared.options.leg)


def _noise(
    runs: Concatenated, fit: Fitted
) -> tuple[dict[str, NoiseEstimate], tuple[Dependence, ...], Misfit | None, bool]:
    """Wheel noise, remaining dependences, misfit, and whether the noise is plausible."""
    noises = noises_of(runs, fit)
    found = dependences(runs, fit.point, (*CALIBRATION, *fit.numbers))
    remaining = tuple(cell for cell in found if cell.p_value < rules.VERY_SURE)
    wheels = [noises[name] for name in WHEEL_NOISES]
    sane = not any(beyond_wheel_noise(item) for item in wheels)
    return noises, remaining, misfit_of_found(fit, remaining, runs), sane


def _told(noise: NoiseEstimate) -> NoiseEstimate:
    """Rounded to the digits of a file."""
    return replace(noise, value=float(f"{noise.value:.4g}"))


def _on_all(
    judge: Judge,
    drives: FitDrives,
    fit: Fitted,
    given: Robot,
    sizes: FreeSizes,
) -> tuple[FitDrives, Fitted]:
    """Fit the same model to all runs, including the held-out parts."""
    both = [drives, drives_of(judge.holdout, fit.point.model.robot, drives.options)]
    laid = tuple(run for part in both for run in part.laid.runs)
    skipped = tuple(legs for part in both for legs in part.skipped)
    every = replace(drives, laid=concatenated(laid), skipped=skipped)
    home = judge.fitted_per_run(fit.point.model)
    own = (*fit.point.model.own, *home.model.own)
    point = replace(fit.point, model=Model(fit.point.model.robot, own), excluded=skipped)
    again = every.fit(point, fit.names, fit.numbers, given)
    return every, with_sizes(every.laid, again, given, sizes)
