# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Models judged on held-out runs, which took no part in their fit."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.comparison.judged_legs import Legs, in_runs, judged_legs
from werrimbi_odom.inference.comparison.prepared_runs import (
    PreparedRuns,
    finely,
    judged_by,
    prepare,
    refuse_standing,
    with_wander_of,
)
from werrimbi_odom.inference.diagnosis.outlying_drives import RecordedOtherwise, recorded_otherwise
from werrimbi_odom.inference.diagnosis.paired_comparison import Sides, Unit, error_of, sides_of
from werrimbi_odom.inference.diagnosis.splitting import set_aside
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import Model
from werrimbi_odom.inference.fitting.run_phases import fitted_per_run, model_in_runs
from werrimbi_odom.inference.fitting.whitened_innovations import Point
from werrimbi_odom.inference.legs.gaps import LeftOut
from werrimbi_odom.inference.legs.usable_run import with_no_driving
from werrimbi_odom.inference.set_up.search import SetUp, look_for_mistakes, on_the_clock_of
from werrimbi_odom.model.robot import Robot


@dataclass(frozen=True, slots=True)
class Errors:
    """Root mean square errors of legs: position [m], or heading if only that is known [rad]."""

    train: float
    holdout: float
    yaw: tuple[float, float]
    """Root mean square heading errors of train and holdout [rad]."""
    quiet: tuple[float, float]
    """`train` and `holdout` without legs with an abrupt event."""
    unit: Unit
    legs: Legs
    """Legs of the held-out drives."""
    fitted_legs: Legs
    """Legs of the fitted drives."""

    def to(self, after: Errors) -> Sides:
        """Change of the held-out error from this model to another."""
        return sides_of(self.legs, after.legs, self.unit)


@dataclass(frozen=True)
class Judge:
    """Legs to judge models on: those of the fitted runs, and those of the held-out runs."""

    given: Robot
    options: EvaluationOptions
    fitted_on: tuple[Run, ...]
    kept_back: tuple[Run, ...]
    train: PreparedRuns
    holdout: PreparedRuns
    fine: Concatenated
    """Held-out runs in the short legs of a fit, for the estimation of their per-run parameters."""

    @property
    def nothing_of_own(self) -> tuple[Mapping[str, float], ...]:
        """Empty per-run values, one for each fitted run."""
        return tuple({} for _ in self.fitted_on)

    @property
    def left_out(self) -> tuple[LeftOut, ...]:
        """Stretches of all runs that are excluded from judgement."""
        return tuple(dict.fromkeys((*self.train.left_out, *self.holdout.left_out)))

    def of(self, model: Model) -> Errors:
        """Errors of a model; per-run parameters of a held-out run are fitted to that run alone."""
        train = _legs(self.train, in_runs(self.train, model))
        holdout = _legs(self.holdout, model_in_runs(model, self.fine, self.options.reference_kind))
        unit: Unit = "rad" if judged_by(self.train) == "heading" else "m"
        return Errors(
            error_of(train, unit),
            error_of(holdout, unit),
            (error_of(train, "rad"), error_of(holdout, "rad")),
            (error_of(train.quiet, unit), error_of(holdout.quiet, unit)),
            unit,
            holdout,
            train,
        )

    def by_the_wander_of(self, model: Model) -> Judge:
        """The judge for what noise alone leaves: its references wander as the model leaves it."""
        if self.options.reference_kind != "local_map":
            return self
        train, holdout = (
            with_wander_of(prepared, model.robot) for prepared in (self.train, self.holdout)
        )
        return replace(self, train=train, holdout=holdout)

    def fitted_per_run(self, model: Model) -> Point:
        """The model for the held-out runs: shared values kept, per-run parameters estimated."""
        return fitted_per_run(model, self.fine, self.options.reference_kind)


