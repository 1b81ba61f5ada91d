# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Events: sudden, large and rare steps of the pose or of the reference, which no law explains."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np

from werrimbi_odom.files.run import ReferenceKind, Run
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.events.common_cause import PLACES, Alike, alike
from werrimbi_odom.inference.events.groups import groups_of, net_of, returned_by
from werrimbi_odom.inference.events.steps import Steps, steps_of
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated, concatenated
from werrimbi_odom.inference.fitting.prediction import predict_all
from werrimbi_odom.inference.fitting.whitened_innovations import Point
from werrimbi_odom.inference.legs.matched_run import AlignedRun, MatchedRun, divided
from werrimbi_odom.model.effect import view_of
from werrimbi_odom.model.pose import Floats

Channel = Literal["along", "sideways", "heading", "reference"]
CHANNELS: tuple[Channel, ...] = ("along", "sideways", "heading")
UNITS = ("m", "m", "rad")


@dataclass(frozen=True, slots=True)
class Event:
    """An abrupt error at an instant."""

    run: Path
    """Path of the run as it was given."""
    held_out: bool
    time: float
    """By the clock of the run [s]."""
    seen: float
    """By the stamps of the reference, which may be late [s]."""
    started: float
    """First tick of the run, by the clock of the run [s]."""
    channel: Channel
    """Channel of the largest size in standard deviations; "reference" if the reference jumped."""
    size: float
    """Size in that channel [m, rad]; for a jump of the reference its distance [m], or its angle
    where that is the larger one in standard deviations [rad]."""
    std: float
    unit: str
    sizes: tuple[float, float, float]
    """Along, sideways and in heading [m, m, rad]."""
    stds: tuple[float, float, float]
    place: tuple[float, float]
    """Position of the robot by the reference [m]; NaN if it measured none."""
    stays: bool
    """Whether the error stayed; else the reference was right again at the next pose."""
    p_value: float
    """P-value, corrected for all instants and shapes tested (Bonferroni)."""
    beside_lost: bool = False
    """Whether it is close to a stretch in which a lidar's scans could not be matched."""


class Way(NamedTuple):
    """Measured positions of a drive, n poses."""

    run: Path
    held_out: bool
    time: Floats
    """Shape (n,) [s]."""
    x: Floats
    y: Floats


@dataclass(frozen=True, slots=True)
class Events:
    """All events of some drives."""

    events: tuple[Event, ...] = ()
    """Drive by drive, in order of time."""
    ways: tuple[Way, ...] = ()
    """Measured positions of the drives; empty without events."""
    alike: Alike | None = None
    """Common cause of those of the fitted drives, which decides."""
    many: bool = False
    """Whether errors jump more often than accidents happen. Then a law is missing, and no event is
    reported."""
    kind: ReferenceKind = "absolute"
    """Kind of the reference."""
    in_all: Alike | None = None
    """That of all of them, a place, where those of the fitted drives have none; it is only told."""

    @property
    def told(self) -> Alike | None:
        """What they are told to have in common."""
        return self.alike or self.in_all

    @property
    def systematic(self) -> bool:
        """Whether they have a common cause in the robot or in its floor; then they stay in fits.

        A place where the reference goes wrong tells of the reference: no law of the robot follows
        it.
        """
        return self.alike is not None and not self.alike.of_reference

    @property
    def left_out(self) -> bool:
        """Whether they are left out of fits.

        The jumps of a reference with correlated errors are already handled by its filter, which
        resets the error. A step of the robot would be another thing.
        """
        return bool(self.events) and not self.systematic and self.kind != "local_map"


class EventSide(NamedTuple):
    """Drives, and a model of them."""

    runs: Sequence[MatchedRun]
    paths: Sequence[Path]
    """Paths of the runs."""
    point: Point
    held_out: bool


def events_among(sides: Sequence[EventSide], kind: ReferenceKind) -> Events:
    """Abrupt errors that a model does not explain, in sides of which those held out come last.

    Held-out drives have no part in what becomes of events: whether these are too many, and have
    something in common, is decided by those of the fitted drives. None is reported of a held-out
    side that has too many, without anything in common.
    """
    found: list[list[Event]] = []
    legs, jumped, looked, many = [], [], [], []
    for side in sides:
        runs = at_every_pose(side.runs)
        steps = steps_of(runs, side.point)
        fitted = np.linalg.lstsq(steps.columns, steps.white, rcond=None)[0]
        sizes = np.asarray(fitted.reshape(-1, 3), dtype=np.float64)
        both = [
            (group[0], event)
            for group in groups_of(steps)
            if (event := _event(steps, group, side, sizes))
        ]
        own = [event for _, event in both]
        found.append(own)
        legs.append(np.array([steps.found[first].leg for first, _ in both], dtype=np.intp))
        jumped.append(np.array([event.channel == "reference" for event in own], dtype=np.bool_))
        looked.append((runs, predict_all(side.point.model, runs)))
        many.append(steps.many or _too_many(own, runs, side.paths))
        if many[-1] and not side.held_out:
            return Events(many=True, kind=kind)
    places = kind != "incremental"
    count = sum(not side.held_out for side in sides)
    common = alike(legs[:count], looked[:count], jumped[:count], places=places)
    in_all = common or alike(legs, looked, jumped, places=places)
    if common is None and in_all is not None and in_all.what not in PLACES:
        in_all = None  # a law of the robot: that is for the fitted drives to say
    events = [
        event
        for own, too_many in zip(found, many, strict=True)
        for event in own
        if not too_many or in_all is not None
    ]
    if not events:
        return Events(kind=kind)
    drives = [path for side in sides for path in side.paths]
    events.sort(key=lambda event: (drives.index(event.run), event.time))
    ways = [
        Way(path, side.held_out, run.measured.time, run.measured.x, run.measured.y)
        for side, (runs, _) in zip(sides, looked, strict=True)
        for run, path in zip(runs.runs, side.paths, strict=True)
    ]
    return Events(tuple(events), tuple(ways), common, kind=kind, in_all=in_all)


