# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Cutting runs into legs: ticks and reference on common nodes, one leg per unit of travel.

A reference pose falls between two tick messages. Steps are split there, in counts, so that
splitting a step changes neither its motion nor its noise. Everything that is fitted later (radii,
base, effects, noise) acts on these counts. So a run is split once, and again only when the
reference's clock is shifted.

No leg spans an excluded stretch (robot held or carried, gap in the reference or the ticks). The
interval from the last leg before such a stretch to its end is marked as a gap: fits and judgements
skip it, while state that accumulates along a run (distance, wheel angle, heading where only
positions are measured) continues through it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.evaluation import EvaluationOptions
from werrimbi_odom.files.run import NoDriving, Reference, Run
from werrimbi_odom.inference.legs.clock import clock_offset
from werrimbi_odom.inference.legs.counters import Counters, counters_of, nodes_at
from werrimbi_odom.inference.legs.gaps import LeftOut, gaps_in, touched
from werrimbi_odom.inference.legs.no_driving import looked_at
from werrimbi_odom.inference.rules import (
    EDGE,
    EDGE_LEGS,
    FEW_POSES,
    MOMENT,
    NO_DRIVING_ENDS,
    PARTS_OF_A_LEG,
    QUARTER_TURN,
    RATE_OF_FIT,
    TURN_WORTH_SAYING,
    WAY_WORTH_SAYING,
)
from werrimbi_odom.model.drive import Span
from werrimbi_odom.model.encoder import EncoderLimits
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

ROUNDING = 1e-12
"""Relative rounding error of sums over the steps of a drive."""


@dataclass(frozen=True, slots=True)
class AlignedRun:
    """A run on one clock: counters, r usable reference poses, excluded stretches."""

    name: str
    counters: Counters
    measured: Reference
    """Usable poses, shape (r,), at the times at which they were seen."""
    delay: float
    """Delay of the reference by the robot that the run is cut by, which its times are free of
    [s]."""
    gap: NDArray[np.bool_]
    """Excluded intervals between poses, shape (r - 1,)."""
    left_out: tuple[LeftOut, ...]
    sigma_xy: float | None
    """Stated standard deviation of the reference's position [m]."""
    sigma_yaw: float | None
    """Stated standard deviation of the reference's heading [rad]."""
    happened: tuple[tuple[float, float], ...] = ()
    """See `Run.happened`; free of the delay, as `measured`."""


@dataclass(frozen=True, slots=True)
class MatchedRun:
    """A run on common nodes: n steps, m legs."""

    record: AlignedRun
    rows: NDArray[np.intp]
    """Poses of the record at which legs begin and end, shape (m + 1,)."""
    measured: Reference
    """These poses."""
    gap: NDArray[np.bool_]
    """Legs that are gaps, as they overlap an excluded stretch; shape (m,)."""
    delay: float
    """Delay of the reference: what it stamps t was seen at t - delay [s]."""
    time: Floats
    """Stamps of the nodes, shape (n + 1,), [s]."""
    left: Floats
    """Counts of the left wheel in each step, shape (n,)."""
    right: Floats
    """Counts of the right wheel in each step, shape (n,)."""
    ends: NDArray[np.intp]
    """Nodes at which legs begin and end, shape (m + 1,)."""
    channels: Mapping[str, Span[Floats]]
    """Extra measured channels, at the start and end of each step."""

    @property
    def name(self) -> str:
        """Name of the run."""
        return self.record.name

    @property
    def counters(self) -> Counters:
        """Encoder counts."""
        return self.record.counters

    @property
    def sigma_xy(self) -> float | None:
        """Stated standard deviation of the reference's position [m]."""
        return self.record.sigma_xy

    @property
    def sigma_yaw(self) -> float | None:
        """Stated standard deviation of the reference's heading [rad]."""
        return self.record.sigma_yaw

    @property
    def intervals(self) -> Floats:
        """Reference intervals in each leg, shape (m,): each adds an incremental error."""
        return np.diff(self.rows).astype(np.float64)

    @property
    def stepped(self) -> NDArray[np.bool_]:
        """Legs with an abrupt event, whose end pose may therefore be anything; shape (m,)."""
        return touched(self.measured.time, self.record.happened)

    @property
    def legs(self) -> int:
        """Number of legs, including those marked as gaps."""
        return self.ends.size - 1