@dataclass(frozen=True)
class Begun:
    """Result of the preparation that every judgement of drives begins with."""

    judge: Judge
    set_up: SetUp
    """Set-up, found in the fitted drives alone."""
    otherwise: tuple[RecordedOtherwise, ...]
    """Drives recorded with another set-up; left out wherever others remain."""
    prepared_by: Callable[[Robot], Judge]
    """The same judge, of the drives prepared anew by a robot's clock."""

    def by_the_clock_of(self, robot: Robot) -> Judge:
        """The judge by the delay of a fit, where the clocks differ: as `compare` by its file.

        The set-up search, by whose delay the drives were prepared, knows it to some hundredths of a
        second.
        """
        given = self.judge.given
        cutter = on_the_clock_of(robot, given)
        if cutter is given or self.judge.train.robot is given:
            return self.judge
        return self.prepared_by(cutter)


def begin(
    runs: Sequence[Run],
    holdout: Sequence[Run],
    robot: Robot,
    options: EvaluationOptions,
    *,
    given: Robot | None = None,
) -> Begun:
    """Split the drives, find the set-up of the fitted ones, and leave out drives of another set-up.

    `runs`: runs to fit; a part of them is held out if `holdout` is empty. `holdout`: runs for
    judging only. `robot`: the model as given. `options`: how drives are cut into legs and judged.
    `given`: Robot by whose travel legs are cut, where that is not `robot`. InputError when a run
    has no usable reference or no ticks, or is in degrees or millimetres; when the wheels stood
    still in all of them.
    """

    def divided(cutter: Robot) -> tuple[tuple[Run, ...], tuple[Run, ...]]:
        some, others = (
            tuple(with_no_driving(run, cutter, options.limits) for run in each)
            for each in (runs, holdout)
        )
        return (some, others) if others else set_aside(some)

    def set_up_of(kept: Sequence[Run]) -> SetUp:
        set_up = look_for_mistakes(kept, robot, options)
        if set_up.to_convert is not None:
            raise InputError(f"{kept[0].path}: {set_up.to_convert}")
        return set_up

    given = given or robot
    refuse_standing((*runs, *holdout))
    fitted, held = divided(given)
    set_up = set_up_of(fitted)
    # One clock before anything else is looked for: rests, held stretches, legs, noise.
    cutter = set_up.on_its_clock(given)
    if cutter is not given:
        fitted, held = divided(cutter)
    judge = judge_of(fitted, held, given, options, cutter)
    otherwise = recorded_otherwise(judge.train, judge.holdout, set_up.robot, options)
    sides = []
    for side, held_out in ((fitted, False), (held, True)):
        odd = {each.path for each in otherwise if each.held_out == held_out}
        sides.append(tuple(run for run in side if run.path not in odd) or side)
    if (sides[0], sides[1]) != (fitted, held):
        set_up = set_up_of(sides[0])
        judge = judge_of(sides[0], sides[1], given, options, set_up.on_its_clock(given))

    def prepared_by(cutter: Robot) -> Judge:
        kept = ({run.path for run in side} for side in sides)
        both = zip(divided(cutter), kept, strict=True)
        some, others = ([run for run in side if run.path in paths] for side, paths in both)
        return judge_of(some, others, given, options, cutter)

    # What an effect of the file has anew in each drive is no mistake.
    return Begun(judge, set_up.beside(robot.effects), otherwise, prepared_by)


def judge_of(
    runs: Sequence[Run],
    holdout: Sequence[Run],
    given: Robot,
    options: EvaluationOptions,
    cutter: Robot | None = None,
) -> Judge:
    """Cut the legs of the fitted runs and of the held-out runs, by the given robot or another."""
    fitted_on, kept_back = tuple(runs), tuple(holdout)
    train, held = (prepare(some, cutter or given, options) for some in (fitted_on, kept_back))
    held = replace(held, parts=min(held.parts, train.parts))
    return Judge(given, options, fitted_on, kept_back, train, held, finely(held))


def _legs(prepared: PreparedRuns, model: Model) -> Legs:
    return judged_legs(prepared, model, prepared.options.leg)
