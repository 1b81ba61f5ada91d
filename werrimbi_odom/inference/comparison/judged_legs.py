# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Runs prepared for a comparison: legs cut, the reference's noise and its jumps found, once.

What is compared later over the same runs (another robot file, one more effect) is compared over the
same legs, with the same legs left out and the same noise of the reference.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.run import ReferenceKind, Run
from werrimbi_odom.inference.comparison.jumps import jumped_legs, jumps_of
from werrimbi_odom.inference.comparison.legs import (
    LegErrors,
    LegStatistics,
    errors_of,
    joined,
    statistics,
)
from werrimbi_odom.inference.comparison.own_noise import OwnNoise, ReferenceNoise, noise_of
from werrimbi_odom.inference.comparison.reference_noise import (
    Measure,
    Residual,
    measured_alike,
    residuals_of,
)
from werrimbi_odom.inference.fitting.knobs import YAW_DRIFT, Model
from werrimbi_odom.inference.fitting.own_values import known_at_home
from werrimbi_odom.inference.fitting.prediction import legs_shown
from werrimbi_odom.inference.fitting.together import Together, together
from werrimbi_odom.inference.legs.cutting import (
    Record,
    cut_finely,
    divided,
    every_pose,
    leg_ends,
    match_finely,
    record_of,
)
from werrimbi_odom.inference.legs.cutting import (
    joined as joined_legs,
)
from werrimbi_odom.inference.legs.gaps import LeftOut
from werrimbi_odom.inference.legs.no_driving import looked_at
from werrimbi_odom.inference.rules import (
    DRIFT_LEGS,
    FAR_ABOVE_NOISE,
    LEG_LENGTHS,
    LEGS_OF_A_LENGTH,
    LEGS_OF_A_RUN,
    MOST_WHEEL_NOISE,
    QUARTER_TURN,
)
from werrimbi_odom.model.encoder import EncoderLimits
from werrimbi_odom.model.pose import Floats, wrap_all
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.progress import Show, silent


@dataclass(frozen=True, slots=True, eq=False)
class Legs:
    """All legs of one length, run by run, those on which the reference jumped among them."""

    leg: float
    """[m]"""
    errors: LegErrors
    outlier: NDArray[np.bool_]
    run: NDArray[np.intp]
    """Index of the run, shape (m,)."""
    start_time: Floats
    """[s]"""
    end_time: Floats
    x: Floats
    """Measured position at the start, as the reference gives it, shape (m,) [m]."""
    y: Floats
    end_x: Floats
    end_y: Floats
    variables: Mapping[str, Floats]
    """What errors may go with, by name with unit, shape (m,) each."""

    def chosen(self, which: NDArray[np.bool_] | NDArray[np.intp]) -> Legs:
        """Some of the legs, by mask or by index."""
        columns = {
            item.name: getattr(self, item.name)[which]
            for item in fields(self)
            if item.name not in ("leg", "errors", "variables")
        }
        variables = {name: values[which] for name, values in self.variables.items()}
        return Legs(leg=self.leg, errors=self.errors.chosen(which), variables=variables, **columns)


@dataclass(frozen=True, slots=True, eq=False)
class _Group:
    """Runs whose references measure alike."""

    index: tuple[int, ...]
    measure: Measure
    every: Together
    whole: tuple[bool, ...]
    """Whether all rows of a run's reference are in `every`."""
    jumps: tuple[Floats, ...]
    own: OwnNoise
    """What the references err by themselves."""
    plain: tuple[Residual, ...]
    """Paths by the robot by whose travel the legs are cut."""


