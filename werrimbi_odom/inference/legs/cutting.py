# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Cutting runs into legs: ticks and reference on common nodes, one leg per unit of travel.

No leg spans an excluded stretch (robot held or carried, gap in the reference or the ticks). The
interval from the last leg before such a stretch to its end is marked as a gap: fits and judgements
skip it, while state that accumulates along a run (distance, wheel angle, heading where only
positions are measured) continues through it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.legs.aligned_run import record_of
from werrimbi_odom.inference.legs.matched_run import AlignedRun, MatchedRun, divided
from werrimbi_odom.model.encoder_online import EncoderLimits
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

ROUNDING = 1e-12
"""Relative rounding error of sums over the steps of a drive."""


def match(
    run: Run,
    robot: Robot,
    leg: float = 1.0,
    limits: EncoderLimits | None = None,
    turn: float = rules.QUARTER_TURN,
) -> MatchedRun:
    """Split the steps of a run at its reference poses and cut it into legs.

    `run`: recorded run. `robot`: Robot whose travel decides where legs end; later fits do not move
    them. `leg`: length of a leg [m]. A leg spans at least one interval of the reference. `limits`:
    limits of the encoder model. `turn`: turning on the spot that also makes a leg [rad]; path and
    turning add up. InputError if the run has no reference, or none while ticks were recorded.
    """
    record = record_of(run, robot, limits, leg, turn)
    return divided(record, rows_of_legs(record, robot, leg, turn))


def match_for_fit(
    runs: Sequence[Run], robot: Robot, leg: float, limits: EncoderLimits | None = None
) -> list[MatchedRun]:
    """Cut runs into the short legs of a fit, given the leg length used for evaluation [m]."""
    records = (record_of(run, robot, limits, leg) for run in runs)
    return [cut_for_fit(record, robot, leg) for record in records]


def cut_for_fit(
    record: AlignedRun, robot: Robot, leg: float, parts: int = rules.PARTS_OF_A_LEG
) -> MatchedRun:
    """Cut one record into the short legs of a fit, so many to a leg that is judged."""
    record = replace(record, counters=record.counters.at_most(rules.RATE_OF_FIT))
    return divided(record, rows_of_legs(record, robot, leg / parts, rules.QUARTER_TURN / parts))


def every_pose(record: AlignedRun) -> MatchedRun:
    """Cut a record at every usable reference pose."""
    return divided(record, np.arange(record.measured.time.size))


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


def rows_of_legs(record: AlignedRun, robot: Robot, leg: float, turn: float) -> NDArray[np.intp]:
    """Poses of a record at which legs begin and end."""
    counters = record.counters
    way = np.interp(record.measured.time, counters.time, counters.way(robot, leg, turn))
    return ends_in(record, way)


def ends_in(record: AlignedRun, way: Floats, leg: float = 1.0) -> NDArray[np.intp]:
    """Poses of a record at which legs begin and end, by the travel at each pose (`leg_ends`).

    Where that pose is a stray one, the next that is none.
    """
    rows = np.where(record.stray, way.size, np.arange(way.size))
    sound = np.minimum.accumulate(rows[::-1])[::-1]
    return np.unique(sound[leg_ends(way, record.gap, leg)])


def leg_ends(way: Floats, gap: NDArray[np.bool_], leg: float = 1.0) -> NDArray[np.intp]:
    """Rows at which legs begin and end: whenever one leg's worth of travel has accumulated.

    After a gap the count restarts; an incomplete leg before it is dropped. `way` (r,): cumulative
    travel at each row of the reference, in any unit. `gap` (r - 1,): intervals that no leg may
    span. `leg`: length of a leg in that unit.
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