def at_edges(runs: Sequence[MatchedRun]) -> tuple[NDArray[np.bool_], ...]:
    """Legs of each run that a clock shift could move outside the ticks; all False if legs are few.

    Beyond the ends of the record the motion is unknown. If it begins or ends in motion, these legs
    would count against a delay even if that is true.
    """
    found = []
    for run in runs:
        first, last = run.counters.time[0], run.counters.time[-1]
        begin, end = run.measured.time[:-1], run.measured.time[1:]
        outside = (begin < first + EDGE) | (end > last - EDGE)
        found.append(outside if run.legs > EDGE_LEGS else np.zeros(run.legs, dtype=np.bool_))
    return tuple(found)


def match(
    run: Run,
    robot: Robot,
    leg: float = 1.0,
    limits: EncoderLimits | None = None,
    turn: float = QUARTER_TURN,
) -> MatchedRun:
    """Split the steps of a run at its reference poses and cut it into legs.

    Parameters
    ----------
    run : Run
        Recorded run.
    robot : Robot
        Robot whose travel decides where legs end; later fits do not move them.
    leg : float
        Length of a leg [m]. A leg spans at least one interval of the reference.
    limits : EncoderLimits, optional
        Limits of the encoder model.
    turn : float
        Turning on the spot that also makes a leg [rad]; path and turning add up.

    Raises
    ------
    InputError
        If the run has no reference, or none while ticks were recorded.
    """
    record = record_of(run, robot, limits, leg, turn)
    return divided(record, rows_of_legs(record, robot, leg, turn))


def match_for_fit(
    runs: Sequence[Run], robot: Robot, leg: float, limits: EncoderLimits | None = None
) -> list[MatchedRun]:
    """Cut runs into the short legs of a fit, given the leg length used for evaluation [m]."""
    records = (record_of(run, robot, limits, leg) for run in runs)
    return [cut_for_fit(record, robot, leg) for record in records]


def cut_for_fit(record: AlignedRun, robot: Robot, leg: float) -> MatchedRun:
    """Cut one record into the short legs of a fit."""
    parts = 1.0 / PARTS_OF_A_LEG
    record = replace(record, counters=record.counters.at_most(RATE_OF_FIT))
    return divided(record, rows_of_legs(record, robot, parts * leg, parts * QUARTER_TURN))


def every_pose(record: AlignedRun) -> MatchedRun:
    """Cut a record at every usable reference pose."""
    return divided(record, np.arange(record.measured.time.size))


def divided(record: AlignedRun, rows: NDArray[np.intp]) -> MatchedRun:
    """Cut a record at the given reference poses."""
    measured = _poses(record.measured, rows)
    time, left, right, ends, channels = nodes_at(record.counters, measured.time)
    gap = _gaps_between(record, rows)
    return MatchedRun(record, rows, measured, gap, record.delay, time, left, right, ends, channels)


def joined(run: MatchedRun, rows: NDArray[np.intp]) -> MatchedRun:
    """Merge legs: keep the nodes, with legs between the given poses only."""
    return replace(
        run,
        rows=rows,
        measured=_poses(run.record.measured, rows),
        gap=_gaps_between(run.record, rows),
        ends=run.ends[np.searchsorted(run.rows, rows)],
    )


def delayed(run: MatchedRun, delay: float) -> MatchedRun:
    """Same legs with a reference delay: what it stamps t was seen at t - `delay` [s]."""
    if delay == run.delay:
        return run
    counters = run.counters
    seen = run.measured.time + (run.record.delay - delay)
    seen = np.clip(seen, counters.time[0], counters.time[-1])
    time, left, right, ends, channels = nodes_at(counters, np.maximum.accumulate(seen))
    return replace(
        run, delay=delay, time=time, left=left, right=right, ends=ends, channels=channels
    )


def with_stated_noise(options: EvaluationOptions, runs: Sequence[MatchedRun]) -> EvaluationOptions:
    """Fill in the reference's noise from the records, if not given and all records state it.

    The noise stated by a localiser is that of its absolute pose, not of its increments.
    """
    if options.reference_kind == "local_map":
        return options
    return replace(
        options,
        sigma_xy=options.sigma_xy or _stated([run.sigma_xy for run in runs]),
        sigma_yaw=options.sigma_yaw or _stated([run.sigma_yaw for run in runs]),
    )


