# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Errors of a model on the legs of prepared runs, computed in one way for all commands."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.leg_errors import (
    LegErrors,
    LegStatistics,
    errors_of,
    joined,
    statistics,
)
from werrimbi_odom.inference.comparison.prepared_runs import PreparedRuns, finely, judged_by
from werrimbi_odom.inference.comparison.reference_group import ReferenceGroup, jumped_in
from werrimbi_odom.inference.comparison.residuals import Residual, residuals_of
from werrimbi_odom.inference.distributions import fisher_survival
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import YAW_DRIFT, Model
from werrimbi_odom.inference.fitting.prediction import predicted_legs, right_handed
from werrimbi_odom.inference.fitting.run_phases import model_in_runs
from werrimbi_odom.inference.legs.gyro_bias import AtRest
from werrimbi_odom.model.effect import view_of
from werrimbi_odom.model.pose import Floats, wrap_all
from werrimbi_odom.model.robot import Robot


@dataclass(frozen=True, slots=True, eq=False)
class Legs:
    """All legs of one length, run by run, including those on which the reference jumped."""

    leg: float
    """[m]"""
    errors: LegErrors
    outlier: NDArray[np.bool_]
    event: NDArray[np.bool_]
    """Legs with an abrupt event (`Run.happened`)."""
    run: NDArray[np.intp]
    """Index of the run, shape (m,)."""
    start_time: Floats
    """[s]"""
    end_time: Floats
    x: Floats
    """Measured position at the start, in the reference's frame, shape (m,) [m]."""
    y: Floats
    end_x: Floats
    end_y: Floats
    variables: Mapping[str, Floats]
    """Variables on which errors may depend, by name with unit, shape (m,) each."""

    def chosen(self, which: NDArray[np.bool_] | NDArray[np.intp]) -> Legs:
        """Select legs by mask or index."""
        columns = {
            item.name: getattr(self, item.name)[which]
            for item in fields(self)
            if item.name not in ("leg", "errors", "variables")
        }
        variables = {name: values[which] for name, values in self.variables.items()}
        return Legs(leg=self.leg, errors=self.errors.chosen(which), variables=variables, **columns)

    @property
    def quiet(self) -> Legs:
        """Legs without an abrupt event."""
        return self.chosen(~self.event) if self.event.any() else self


def in_runs(prepared: PreparedRuns, robot: Robot | Model) -> Model:
    """Model of a robot for these runs, the same for all commands.

    Per-run values that the robot lacks are estimated in each run; those of a `Model` are kept.
    Nuisance parameters of the references are always estimated again.
    """
    if isinstance(robot, Model):
        plain = robot.without_nuisances()
        if any(plain.own):
            return plain
        robot = plain.robot
    bare = Model(robot, tuple({} for _ in prepared.runs))
    if all(applied.ready for applied in robot.effects):
        return bare
    return model_in_runs(bare, finely(prepared), prepared.options.reference_kind)


def judged_legs(prepared: PreparedRuns, model: Model, leg: float) -> Legs:
    """Errors of all legs of one length, in the order of the runs, without gaps."""
    parts = []
    asked = prepared.cuts[prepared.options.leg]
    for group, usual, runs in zip(prepared.groups, asked, prepared.cuts[leg], strict=True):
        own = _of_group(group, model)
        by_position = group.measure == "position"
        if by_position:
            _, own = residuals_of(own, group.every, group.measure, group.pieces)
        elif group.measure == "heading":
            own = _with_drifts(own, usual)
        errors = errors_of(
            own,
            runs,
            group.own.sigma_xy[runs.run_of_leg],
            group.own.sigma_yaw[runs.run_of_leg],
            prepared.options.reference_kind,
            by_position=by_position,
            sigma_stamp=group.own.noise.sigma_stamp,
            wandering=group.own.wandering,
            jumped=jumped_in(group, runs, prepared.options.reference_kind),
        )
        parts.append(_table(prepared, group, runs, errors, leg))
    return _in_order(parts)


def figures_of(prepared: PreparedRuns, robot: Robot | Model) -> LegStatistics:
    """Statistics of a robot or model over the legs of the requested length, for all commands.

    Legs on which the reference jumped only count for the median.
    """
    legs = judged_legs(prepared, in_runs(prepared, robot), prepared.options.leg)
    return statistics_of(legs)


def statistics_of(legs: Legs) -> LegStatistics:
    """Statistics of judged legs; those on which the reference jumped only count for the median."""
    kept = statistics(legs.errors.chosen(~legs.outlier))
    return replace(kept, median_position_m=statistics(legs.errors).median_position_m)


def paths(prepared: PreparedRuns, model: Model) -> tuple[Residual, ...]:
    """Measured and dead-reckoned path of every run, in order."""

    def of_group(group: ReferenceGroup) -> tuple[Residual, ...]:
        own = _of_group(group, model)
        if own.robot == prepared.robot and not any(own.own):
            return group.plain
        return residuals_of(own, group.every, group.measure, group.pieces)[0]

    return prepared.in_order(of_group)


def _of_group(group: ReferenceGroup, model: Model) -> Model:
    """Model restricted to the runs of a group."""
    return Model(model.robot, tuple(model.own[index] for index in group.index))