@dataclass(frozen=True, slots=True, eq=False)
class Prepared:
    """Runs ready to be judged."""

    robot: Robot
    """By whose travel the legs are cut."""
    kind: ReferenceKind
    leg: float
    limits: EncoderLimits | None
    runs: tuple[Run, ...]
    groups: tuple[_Group, ...]
    cuts: Mapping[float, tuple[Together, ...]]
    """By length, for each group."""

    @property
    def measures(self) -> tuple[Measure, ...]:
        """What the reference of each run measures."""
        found: dict[int, Measure] = {}
        for group in self.groups:
            found.update(dict.fromkeys(group.index, group.measure))
        return tuple(found[index] for index in range(len(self.runs)))

    @property
    def noises(self) -> tuple[tuple[Measure, ReferenceNoise], ...]:
        """The reference's noise, for each of the ways in which it measures."""
        return tuple((group.measure, group.own.noise) for group in self.groups)

    @property
    def left_out(self) -> tuple[LeftOut, ...]:
        """Stretches that no model is judged on, run by run: gaps, and legs of a reference's jump.

        Whoever finds another reason to leave a stretch out adds it to the record of the run
        (`legs.cutting.Record.left_out`), and it is cut out and told like these.
        """
        found: list[list[LeftOut]] = [[] for _ in self.runs]
        for group, legs in zip(self.groups, self.cuts[self.leg], strict=True):
            spoilt = _jumped(group, legs, self.kind)
            for place, (index, run) in enumerate(zip(group.index, legs.runs, strict=True)):
                found[index] += run.record.left_out
                own = spoilt[legs.legs[place] : legs.legs[place + 1]] & ~run.gap
                time, path = run.measured.time, self.runs[index].path
                started = float(run.counters.time[0])
                found[index] += [
                    LeftOut(
                        path,
                        float(time[leg]),
                        float(time[leg + 1]),
                        "reference",
                        "it jumped",
                        started,
                    )
                    for leg in np.flatnonzero(own).tolist()
                ]
        return tuple(part for own in found for part in sorted(own, key=lambda one: one.begin))


def prepare(
    runs: Sequence[Run],
    robot: Robot,
    kind: ReferenceKind = "absolute",
    *,
    leg: float = 1.0,
    limits: EncoderLimits | None = None,
    sigma_xy: float | None = None,
    sigma_yaw: float | None = None,
    show: Show = silent,
) -> Prepared:
    """Match, find the reference's noise and jumps, and cut legs of several lengths.

    Raises
    ------
    InputError
        When a run has no usable reference or no ticks.
    """
    runs = [looked_at(run, robot, limits) for run in runs]
    members: dict[Measure, list[tuple[int, Record, bool]]] = {}
    for index, run in enumerate(runs):
        show(0.5 * index / len(runs), f"matching {run.name}")
        alike, measure = measured_alike(run)
        record = record_of(alike, robot, limits, leg)
        members.setdefault(measure, []).append((index, record, alike is run))
    groups = tuple(
        _group(robot, measure, found, kind, leg, sigma_xy, sigma_yaw)
        for measure, found in members.items()
    )
    show(0.5, "cutting legs")
    return Prepared(
        robot, kind, leg, limits, tuple(runs), groups, _cut_to_lengths(groups, robot, leg)
    )


def _cut_to_lengths(
    groups: Sequence[_Group], robot: Robot, leg: float
) -> dict[float, tuple[Together, ...]]:
    """Legs of all lengths of which there are enough, joined of the shortest.

    A length is as good as another where both have the same legs, for the reference is too rare.
    """
    records = [[run.record for run in group.every.runs] for group in groups]
    runs = sum(map(len, records))
    ways = [[_way(record, robot, leg) for record in own] for own in records]
    rows: dict[float, list[list[NDArray[np.intp]]]] = {}
    counts: set[int] = set()
    for times in sorted(LEG_LENGTHS, key=lambda times: (times != 1.0, times)):
        found = [
            [leg_ends(way, record.gap, times) for way, record in zip(*own, strict=True)]
            for own in zip(ways, records, strict=True)
        ]
        count = sum(
            ends.size - 1 - int(record.gap.sum())
            for own in zip(found, records, strict=True)
            for ends, record in zip(*own, strict=True)
        )
        if times == 1.0 or (
            count not in counts and count >= max(LEGS_OF_A_LENGTH, LEGS_OF_A_RUN * runs)
        ):
            rows[times * leg] = found
            counts.add(count)
    parts = []
    for number, own in enumerate(records):
        every = [
            np.unique(np.concatenate(ends))
            for ends in zip(*(r[number] for r in rows.values()), strict=True)
        ]
        parts.append(together([divided(*one) for one in zip(own, every, strict=True)]))
    return {
        length: tuple(
            together([joined_legs(*one) for one in zip(part.runs, own, strict=True)], part)
            for part, own in zip(parts, found, strict=True)
        )
        for length, found in rows.items()
    }