def _stated(values: Sequence[float | None]) -> float | None:
    known = [value for value in values if value is not None]
    return max(known) if known and len(known) == len(values) else None


def record_of(
    run: Run,
    robot: Robot,
    limits: EncoderLimits | None = None,
    leg: float = 1.0,
    turn: float = QUARTER_TURN,
) -> AlignedRun:
    """Put ticks and reference on one clock, and list the stretches to exclude.

    The clocks differ by the reference's delay of the robot file, if it has one.

    Parameters
    ----------
    run, robot, limits
        As for `match`.
    leg, turn : float
        Travel that makes a leg [m, rad]; gaps are measured in legs.

    Raises
    ------
    InputError
        As `match`.
    """
    run = looked_at(run, robot, limits)
    reference = run.reference
    if reference is None:
        raise InputError(
            f"{run.path}: there is no reference to compare with "
            "(reference.csv: t_s,x_m,y_m,yaw_rad)"
        )
    delay = clock_offset(robot)
    reference = reference.earlier(delay)
    happened, taken_out = (
        tuple((begin - delay, end - delay) for begin, end in parts)
        for parts in (run.happened, run.taken_out)
    )
    counters = counters_of(run, robot, limits)
    first, last = float(counters.time[0]), float(counters.time[-1])
    known = (np.isfinite(reference.x) & np.isfinite(reference.y)) | np.isfinite(reference.yaw)
    rows = usable_rows(reference.time, known, first, last)
    if rows.size < 2:
        raise InputError(
            f"{run.path}: fewer than two reference poses between the first tick "
            f"(t_s {first:g}) and the last ({last:g}); are both clocks the same?"
        )
    measured = _poses(reference, rows)
    found = _silences(run, robot, counters, measured.time, taken_out, leg, turn)
    return AlignedRun(
        run.name,
        counters,
        measured,
        delay,
        touched(measured.time, [*map(_surely_around, found), *taken_out]),
        found,
        _typical(reference.sigma_xy),
        _typical(reference.sigma_yaw),
        happened,
    )


def _surely_around(part: LeftOut) -> tuple[float, float]:
    """Stretch that no leg may touch, widened where its ends are only known to half a window."""
    unsure = NO_DRIVING_ENDS if part.why in ("held", "carried") else 0.0
    return part.begin - unsure, part.end + unsure


def _silences(
    run: Run,
    robot: Robot,
    counters: Counters,
    seen: Floats,
    taken_out: Sequence[tuple[float, float]],
    leg: float,
    turn: float,
) -> tuple[LeftOut, ...]:
    """Exclusions of a run: no driving, counter jumps, and gaps of ticks or reference."""
    way = counters.way(robot, leg, turn)
    parts = [("the reference is", seen, np.interp(seen, counters.time, way))]
    inside = (counters.time >= seen[0]) & (counters.time <= seen[-1])
    parts.append(("the ticks are", counters.time[inside], way[inside]))
    found, started = [], float(counters.time[0])
    for who, time, gone in parts:
        unheard = gaps_in(time, gone) & ~touched(time, taken_out)
        for index in np.flatnonzero(unheard).tolist():
            begin, end = float(time[index]), float(time[index + 1])
            driven = _driven(robot, counters, begin, end)
            words = f"{who} silent while {driven}"
            found.append(LeftOut(run.path, begin, end, "gap", words, started))
    others = [
        *(NoDriving(begin, end, "counter", words) for begin, end, words in counters.leaps),
        *(run.no_driving or ()),
    ]
    found += [
        LeftOut(run.path, *part, started)
        for part in others
        if part.end > seen[0] and part.begin < seen[-1]
    ]
    return tuple(sorted(found, key=lambda part: part.begin))


def _driven(robot: Robot, counters: Counters, begin: float, end: float) -> str:
    within = (counters.time > begin) & (counters.time < end)
    time = np.concatenate([[begin], counters.time[within], [end]])
    left, right = (np.diff(counters.at(time), axis=0) * [robot.left_tick, robot.right_tick]).T
    path = float(np.abs(0.5 * (left + right)).sum())
    turned = math.degrees(float(np.abs(right - left).sum()) / robot.track)
    words = [f"drove {path:.1f} m"] if path >= WAY_WORTH_SAYING else []
    words += [f"turned {turned:.0f}°"] if turned >= TURN_WORTH_SAYING or not words else []
    return f"the robot {' and '.join(words)}"


