# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Models judged on runs that took no part in their fit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from werrimbi_odom.files.run import ReferenceKind, Run, Ticks
from werrimbi_odom.inference.comparison.judged_legs import (
    Prepared,
    finely,
    judged_by,
    judged_legs,
    prepare,
)
from werrimbi_odom.inference.comparison.legs import statistics
from werrimbi_odom.inference.diagnosis.search import with_own_values
from werrimbi_odom.inference.fitting.costs import Costs
from werrimbi_odom.inference.fitting.design import Point
from werrimbi_odom.inference.fitting.fit import fit_model, start_point
from werrimbi_odom.inference.fitting.knobs import NUISANCES, Model, knobs_of
from werrimbi_odom.inference.fitting.together import Together
from werrimbi_odom.model.encoder import EncoderLimits
from werrimbi_odom.model.robot import Robot

SHARE = 0.25
"""Of the runs, or of a single one, that is put aside where no held-out runs were given."""


@dataclass(frozen=True, slots=True)
class Sides:
    """A figure before and after."""

    before: float
    after: float
    unit: Literal["m", "rad"] = "m"
    """Radians where headings alone were measured, and errors are those of the heading."""


@dataclass(frozen=True, slots=True)
class Errors:
    """Root mean square errors of legs: of position [m], or of headings alone [rad]."""

    train: float
    holdout: float
    train_median: float
    holdout_median: float
    holdout_yaw: float
    """Root mean square heading error [rad]."""
    unit: Literal["m", "rad"]


@dataclass(frozen=True)
class Judge:
    """Legs to judge models on: those of the runs they were fitted on, and of others."""

    given: Robot
    kind: ReferenceKind
    fitted_on: tuple[Run, ...]
    kept_back: tuple[Run, ...]
    train: Prepared
    holdout: Prepared
    fine: Together
    """Held-out runs in the short legs of a fit, for what each run has of its own."""

    @property
    def nothing_of_own(self) -> tuple[Mapping[str, float], ...]:
        """For a model that has no values of the runs' own."""
        return tuple({} for _ in self.fitted_on)

    def of(self, model: Model) -> Errors:
        """Errors of a model; what each held-out run has of its own is fitted to that run alone."""
        train = _figures(self.train, model.without_nuisances())
        holdout = _figures(self.holdout, known_at_home(model, self.fine, self.kind))
        if judged_by(self.train) == "heading":
            return Errors(train[2], holdout[2], train[3], holdout[3], holdout[2], "rad")
        return Errors(train[0], holdout[0], train[1], holdout[1], holdout[2], "m")

    def at_home(self, model: Model) -> Point:
        """The model in the held-out runs: shared values as they are, the runs' own learnt."""
        return at_home(model, self.fine, self.kind)

    def holds(self, before: Model, after: Model) -> bool:
        """Whether the held-out runs are likelier with the one model than with the other.

        Each with the noise that suits it: a wrong model's own is wide enough for any.
        """
        costs = []
        for model in (before, after):
            point = self.at_home(model)
            costs.append(float(Costs(self.fine, point, self.kind)(point.variances)[0]))
        return costs[1] < costs[0] + 2.0


def known_at_home(model: Model, runs: Together, kind: ReferenceKind) -> Model:
    """A model in other runs, without what belongs to the references alone."""
    plain = model.without_nuisances()
    if not any(plain.own) and all(applied.ready for applied in plain.robot.effects):
        return Model(plain.robot, tuple({} for _ in runs.runs))
    return at_home(model, runs, kind).model.without_nuisances()


def at_home(model: Model, runs: Together, kind: ReferenceKind) -> Point:
    """A model in other runs: shared values stay, what those runs have of their own is fitted."""
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
    point = start_point(runs, replace(model.robot, effects=effects))
    point, _ = with_own_values(runs, point, kind)
    knobs = point.model.nuisance_knobs
    for applied in effects:
        knobs += [
            knob
            for knob in knobs_of(applied.effect)
            if knob.per_run and knob.name in point.model.own[0]
        ]
    return fit_model(runs, point, kind, knobs, find_jumps=False, rounds=1).point


def judge_of(
    runs: Sequence[Run],
    holdout: Sequence[Run],
    robot: Robot,
    kind: ReferenceKind,
    leg: float,
    limits: EncoderLimits | None,
    sigma_xy: float | None,
    sigma_yaw: float | None,
) -> Judge:
    """Put runs aside where none were given for it, and cut the legs."""
    fitted_on, kept_back = (tuple(runs), tuple(holdout)) if holdout else set_aside(runs)
    train, held = (
        prepare(some, robot, kind, leg=leg, limits=limits, sigma_xy=sigma_xy, sigma_yaw=sigma_yaw)
        for some in (fitted_on, kept_back)
    )
    return Judge(robot, kind, fitted_on, kept_back, train, held, finely(held, limits))


def set_aside(runs: Sequence[Run]) -> tuple[tuple[Run, ...], tuple[Run, ...]]:
    """Some of the runs for judging; of a single run its last part."""
    if len(runs) > 1:
        count = max(1, round(SHARE * len(runs)))
        every = len(runs) / count
        kept = {int((number + 0.5) * every) for number in range(count)}
        return (
            tuple(run for index, run in enumerate(runs) if index not in kept),
            tuple(run for index, run in enumerate(runs) if index in kept),
        )
    run = runs[0]
    time = run.ticks.time
    at = float(time[0] + (1.0 - SHARE) * (time[-1] - time[0]))
    return (_part(run, -np.inf, at),), (_part(run, at, np.inf),)


def _part(run: Run, begin: float, end: float) -> Run:
    ticks, reference = run.ticks, run.reference
    which = (ticks.time >= begin) & (ticks.time < end)
    cut = Ticks(
        ticks.time[which],
        ticks.left[which],
        ticks.right[which],
        {name: values[which] for name, values in ticks.channels.items()},
    )
    if reference is None:
        return replace(run, ticks=cut)
    there = (reference.time >= begin) & (reference.time < end)
    return replace(run, ticks=cut, reference=reference.chosen(there))


def _figures(prepared: Prepared, model: Model) -> tuple[float, float, float, float]:
    legs = judged_legs(prepared, model, prepared.leg)
    figures = statistics(legs.errors.chosen(~legs.outlier))
    whole = statistics(legs.errors)
    turned = np.abs(legs.errors.error[:, 2])
    middle = float(np.median(turned[np.isfinite(turned)])) if np.isfinite(turned).any() else np.nan
    return figures.rmse_position_m, whole.median_position_m, figures.rmse_yaw_rad, middle