def _way(record: Record, robot: Robot, leg: float) -> Floats:
    """What was gone up to each pose of a record, in legs."""
    counters = record.counters
    way = counters.way(robot, leg, QUARTER_TURN)
    return np.interp(record.measured.time, counters.time, way)


def finely(prepared: Prepared) -> Together:
    """Cut the runs into the short legs of a fit: what `match_finely` does, from what is there."""
    found = {}
    for group in prepared.groups:
        for index, every, whole in zip(group.index, group.every.runs, group.whole, strict=True):
            if whole:
                found[index] = cut_finely(every.record, prepared.robot, prepared.leg)
            else:
                run = prepared.runs[index]
                [found[index]] = match_finely([run], prepared.robot, prepared.leg, prepared.limits)
    return together([found[index] for index in range(len(prepared.runs))])


def _group(
    robot: Robot,
    measure: Measure,
    members: list[tuple[int, Record, bool]],
    kind: ReferenceKind,
    leg: float,
    sigma_xy: float | None,
    sigma_yaw: float | None,
) -> _Group:
    every = together([every_pose(record) for _, record, _ in members])
    plain = Model(robot, tuple({} for _ in members))
    residuals, _ = residuals_of(plain, every, measure)
    own = noise_of(robot, every, residuals, measure, kind, leg, (sigma_xy, sigma_yaw))
    jumps = tuple(
        jumps_of(residual, run.gap) for residual, run in zip(residuals, every.runs, strict=True)
    )
    return _Group(
        tuple(index for index, _, _ in members),
        measure,
        every,
        tuple(whole for _, _, whole in members),
        jumps,
        own,
        residuals,
    )


def in_runs(prepared: Prepared, robot: Robot | Model) -> Model:
    """A robot as it is judged on these runs, by every verb.

    What each run has of its own and the robot does not say is learnt in that run; values that a
    `Model` brings are kept. What belongs to the references alone is found anew.
    """
    if isinstance(robot, Model):
        plain = robot.without_nuisances()
        if any(plain.own):
            return plain
        robot = plain.robot
    bare = Model(robot, tuple({} for _ in prepared.runs))
    if all(applied.ready for applied in robot.effects):
        return bare
    return known_at_home(bare, finely(prepared), prepared.kind)


def judged_legs(prepared: Prepared, model: Model, leg: float) -> Legs:
    """Errors of all legs of one length, in the order of the runs; gaps are no legs."""
    parts = []
    asked = prepared.cuts[prepared.leg]
    for group, usual, runs in zip(prepared.groups, asked, prepared.cuts[leg], strict=True):
        own = _of_group(group, model)
        by_position = group.measure == "position"
        if by_position:
            _, own = residuals_of(own, group.every, group.measure)
        elif group.measure == "heading":
            own = _with_drifts(own, usual)
        errors = errors_of(
            own,
            runs,
            group.own.sigma_xy[runs.run_of_leg],
            group.own.sigma_yaw[runs.run_of_leg],
            prepared.kind,
            by_position=by_position,
            sigma_stamp=group.own.noise.sigma_stamp,
            wandering=group.own.wandering,
            jumped=_jumped(group, runs, prepared.kind),
        )
        parts.append(_table(prepared, group, runs, errors, leg))
    return _in_order(parts)


def figures_of(prepared: Prepared, robot: Robot | Model) -> LegStatistics:
    """Figures of a robot or model over the legs of the length asked for: one answer for all verbs.

    Over the legs on which the reference did not jump; the median is over all.
    """
    legs = judged_legs(prepared, in_runs(prepared, robot), prepared.leg)
    return statistics_of(legs)


def statistics_of(legs: Legs) -> LegStatistics:
    """The same of legs that were judged."""
    kept = statistics(legs.errors.chosen(~legs.outlier))
    return replace(kept, median_position_m=statistics(legs.errors).median_position_m)