def usable_rows(
    time: Floats, known: NDArray[np.bool_], first: float, last: float
) -> NDArray[np.intp]:
    """Rows with a known value within the ticks' time span, in strictly ascending time.

    Parameters
    ----------
    time, known : ndarray, shape (r,)
        Time of each row of a reference [s], and whether it holds the wanted value.
    first, last : float
        Time of the first and the last tick [s].
    """
    within = known & (time >= first) & (time <= last)
    if within.sum() < FEW_POSES:
        # Few poses are start and end measured by tape: the robot stood still for a moment before
        # the first tick and after the last.
        within = known & (time >= first - MOMENT) & (time <= last + MOMENT)
    rows = np.flatnonzero(within)
    if rows.size == 0:
        return rows
    latest = np.maximum.accumulate(time[rows])
    later = np.concatenate([[True], time[rows][1:] > latest[:-1]])
    return np.asarray(rows[later])


def rows_of_legs(record: AlignedRun, robot: Robot, leg: float, turn: float) -> NDArray[np.intp]:
    """Poses of a record at which legs begin and end."""
    counters = record.counters
    way = np.interp(record.measured.time, counters.time, counters.way(robot, leg, turn))
    return leg_ends(way, record.gap)


def leg_ends(way: Floats, gap: NDArray[np.bool_], leg: float = 1.0) -> NDArray[np.intp]:
    """Rows at which legs begin and end: whenever one leg's worth of travel has accumulated.

    After a gap the count restarts; an incomplete leg before it is dropped.

    Parameters
    ----------
    way : ndarray, shape (r,)
        Cumulative travel at each row of the reference, in any unit.
    gap : ndarray of bool, shape (r - 1,)
        Intervals that no leg may span.
    leg : float
        Length of a leg in that unit.
    """
    gone = (way - way[0]) / leg
    rounding = ROUNDING * max(float(gone[-1]) * leg, 1.0) / leg
    begins = np.concatenate([[0], np.flatnonzero(gap) + 1])
    stretch = np.concatenate([[0], np.cumsum(gap)])
    gone = gone - gone[begins][stretch]
    done = np.floor(gone + rounding)  # whole legs so far; never a list of them, which could be huge
    new = (np.diff(done) > 0.0) & ~gap
    if new.any():
        return np.union1d(begins, np.flatnonzero(new) + 1)
    # A run shorter than a leg is one leg: its longest stretch.
    last = np.append(begins[1:] - 1, way.size - 1)
    longest = int(np.argmax(gone[last]))
    if last[longest] == begins[longest]:
        longest = int(np.argmax(last - begins))
    return np.union1d(begins, last[[longest]])


def legs_worth(path: float, turned: float, leg: float, turn: float) -> float:
    """Travel in legs: path and absolute turning add up."""
    return path / leg + turned / turn


def _gaps_between(record: AlignedRun, rows: NDArray[np.intp]) -> NDArray[np.bool_]:
    before = np.concatenate([[0], np.cumsum(record.gap)])
    return np.asarray(np.diff(before[rows]) > 0)


def _poses(reference: Reference, rows: NDArray[np.intp]) -> Reference:
    columns: list[Any] = [reference.time, reference.x, reference.y, reference.yaw]
    if rows.size < reference.time.size:
        columns = [part[rows] for part in columns]
    gyro = reference.gyro
    if gyro is not None:
        gyro = gyro._replace(turned=gyro.turned[rows])
    if reference.own_axes:  # stated per scan match; a localiser states its absolute error
        for sigma in (reference.sigma_xy, reference.sigma_yaw):
            columns.append(None if sigma is None else sigma[rows])
    return Reference(*columns, own_axes=reference.own_axes, gyro=gyro)


def _typical(sigma: Floats | None) -> float | None:
    """Root mean square of a stated noise; None if there is none."""
    if sigma is None or not np.isfinite(sigma).any():
        return None
    return float(np.sqrt(np.nanmean(np.square(sigma))))
