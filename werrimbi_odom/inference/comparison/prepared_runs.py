# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Runs prepared for comparisons: legs, reference noise and reference jumps, computed once.

Later comparisons over the same runs (another robot file, one more effect) use the same legs, the
same exclusions and the same reference noise.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import compress
from typing import Literal, TypeVar

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.local_map_errors import wandering_of
from werrimbi_odom.inference.comparison.poses_within_legs import parts_for_fit
from werrimbi_odom.inference.comparison.reference_group import ReferenceGroup, group_of, jumped_in
from werrimbi_odom.inference.comparison.reference_noise_source import ReferenceNoise
from werrimbi_odom.inference.comparison.residuals import Measure, measured_alike
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated, concatenated
from werrimbi_odom.inference.legs.aligned_run import record_of
from werrimbi_odom.inference.legs.count_interpolation import Counters
from werrimbi_odom.inference.legs.cutting import cut_for_fit, ends_in
from werrimbi_odom.inference.legs.gaps import LeftOut
from werrimbi_odom.inference.legs.matched_run import AlignedRun, MatchedRun, divided
from werrimbi_odom.inference.legs.matched_run import joined as joined_legs
from werrimbi_odom.inference.legs.usable_run import with_no_driving
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.progress import Show, silent

_Each = TypeVar("_Each")


@dataclass(frozen=True, slots=True, eq=False)
class PreparedRuns:
    """Runs ready for comparison."""

    robot: Robot
    """Robot whose travel cuts the legs."""
    options: EvaluationOptions
    runs: tuple[Run, ...]
    groups: tuple[ReferenceGroup, ...]
    cuts: Mapping[float, tuple[Concatenated, ...]]
    """Legs by length, for each group."""
    parts: int
    """Short legs of a fit to a judged one."""

    @property
    def measures(self) -> tuple[Measure, ...]:
        """What the reference of each run measures."""
        return self.in_order(lambda group: [group.measure] * len(group.index))

    @property
    def counters(self) -> tuple[Counters, ...]:
        """Encoder counts of each run."""
        return self.in_order(lambda group: [run.counters for run in group.every.runs])

    def in_order(self, of_group: Callable[[ReferenceGroup], Iterable[_Each]]) -> tuple[_Each, ...]:
        """Values for the runs of each group, in the order of the runs."""
        found: dict[int, _Each] = {}
        for group in self.groups:
            found.update(zip(group.index, of_group(group), strict=True))
        return tuple(found[index] for index in range(len(self.runs)))

    @property
    def noises(self) -> tuple[tuple[Measure, ReferenceNoise], ...]:
        """Reference noise, for each kind of measurement."""
        return tuple((group.measure, group.own.noise) for group in self.groups)

    @property
    def left_out(self) -> tuple[LeftOut, ...]:
        """Excluded stretches, run by run: gaps, and legs on which the reference jumped.

        To exclude a stretch for another reason, add it to the record of the run
        (`legs.matched_run.AlignedRun.left_out`); it is then cut out and reported like these.
        """
        found: list[list[LeftOut]] = [[] for _ in self.runs]
        for group, legs in zip(self.groups, self.cuts[self.options.leg], strict=True):
            spoilt = jumped_in(group, legs, self.options.reference_kind)
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
    options: EvaluationOptions = EvaluationOptions(),
    *,
    show: Show = silent,
) -> PreparedRuns:
    """Match runs, estimate the reference's noise, find its jumps, and cut legs of several lengths.

    InputError if a run has no usable reference or no ticks, or increments without headings.
    """
    for run in runs:
        _refuse_increments_of_positions(run, options)
    runs = [with_no_driving(run, robot, options.limits) for run in runs]
    members: dict[Measure, list[tuple[int, AlignedRun, bool]]] = {}
    for index, run in enumerate(runs):
        show(0.5 * index / len(runs), f"matching {run.name}")
        alike, measure = measured_alike(run)
        record = record_of(alike, robot, options.limits, options.leg)
        members.setdefault(measure, []).append((index, record, alike is run))
    groups = tuple(group_of(robot, measure, found, options) for measure, found in members.items())
    show(0.5, "cutting legs")
    cuts = _cut_to_lengths(groups, robot, options.leg)
    parts = parts_for_fit(groups, robot, options)
    return PreparedRuns(robot, options, tuple(runs), groups, cuts, parts)