def _with_drifts(model: Model, runs: Concatenated) -> Model:
    """Model with the drift of each run's gyro, which is no error of the robot.

    Fits leave this drift free too. To what the model has of it the rest is added: the slope of
    heading errors over time by least absolute deviations, a median of slopes weighted by the legs'
    durations. Of a run of fewer than `DRIFT_LEGS` nothing is, as it would absorb the whole error of
    one leg. Rests limit it: a robot that veers at a steady speed is no gyro that drifts. All of it
    is in a right-handed frame, as predictions are.
    """
    view = view_of(model.robot.effects)
    seen = predicted_legs(model, runs)[:, 2]
    turned = right_handed(runs.finish, view)[:, 2] - right_handed(runs.start, view)[:, 2]
    error = wrap_all(turned - seen)
    known = np.isfinite(error) & ~runs.gap & (runs.duration > 0.0)
    own = []
    for index, mine in enumerate(model.own):
        rows = np.flatnonzero(known & (runs.run_of_leg == index))
        slopes = error[rows] / runs.duration[rows]
        order = np.argsort(slopes)
        weight = np.cumsum(runs.duration[rows][order])
        middle = int(np.searchsorted(weight, 0.5 * weight[-1])) if rows.size else 0
        drift = float(slopes[order][middle]) if rows.size >= rules.DRIFT_LEGS else 0.0
        drift += mine.get(YAW_DRIFT, 0.0)
        at_rest = runs.runs[index].record.at_rest
        if at_rest is not None:
            rate, unsure, _ = at_rest
            drift = AtRest(-rate if view.mirrored else rate, unsure).limited(drift)
        own.append({**mine, YAW_DRIFT: drift})
    return Model(model.robot, tuple(own))


def _table(
    prepared: PreparedRuns, group: ReferenceGroup, runs: Concatenated, errors: LegErrors, leg: float
) -> Legs:
    times = [run.measured.time for run in runs.runs]
    begin = np.concatenate([time[:-1] for time in times])
    end = np.concatenate([time[1:] for time in times])
    legs = Legs(
        leg,
        errors,
        jumped_in(group, runs, prepared.options.reference_kind),
        runs.stepped,
        np.array(group.index)[runs.run_of_leg],
        begin,
        end,
        runs.start[:, 0],
        runs.start[:, 1],
        runs.finish[:, 0],
        runs.finish[:, 1],
        _variables(runs, errors, begin, end),
    )
    return legs.chosen(~runs.gap) if runs.gap.any() else legs


def _variables(
    runs: Concatenated, errors: LegErrors, begin: Floats, end: Floats
) -> dict[str, Floats]:
    first = runs.legs[runs.run_of_leg]
    driven = np.concatenate([[0.0], np.cumsum(errors.length)])
    middle = 0.5 * (begin + end)
    variables = {
        "speed [m/s]": errors.length / runs.duration,
        "turn rate [rad/s]": errors.turn / runs.duration,
        "heading [rad]": errors.heading,
        "time since start [s]": begin - begin[first],
        "distance since start [m]": driven[:-1] - driven[first],
    }
    names = dict.fromkeys(name for run in runs.runs for name in run.counters.channels)
    for name in names:
        values = np.full(runs.count, np.nan)
        for index, run in enumerate(runs.runs):
            channel = run.counters.channels.get(name)
            if channel is None or not np.isfinite(channel).any():
                continue
            known = np.isfinite(channel)
            own = slice(runs.legs[index], runs.legs[index + 1])
            values[own] = np.interp(middle[own], run.counters.time[known], channel[known])
        variables[name] = values
    return variables


def _in_order(parts: list[Legs]) -> Legs:
    """Legs of all groups, sorted by run."""
    if len(parts) == 1:
        return parts[0]
    names = dict.fromkeys(name for part in parts for name in part.variables)
    columns = {
        item.name: np.concatenate([getattr(part, item.name) for part in parts])
        for item in fields(Legs)
        if item.name not in ("leg", "errors", "variables")
    }
    whole = Legs(
        leg=parts[0].leg,
        errors=joined([part.errors for part in parts]),
        variables={
            name: np.concatenate(
                [part.variables.get(name, np.full(part.run.size, np.nan)) for part in parts]
            )
            for name in names
        },
        **columns,
    )
    return whole.chosen(np.argsort(whole.run, kind="stable"))


def far_above_noise(prepared: PreparedRuns, model: Model) -> bool:
    """Whether a model's errors are larger than any noise of wheels and reference explains.

    A likelihood with free noise accepts any model. This test uses the largest plausible wheel
    noise, and the reference noise from its own small differences. Each leg counts by its own
    variance: of positions, a first leg has an unknown heading and may end anywhere. By Fisher's F,
    chance must not exceed it either: few poses tell their noise poorly, and fewer not at all. The
    reference's share of the variance is all that is uncertain (Satterthwaite, Biometrics Bull. 2,
    1946).
    """
    legs = judged_legs(prepared, model, prepared.options.leg).quiet
    kept = legs.errors.chosen(~legs.outlier)
    by_heading = judged_by(prepared) == "heading"
    places = slice(2, 3) if by_heading else slice(0, 2)
    error = np.sum(kept.error[:, places] ** 2, axis=1)
    known = np.isfinite(error)
    if not known.any():
        return False
    least = max(min(model.robot.left_wheel_noise, model.robot.right_wheel_noise), 1e-6)
    softest = max((rules.MOST_WHEEL_NOISE / least) ** 2 - 1.0, 0.0)
    reference, wheels = (
        np.trace(each[known, places, places], axis1=1, axis2=2)
        for each in (kept.covariance - kept.wheels, (1.0 + softest) * kept.wheels)
    )
    ratio = float(np.mean(error[known] / (reference + wheels)))
    share = float(np.median(reference / (reference + wheels)))
    judging = (each for each in prepared.groups if by_heading or each.measure != "heading")
    freedom = min(group.own.freedom[by_heading] for group in judging) / share**2
    chance = fisher_survival(ratio, float(np.isfinite(kept.error[:, places]).sum()), freedom)
    return freedom > 0.0 and ratio > rules.FAR_ABOVE_NOISE**2 and chance < rules.SURE
