# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Ticks and reference put on one clock, with the stretches that no leg may span."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.run import NoDriving, Reference, Run
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.legs.count_interpolation import Counters, counters_of
from werrimbi_odom.inference.legs.gaps import LeftOut, gaps_in, touched
from werrimbi_odom.inference.legs.matched_run import AlignedRun, typical_sigma
from werrimbi_odom.inference.legs.stray_poses import stray_poses
from werrimbi_odom.inference.legs.usable_run import clock_offset, with_no_driving
from werrimbi_odom.inference.legs.windows import later_than_all_before
from werrimbi_odom.model.encoder_online import EncoderLimits
from werrimbi_odom.model.pose import Floats, wrap_all
from werrimbi_odom.model.robot import Robot


def record_of(
    run: Run,
    robot: Robot,
    limits: EncoderLimits | None = None,
    leg: float = 1.0,
    turn: float = rules.QUARTER_TURN,
    sizes: bool = True,
) -> AlignedRun:
    """Put ticks and reference on one clock, and list the stretches to exclude.

    The clocks differ by the reference's delay of the robot file, if it has one. `run`, `robot`,
    `limits`: as for `match`. `leg`, `turn`: travel that makes a leg [m, rad]; gaps are measured in
    legs. `sizes`: whether those of `robot` are known, and with them how far it went in a gap.
    InputError as `match`.
    """
    run = with_no_driving(run, robot, limits)
    reference = run.reference
    if reference is None:
        raise InputError(
            f"{run.path}: there is no reference to compare with "
            "(reference.csv: t_s,x_m,y_m,yaw_rad)"
        )
    delay = clock_offset(robot)
    reference = reference.earlier(delay)
    own = tuple(part for part in run.taken_out if part not in run.put_aside)
    happened, taken_out, lost = (
        tuple((begin - delay, end - delay) for begin, end in parts)
        for parts in (run.happened, run.taken_out, own)
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
    usable = reference.chosen(rows)
    # Scans state their noise per match; a localiser states its absolute error.
    measured = usable if usable.own_axes else replace(usable, sigma_xy=None, sigma_yaw=None)
    found = _silences(run, robot, counters, measured, taken_out, leg, turn, sizes)
    gap = touched(measured.time, [*map(_surely_around, found), *taken_out])
    return AlignedRun(
        run.name,
        counters,
        measured,
        delay,
        gap,
        stray_poses(measured, gap),
        found,
        typical_sigma(usable.sigma_xy),
        typical_sigma(usable.sigma_yaw),
        happened,
        run.at_rest,
        lost,
    )


def unmeasured(record: AlignedRun) -> tuple[tuple[float, float], ...]:
    """Stretches of the ticks in which no leg can be: beside the reference, and its gaps."""
    ticks, seen = record.counters.time, record.measured.time
    gaps = [(float(seen[row]), float(seen[row + 1])) for row in np.flatnonzero(record.gap)]
    return ((float(ticks[0]), float(seen[0])), *gaps, (float(seen[-1]), float(ticks[-1])))


def _surely_around(part: LeftOut) -> tuple[float, float]:
    """Stretch that no leg may touch, widened where its ends are only known to half a window."""
    unsure = rules.NO_DRIVING_ENDS if part.why in ("held", "carried") else 0.0
    return part.begin - unsure, part.end + unsure


def _silences(
    run: Run,
    robot: Robot,
    counters: Counters,
    measured: Reference,
    taken_out: Sequence[tuple[float, float]],
    leg: float,
    turn: float,
    sizes: bool,
) -> tuple[LeftOut, ...]:
    """Exclusions of a run: no driving, counter jumps, and gaps of ticks or reference."""
    way, seen = counters.way(robot, leg, turn), measured.time
    started = float(counters.time[0])
    inside = (counters.time >= seen[0]) & (counters.time <= seen[-1])

    unseen = gaps_in(seen, np.interp(seen, counters.time, way)) & ~touched(seen, taken_out)
    late = _caught_up(measured, leg, turn)
    ticked = counters.time[inside]
    # Of ticks nothing is taken out: a gap that goes on beside such a stretch is one.
    uncounted = gaps_in(ticked, way[inside]) & ~_within(ticked, taken_out)
    gaps = _named(
        [(float(seen[at]), float(seen[at + 1 + late[at]])) for at in np.flatnonzero(unseen)],
        [(float(ticked[at]), float(ticked[at + 1])) for at in np.flatnonzero(uncounted)],
    )
    leaps, found = set(counters.leaps), []
    for who, (begin, end) in gaps:
        anew = [leap for leap in leaps if begin <= leap[0] and leap[1] <= end]
        # What went unheard as a driver started anew is one event, and nobody counted the way.
        leaps.difference_update(anew)
        silent = f"{who} silent{' while the robot ' if not anew else ', and '}"
        way_there = _driven(robot, counters, begin, end) if sizes else "moved"
        words = silent + (" and ".join(leap[2] for leap in anew) or way_there)
        found.append(LeftOut(run.path, begin, end, "gap", words, started))
    others = [
        *(NoDriving(begin, end, "counter", words) for begin, end, words in leaps),
        *(run.no_driving or ()),
    ]
    found += [
        LeftOut(run.path, *part, started)
        for part in others
        if part.end > seen[0] and part.begin < seen[-1]
    ]
    return tuple(sorted(found, key=lambda part: part.begin))


def _within(time: Floats, stretches: Sequence[tuple[float, float]]) -> NDArray[np.bool_]:
    """Intervals between stamps (n,) that lie in a stretch as a whole, shape (n - 1,)."""
    found = np.zeros(max(time.size - 1, 0), dtype=np.bool_)
    for begin, end in stretches:
        found |= (time[:-1] >= begin) & (time[1:] <= end)
    return found


def _caught_up(measured: Reference, leg: float, turn: float) -> NDArray[np.bool_]:
    """After which intervals between poses the reference moves more than in them, shape (r - 1,).

    A silence ends with such a pose if a message waited in a stalled network: it was stamped as it
    came, and is of the silence's beginning.
    """
    ways = np.hypot(np.diff(measured.x), np.diff(measured.y)) / leg
    turns = np.abs(wrap_all(np.diff(measured.yaw))) / turn
    moved = np.nan_to_num(ways) + np.nan_to_num(turns)
    return np.append(moved[1:] > moved[:-1], False)


def _named(
    unseen: Sequence[tuple[float, float]], uncounted: Sequence[tuple[float, float]]
) -> list[tuple[str, tuple[float, float]]]:
    """Gaps of reference and ticks, and whose each is; a recorder that paused makes one of both."""
    begins = [begin for begin, _ in uncounted]
    found, of_both = [], set()
    for one in unseen:
        at = bisect_left(begins, 0.5 * sum(one)) - 1
        twin = uncounted[at] if at >= 0 else (one[0], one[0])
        if 0.5 * sum(one) < twin[1] and one[0] < 0.5 * sum(twin) < one[1]:
            of_both.add(twin)
            ends = min(one[0], twin[0]), max(one[1], twin[1])
            found.append(("reference and ticks are", ends))
        else:
            found.append(("the reference is", one))
    return found + [("the ticks are", gap) for gap in uncounted if gap not in of_both]


def _driven(robot: Robot, counters: Counters, begin: float, end: float) -> str:
    within = (counters.time > begin) & (counters.time < end)
    time = np.concatenate([[begin], counters.time[within], [end]])
    left, right = counters.travel(robot, time)
    path = float(np.abs(0.5 * (left + right)).sum())
    turned = math.degrees(float(np.abs(right - left).sum()) / robot.track)
    words = [f"drove {path:.1f} m"] if path >= rules.WAY_WORTH_SAYING else []
    words += [f"turned {turned:.0f}°"] if turned >= rules.TURN_WORTH_SAYING or not words else []
    return " and ".join(words)


def usable_rows(
    time: Floats, known: NDArray[np.bool_], first: float, last: float
) -> NDArray[np.intp]:
    """Rows with a known value within the ticks' time span, in strictly ascending time.

    `time`, `known` (r,): time of each row of a reference [s], and whether it holds the wanted
    value. `first`, `last`: time of the first and the last tick [s].
    """
    within = known & (time >= first) & (time <= last)
    if within.sum() < rules.FEW_POSES:
        # Few poses are start and end measured by tape: the robot stood still for a moment before
        # the first tick and after the last.
        within = known & (time >= first - rules.MOMENT) & (time <= last + rules.MOMENT)
    rows = np.flatnonzero(within)
    return np.asarray(rows[later_than_all_before(time[rows])])