def refuse_standing(runs: Sequence[Run], *, carried: bool = False) -> None:
    """Check that a wheel of some drive turned; InputError if none did.

    `carried`: a reference that moved will do, of a robot that was carried.
    """
    for run in runs:
        moved = [run.ticks.left, run.ticks.right]
        if carried and run.reference is not None:
            moved += [run.reference.x, run.reference.y, run.reference.yaw]
        known = [values[np.isfinite(values)] for values in moved]
        if any(values.size > 0 and values.max() > values.min() for values in known):
            return
    names = ", ".join(str(run.path) for run in runs)
    raise InputError(
        f"{names}: the wheels stood all the time: no count changes. Nothing is told by a robot "
        "that stands; are these the ticks of this drive? `werrimbi info` lists what is in a "
        "recording"
    )


def _refuse_increments_of_positions(run: Run, options: EvaluationOptions) -> None:
    """Without the heading at its start, no leg of a reference that adds up can be predicted."""
    if options.reference_kind != "incremental" or run.reference is None:
        return
    positions = np.count_nonzero(run.reference.has_position)
    if positions > 1 and np.count_nonzero(run.reference.has_yaw) < 2:
        raise InputError(
            f"{run.path}: the reference has positions alone, and --reference-kind incremental (as "
            "a gyro's headings have by themselves) needs headings too: nothing else says where a "
            "leg leads; give --reference-kind absolute, or local_map if its error wanders"
        )


def _cut_to_lengths(
    groups: Sequence[ReferenceGroup], robot: Robot, leg: float
) -> dict[float, tuple[Concatenated, ...]]:
    """Legs of all lengths with enough legs, merged from the shortest.

    A length is skipped if it gives as many legs as another, because the reference is sparse.
    """
    records = [[run.record for run in group.every.runs] for group in groups]
    runs = sum(map(len, records))
    ways = [group.ways(robot, leg) for group in groups]
    rows: dict[float, list[list[NDArray[np.intp]]]] = {}
    counts: set[int] = set()
    for times in sorted(rules.LEG_LENGTHS, key=lambda times: (times != 1.0, times)):
        found = [
            [ends_in(record, way, times) for way, record in zip(*own, strict=True)]
            for own in zip(ways, records, strict=True)
        ]
        count = sum(
            ends.size - 1 - int(record.gap.sum())
            for own in zip(found, records, strict=True)
            for ends, record in zip(*own, strict=True)
        )
        if times == 1.0 or (
            count not in counts and count >= max(rules.LEGS_OF_A_LENGTH, rules.LEGS_OF_A_RUN * runs)
        ):
            rows[times * leg] = found
            counts.add(count)
    parts = []
    for number, own in enumerate(records):
        every = [
            np.unique(np.concatenate(ends))
            for ends in zip(*(r[number] for r in rows.values()), strict=True)
        ]
        parts.append(concatenated([divided(*one) for one in zip(own, every, strict=True)]))
    return {
        length: tuple(
            concatenated([joined_legs(*one) for one in zip(part.runs, own, strict=True)], part)
            for part, own in zip(parts, found, strict=True)
        )
        for length, found in rows.items()
    }


def with_wander_of(prepared: PreparedRuns, robot: Robot) -> PreparedRuns:
    """The same runs, with the wander of their references as a robot's own errors leave it.

    Beside the robot that the runs were prepared with, what that robot lacks is told as wander: a
    late clock made 14 mm of each metre, and noise alone was to make 9. The same runs where the
    error of no reference wanders.
    """

    def of_group(group: ReferenceGroup) -> ReferenceGroup:
        if group.own.wandering is None:
            return group
        found = wandering_of([run.record for run in group.every.runs], robot, prepared.options)
        return replace(group, own=replace(group.own, wandering=found.variances))

    return replace(prepared, groups=tuple(map(of_group, prepared.groups)))


def for_fit(prepared: PreparedRuns, robot: Robot) -> list[MatchedRun]:
    """Cut the runs into the short legs of a fit, by the travel of a robot.

    Records are matched once more only for another robot than the one they were prepared with, or
    with rows of the reference that are not judged.
    """
    options, there = prepared.options, dict[int, AlignedRun]()
    for group in prepared.groups if robot is prepared.robot else ():
        records = (run.record for run in group.every.runs)
        there.update(compress(zip(group.index, records, strict=True), group.whole))
    shares = prepared.in_order(lambda group: group.own.shares)
    return [
        cut_for_fit(
            there.get(index)
            or replace(record_of(run, robot, options.limits, options.leg), noise_shares=of),
            robot,
            options.leg,
            prepared.parts,
        )
        for index, (run, of) in enumerate(zip(prepared.runs, shares, strict=True))
    ]


def finely(prepared: PreparedRuns) -> Concatenated:
    """The runs in the short legs of a fit, by the robot that they were prepared with."""
    return concatenated(for_fit(prepared, prepared.robot))


def judged_by(prepared: PreparedRuns) -> Literal["position", "heading"]:
    """Quantity that legs are judged by: position, or heading where only headings are measured."""
    return "heading" if all(measure == "heading" for measure in prepared.measures) else "position"