def paths(prepared: Prepared, model: Model) -> tuple[Residual, ...]:
    """Measured and dead-reckoned path of every run, in their order."""
    found: dict[int, Residual] = {}
    for group in prepared.groups:
        residuals, own = group.plain, _of_group(group, model)
        if own.robot != prepared.robot or any(own.own):
            residuals, _ = residuals_of(own, group.every, group.measure)
        found.update(zip(group.index, residuals, strict=True))
    return tuple(found[index] for index in range(len(prepared.runs)))


def _of_group(group: _Group, model: Model) -> Model:
    """The model with what the group's runs have of their own."""
    return Model(model.robot, tuple(model.own[index] for index in group.index))


def _with_drifts(model: Model, runs: Together) -> Model:
    """The model with the drift of each run's gyro, which is no error of the robot.

    That is the slope of the heading errors over time that most legs have (least absolute values: a
    median of slopes, weighed by the legs' durations), as fits have a drift of every run free. A run
    of fewer than `DRIFT_LEGS` has none: it would take the whole error of one leg for it.
    """
    seen = legs_shown(model, runs)[:, 2]
    error = wrap_all(runs.finish[:, 2] - runs.start[:, 2] - seen)
    known = np.isfinite(error) & ~runs.gap & (runs.duration > 0.0)
    own = []
    for index, mine in enumerate(model.own):
        rows = np.flatnonzero(known & (runs.run_of_leg == index))
        slopes = error[rows] / runs.duration[rows]
        order = np.argsort(slopes)
        weight = np.cumsum(runs.duration[rows][order])
        middle = int(np.searchsorted(weight, 0.5 * weight[-1])) if rows.size else 0
        drift = float(slopes[order][middle]) if rows.size >= DRIFT_LEGS else 0.0
        own.append({**mine, YAW_DRIFT: drift})
    return Model(model.robot, tuple(own))


def _jumped(group: _Group, runs: Together, kind: ReferenceKind) -> NDArray[np.bool_]:
    """Legs that a jump of the reference spoils, shape (m,)."""
    both = zip(group.jumps, runs.runs, strict=True)
    return np.concatenate([jumped_legs(jumps, run.rows, kind) for jumps, run in both])


def _table(
    prepared: Prepared, group: _Group, runs: Together, errors: LegErrors, leg: float
) -> Legs:
    times = [run.measured.time for run in runs.runs]
    begin = np.concatenate([time[:-1] for time in times])
    end = np.concatenate([time[1:] for time in times])
    legs = Legs(
        leg,
        errors,
        _jumped(group, runs, prepared.kind) | runs.stepped,
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


def _variables(runs: Together, errors: LegErrors, begin: Floats, end: Floats) -> dict[str, Floats]:
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


def judged_by(prepared: Prepared) -> Literal["position", "heading"]:
    """What legs are judged by: their positions, or where none are measured, their headings."""
    return "heading" if all(measure == "heading" for measure in prepared.measures) else "position"


def far_above_noise(prepared: Prepared, model: Model) -> bool:
    """Whether a model's errors are beyond anything that its noise, and the reference's, explain.

    A likelihood that was free to choose the noise calls any model right; this asks with the noise
    of the softest wheels there are, and of the reference by its own small differences. By what a
    usual leg is promised: a first one, whose heading nobody measured, is promised anything.
    """
    legs = judged_legs(prepared, model, prepared.leg)
    kept = legs.errors.chosen(~legs.outlier)
    places = slice(2, 3) if judged_by(prepared) == "heading" else slice(0, 2)
    error = np.sum(kept.error[:, places] ** 2, axis=1)
    least = max(min(model.robot.left_wheel_noise, model.robot.right_wheel_noise), 1e-6)
    softest = max((MOST_WHEEL_NOISE / least) ** 2 - 1.0, 0.0)
    covariance = kept.covariance + softest * kept.wheels
    promised = np.trace(covariance[:, places, places], axis1=1, axis2=2)
    known = np.isfinite(error)
    if not known.any():
        return False
    return bool(np.mean(error[known]) > FAR_ABOVE_NOISE**2 * np.median(promised[known]))