def _too_many(events: Sequence[Event], runs: Concatenated, paths: Sequence[Path]) -> bool:
    """Whether they are more than accidents would be, in all drives or in one of them."""
    driven = runs.duration * ~runs.gap
    time = np.bincount(runs.run_of_leg, driven, minlength=len(paths)).tolist()
    return len(events) * rules.RARE > sum(time) or any(
        sum(event.run == path for event in events) > max(rules.EVENTS_ALIKE, spent / rules.RARE)
        for path, spent in zip(paths, time, strict=True)
    )


def without(run: Run, happened: Events) -> Run:
    """The run with its new events marked; the same object if there are none."""
    new = [
        (event.seen - rules.EVENT_SPAN, event.seen + rules.EVENT_SPAN)
        for event in happened.events
        if event.run == run.path
        and not any(begin < event.seen < end for begin, end in run.happened)
    ]
    return replace(run, happened=tuple(sorted([*run.happened, *new]))) if new else run


def at_every_pose(runs: Sequence[MatchedRun]) -> Concatenated:
    """The same runs with a leg between successive poses, at the resolution of the search."""
    found = []
    for run in runs:
        time = run.record.measured.time.tolist()
        rows = [0]
        for row in range(1, len(time)):
            if time[row] - time[rows[-1]] >= rules.EVENT_INTERVAL:
                rows.append(row)
        plain = replace(run.record, happened=())
        found.append(divided(plain, np.array(rows, dtype=np.intp)))
    return concatenated(found)


def _event(steps: Steps, group: list[int], side: EventSide, fitted: Floats) -> Event | None:
    """The event that a group of steps makes, if it is sudden and large.

    `fitted`: least-squares sizes of all steps together, (q, 3).
    """
    runs = steps.runs
    spike = all(steps.found[index].shape == "spike" for index in group)
    # Beside a step, a spike only says how it is divided between two intervals.
    group = [index for index in group if spike or steps.found[index].shape != "spike"]
    legs = [steps.found[index].leg for index in group]
    first = legs[0]
    run = int(runs.run_of_leg[first])
    clock = runs.runs[run].counters.time
    at = runs.ends_at[first]
    if not clock[0] + rules.EDGE < at < clock[-1] - rules.EDGE:
        return None  # as in a fit: a late clock shows motion from outside the ticks' time there
    before, after = np.searchsorted(clock, [at - rules.EDGE, at + rules.EDGE])
    if np.diff(clock[before - 1 : after + 1]).max() > rules.EDGE:
        return None  # nor is the motion of the wheels known while their counters are silent
    scatter = float(steps.scatter[run])
    of_robot = any(steps.found[index].shape == "robot" for index in group)
    returned = spike or (not of_robot and returned_by(fitted[group] / steps.noise[legs]))
    net = group[:1] if returned else group
    sizes, spread = net_of(steps, net, scatter, beside=False)
    beside, spread_beside = net_of(steps, net, scatter, beside=True)
    stds = np.sqrt(np.diag(spread))
    large = np.abs(sizes) > rules.EVENT_LARGE * steps.noise[first] * np.sqrt(scatter)
    sudden = np.abs(beside) > rules.EVENT_BESIDE * np.sqrt(np.diag(spread_beside))
    # A coordinate that is not measured has no noise: a heading inferred from positions.
    told = sudden & (large | ~steps.innovations.known[first])
    if not told.any():
        return None
    channel = int(np.argmax(np.where(told, np.abs(sizes) / stds, 0.0)))
    interval = float(runs.duration[first])
    jumped = not of_robot or _beyond_any_push(sizes, len(group), interval)
    name: Channel = "reference" if jumped else CHANNELS[channel]
    size, std, unit = float(sizes[channel]), float(stds[channel]), UNITS[channel]
    if jumped and channel < 2:
        size = float(np.hypot(*sizes[:2]))
        std = float(np.sqrt(sizes[:2] @ spread[:2, :2] @ sizes[:2])) / size
    end = runs.ends_at[legs]
    middle = end if spike else end - 0.5 * runs.duration[legs]
    weight = np.abs(fitted[group, channel])
    seen = float(np.sum(weight * middle) / np.sum(weight))
    own = runs.runs[run]
    stamp = seen + own.record.delay
    view = view_of(side.point.model.of_run(run).effects)
    return Event(
        side.paths[run],
        side.held_out,
        stamp - view.late(stamp - own.counters.time[0]),
        stamp,
        float(own.counters.time[0]),
        name,
        size,
        std,
        unit,
        (float(sizes[0]), float(sizes[1]), float(sizes[2])),
        (float(stds[0]), float(stds[1]), float(stds[2])),
        (float(runs.finish[first, 0]), float(runs.finish[first, 1])),
        not returned,
        min(steps.p_values[index] for index in group),
        _is_beside_lost(own.record, seen),
    )


def _is_beside_lost(record: AlignedRun, seen: float) -> bool:
    apart = np.abs(np.array(record.lost) - seen)
    return record.measured.own_axes and bool((apart < rules.BESIDE_LOST).any())


def _beyond_any_push(sizes: Floats, parts: int, interval: float) -> bool:
    """Whether no force moves a robot this far in one interval, or two."""
    return bool(np.hypot(*sizes[:2]) > 0.5 * rules.JOLT * (parts * interval) ** 2)
