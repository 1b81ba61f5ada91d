# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Poses that repeat the one before while the wheels turn: held from an earlier reading."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.run import Reference, Run
from werrimbi_odom.model.pose import Floats, wrap_all
from werrimbi_odom.model.robot import Robot

QUANTA = 3.0
"""Motion that must change the pose, in steps of the reference's resolution."""

FEWEST = 20
"""Number of poses for this test. Fewer poses are manual measurements, and an equal pose may be
real: a robot driven back to its mark."""

LEAST_TRAVEL, LEAST_TURN = 0.01, 0.02
"""Motion that must change the pose [m, rad]; a measurement may stick for some millimetres."""

CHANGES_ALONE = 0.8
"""Share of a part's changes between two repetitions above which it was held from reading to
reading. Chosen: a held value changes alone unless two readings come in neighbouring rows."""

ROLLS = 0.01
"""Share of these, in the interval of the last new pose, above which the robot was moving."""


def without_held_poses(run: Run, robot: Robot) -> Run:
    """Remove poses that repeat while the wheels turn.

    For references with independent poses only. For an incremental one, an equal pose means a missed
    motion.
    """
    if run.reference is None:
        return run
    held = held_poses(run, robot)
    if not held.any():
        return run
    return replace(run, reference=run.reference.chosen(~held), held_poses=int(held.sum()))


def these_runs(runs: Sequence[Run]) -> str:
    """The first of some runs, and how many more."""
    return f"{runs[0].path}{'' if len(runs) == 1 else f' and {len(runs) - 1} more'}"


def words_about_held(runs: Sequence[Run]) -> str | None:
    """Description of the removed poses; None if there are none."""
    some = [run for run in runs if run.held_poses]
    if not some:
        return None
    count = sum(run.held_poses for run in some)
    there = sum(0 if run.reference is None else run.reference.time.size for run in some)
    return (
        f"{these_runs(some)}: {count} of "
        f"{count + there} reference poses repeat the one before to the last digit, in position or "
        "heading, while the wheels turn; they are taken for held, not measured, and left out"
    )


def held_poses(run: Run, robot: Robot) -> NDArray[np.bool_]:
    """Poses of a run's reference that were held, shape (m,): whole, or their slower part.

    The wheels must have turned when the pose was new. A delayed reference shows the robot at rest,
    also for a while after it starts to move.
    """
    reference = run.reference
    assert reference is not None
    count = reference.time.size
    if count < FEWEST:
        return np.zeros(count, dtype=np.bool_)
    place, heading = _repeats(reference.x, reference.y), _repeats(reference.yaw)
    along, turn = _driven(run, robot, reference.time)
    travelled = _Motion(
        along,
        max(QUANTA * _quantum(reference.x, reference.y), LEAST_TRAVEL),
        ROLLS * LEAST_TRAVEL,
        reference.has_position,
    )
    turned = _Motion(
        turn,
        max(QUANTA * _quantum(reference.yaw), LEAST_TURN),
        ROLLS * LEAST_TURN,
        reference.has_yaw,
    )
    motions = (travelled, turned)
    # A log with a row for each message of the fastest sensor repeats the last values of the slower
    # ones. A pose is whole where the slowest is new, also at rest and while the robot sets off.
    slow = [
        repeats
        for repeats in (place, heading)
        if _changes_alone(repeats) and _held(repeats, motions).any()
    ]
    return max([_held(place & heading, motions), *slow], key=np.count_nonzero)


class _Motion(NamedTuple):
    """Motion by the counters that must show in a part of the pose."""

    amount: Floats
    """At each row of the reference, shape (m,)."""
    least: float
    """Amount that must change the values."""
    rolls: float
    """Amount in the interval of a new value, above which the robot was moving."""
    measured: NDArray[np.bool_]


def _repeats(*columns: Floats) -> NDArray[np.bool_]:
    """Rows whose values all equal those of the row before."""
    repeats = np.zeros(columns[0].size, dtype=np.bool_)
    repeats[1:] = np.all([_equal(part[1:], part[:-1]) for part in columns], axis=0)
    return repeats


def _held(repeats: NDArray[np.bool_], motions: Sequence[_Motion]) -> NDArray[np.bool_]:
    """Rows that repeat although one of the motions must have changed them."""
    rows = np.arange(repeats.size)
    first = np.maximum.accumulate(np.where(repeats, 0, rows))
    moved = np.zeros(repeats.size, dtype=np.bool_)
    with np.errstate(invalid="ignore"):
        for amount, least, rolls, measured in motions:
            moving = np.abs(np.diff(amount, prepend=np.nan)) > rolls
            moved |= (np.abs(amount - amount[first]) > least) & moving[first] & measured
    since = np.maximum.accumulate(np.where(repeats & moved, rows, -1))
    return np.asarray(repeats & (since > first))  # the robot may return to the held pose


def _changes_alone(repeats: NDArray[np.bool_]) -> bool:
    """Whether values change in single rows, between rows that repeat.

    A robot without noise repeats its heading too, on a straight line, and then changes it in one
    row after the other.
    """
    new = ~repeats[1:-1]
    alone = new & repeats[:-2] & repeats[2:]
    return bool(new.sum() >= FEWEST and alone.sum() > CHANGES_ALONE * new.sum())


def _driven(run: Run, robot: Robot, time: Floats) -> tuple[Floats, Floats]:
    """Path [m] and turn [rad] by the counters at some instants; NaN outside their range."""
    ticks = run.ticks.unwrapped(robot.encoder_bits)
    stamps = np.maximum.accumulate(ticks.time)
    left, right = (
        np.interp(time, stamps, counts.astype(np.float64) * size, left=np.nan, right=np.nan)
        for counts, size in ((ticks.left, robot.left_tick), (ticks.right, robot.right_tick))
    )
    if _one_is_reversed(run.reference, left, right):
        left = -left
    return 0.5 * (left + right), (right - left) / robot.track


def _one_is_reversed(reference: Reference | None, left: Floats, right: Floats) -> bool:
    """Whether one counter has the wrong sign: by headings, else by ways. A line looks like a spin.

    `left`, `right` (m,): travel at the poses.
    """
    if reference is None:
        return False
    turn, along = np.diff(right - left), np.diff(right + left)
    if reference.has_yaw.any():
        seen, of_turn, of_way = wrap_all(np.diff(reference.yaw)), turn, along
    else:
        seen = np.hypot(np.diff(reference.x), np.diff(reference.y))
        of_turn, of_way = np.abs(along), np.abs(turn)
    known = np.isfinite(seen) & np.isfinite(turn) & (seen != 0.0)
    if known.sum() < FEWEST:
        return False
    right_so, wrong_so = (
        abs(seen[known] @ part[known]) / max(float(np.linalg.norm(part[known])), 1e-12)
        for part in (of_turn, of_way)
    )
    return bool(wrong_so > right_so)


def _equal(one: Floats, other: Floats) -> NDArray[np.bool_]:
    return np.asarray((one == other) | (np.isnan(one) & np.isnan(other)))


def _quantum(*columns: Floats) -> float:
    """Smallest non-zero step of some values; 0 if there is none."""
    steps = np.abs(np.concatenate([np.diff(column) for column in columns]))
    steps = steps[steps > 0.0]
    return float(steps.min()) if steps.size else 0.0
