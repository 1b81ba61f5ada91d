# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Counters of a whole record to wheel travel: what `Encoder` does row by row, in arrays."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.compiled import compiled_for
from werrimbi_odom.model.counter_wraps import differences
from werrimbi_odom.model.encoder import (
    RESOLUTION,
    Counts,
    Encoder,
    EncoderLimits,
    EncoderTally,
    Reading,
    reach_rate,
)
from werrimbi_odom.model.motion import WheelTravel
from werrimbi_odom.model.pace import CLOSE, PAUSE
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.scalar_loop import Heard, read_on

_BLOCK = 8192  # rows of a record taken together: their arrays stay in the cache
_STRETCH = 256  # rows taken one by one where one was in doubt
_LARGEST_COUNT = 1 << 61  # integer counts from which rows are taken one by one


@dataclass(frozen=True, slots=True)
class WheelSteps:
    """The accepted steps of a recorded run; arrays of shape (n,), as in `WheelStep`.

    `row` is the row of the record at which each step ends; `first_row` the one at which the first
    begins (-1 when no row was accepted).
    """

    first_row: int
    row: NDArray[np.intp]
    time: Floats
    duration: Floats
    left: Floats
    right: Floats
    left_lost: Floats
    right_lost: Floats
    tally: EncoderTally


def lost_travel(steps: WheelSteps) -> dict[int, WheelTravel[float]]:
    """Variances of travel that no counter saw [m²], by the step that it was lost in."""
    where = np.flatnonzero((steps.left_lost > 0.0) | (steps.right_lost > 0.0))
    left, right = steps.left_lost[where].tolist(), steps.right_lost[where].tolist()
    return dict(zip(where.tolist(), map(WheelTravel, left, right), strict=True))


def wheel_steps(
    robot: Robot,
    time: Floats,
    left: Counts,
    right: Counts,
    limits: EncoderLimits | None = None,
) -> WheelSteps:
    """All steps of a record at once; the same as feeding its rows to an `Encoder`.

    Rows that leave no doubt are taken together, in array operations; from one that does, the
    `Encoder` goes on by itself for a stretch.

    Parameters
    ----------
    time : ndarray, shape (n,), [s]
    left, right : ndarray, shape (n,)
        Cumulative signed counts, integer or float.
    """
    encoder = Encoder(robot, limits or EncoderLimits())
    record = _Record(np.asarray(time, dtype=np.float64), _as_counts(left), _as_counts(right))
    machine = None if record.is_huge else compiled_for(record.rows, read_on)
    found = _Found.of(record.rows)
    row = 0
    while row < record.rows:
        row = _judged_steps(encoder, record, found, row)
        quiet = row < record.rows
        while quiet:
            before = row
            if machine is None:
                row = _quiet_steps(encoder, record, found, row)
                quiet = row - before == _BLOCK
            else:
                row, quiet = _read_on(machine, encoder, record, found, row), False
    return found.steps(record, encoder.tally)


class _Record(NamedTuple):
    time: Floats
    left: Counts
    right: Counts

    @property
    def rows(self) -> int:
        return self.time.size

    @property
    def is_huge(self) -> bool:
        """Whether differences of integer counts could leave their 64 bits."""
        return _is_huge(self.left) or _is_huge(self.right)

    def reading(self, row: int) -> Reading:
        """One row in Python's numbers, whose integers are exact at any size."""
        return Reading(self.time[row].item(), self.left[row].item(), self.right[row].item())

    def first_row(self) -> int:
        """The first row of finite numbers, -1 when there is none."""
        rows = range(self.rows)
        return next((row for row in rows if all(map(math.isfinite, self.reading(row)))), -1)


class _Found(NamedTuple):
    """The steps that were found, at the rows of the record at which they end."""

    taken: NDArray[np.bool_]
    columns: Floats
    """Duration, and travel of the wheels, shape (3, rows)."""
    lost: dict[int, tuple[float, float]]
    """Variances of travel that no counter saw [m²], by the row."""

    @classmethod
    def of(cls, rows: int) -> _Found:
        """None yet."""
        return cls(np.zeros(rows, dtype=np.bool_), np.empty((3, rows)), {})

    def steps(self, record: _Record, tally: EncoderTally) -> WheelSteps:
        """All of them; where no row in between was refused, without a copy."""
        rows = np.flatnonzero(self.taken)
        whole = rows.size > 0 and rows.size == rows[-1] - rows[0] + 1
        at = slice(int(rows[0]), int(rows[-1]) + 1) if whole else rows
        left_lost, right_lost = np.zeros((2, rows.size))
        for row, (left, right) in self.lost.items():
            place = np.searchsorted(rows, row)
            left_lost[place], right_lost[place] = left, right
        duration, left, right = (column[at] for column in self.columns)
        return WheelSteps(
            record.first_row(),
            rows,
            record.time[at],
            duration,
            left,
            right,
            left_lost,
            right_lost,
            tally,
        )


def _judged_steps(encoder: Encoder, record: _Record, found: _Found, row: int) -> int:
    """A stretch from `row` on, one by one; the row after it, which follows an accepted one."""
    least = row + _STRETCH
    accepted = False
    while row < record.rows and not (accepted and row >= least):
        before = encoder.tally.accepted
        step = encoder.step(*record.reading(row))
        accepted = encoder.tally.accepted > before
        if step is not None:
            found.taken[row] = True
            found.columns[:, row] = step.duration, step.left, step.right
            if step.left_lost > 0.0 or step.right_lost > 0.0:
                found.lost[row] = step.left_lost, step.right_lost
        row += 1
    return row


def _read_on(
    machine: Callable[..., tuple[int, Heard, float]],
    encoder: Encoder,
    record: _Record,
    found: _Found,
    row: int,
) -> int:
    """The same as `_quiet_steps` by machine code of `read_on`, and however many they are."""
    pace = encoder.pace
    heard = Heard(pace.usual, *pace.speeds())
    end, heard, lasted = machine(
        encoder.rule, *record, row, pace.stamps(), heard, encoder.lasted, found.columns
    )
    if end > row:
        pace.have_seen(record.time[row:end], *heard)
        _take(encoder, record, found, slice(row, end), lasted)
    return end


def _take(encoder: Encoder, record: _Record, found: _Found, rows: slice, lasted: float) -> None:
    """Let the encoder stand as if it had taken some rows itself; their columns are written."""
    found.taken[rows] = True
    durations, left, right = found.columns[:, rows]
    last = record.reading(rows.stop - 1)
    encoder.have_taken(durations, float(left[-1]), float(right[-1]), lasted, last)


def _quiet_steps(encoder: Encoder, record: _Record, found: _Found, row: int) -> int:
    """Take the rows from `row` on that leave no doubt, a block at the most; the row after them.

    The row before must be the last one that `encoder` accepted; afterwards it stands as if it had
    taken these steps itself.
    """
    robot, limits = encoder.robot, encoder.limits
    rows = slice(row - 1, row + _BLOCK)
    time, left, right = record.time[rows], record.left[rows], record.right[rows]
    if _is_huge(left) or _is_huge(right):
        return row
    per_left, per_right = robot.left_ticks_per_revolution, robot.right_ticks_per_revolution
    limit = limits.max_wheel_speed
    with np.errstate(all="ignore"):  # numbers that are not finite are in doubt, and so not used
        duration = np.diff(time)
        left_count, left_wraps = differences(left, robot.encoder_bits)
        right_count, right_wraps = differences(right, robot.encoder_bits)
        left_turns, right_turns = left_count / per_left, right_count / per_right
        usual = encoder.pace.usual_at(time[1:])
        lasted = np.where(duration >= CLOSE * usual[:-1], duration, usual[:-1])
        rate = np.maximum(np.abs(left_turns), np.abs(right_turns)) / lasted
        left_travel, right_travel = left_count * robot.left_tick, right_count * robot.right_tick
        doubt = ~((duration > RESOLUTION) & (duration <= PAUSE) & (rate < np.inf))
        doubt |= (left[1:] == 0) & (right[1:] == 0) & (rate > 0.0)
        # Beyond the least, and not beyond the most, that a wheel may be believed to reach.
        fastest = max(encoder.pace.fastest, float(rate.max(initial=0.0, where=~doubt)))
        least, most = (lasted * reach_rate(encoder.rule, each) for each in (0.0, fastest))
        for now, steps in ((left / per_left, left_turns), (right / per_right, right_turns)):
            doubt |= (np.abs(now[1:]) <= most) & (np.abs(steps) > least)
        if limit > 0.0:
            doubt |= np.maximum(np.abs(left_travel), np.abs(right_travel)) > limit * duration
    count = int(doubt.argmax()) if doubt.any() else doubt.size
    if not count:
        return row
    encoder.tally.wraps += int(np.count_nonzero(left_wraps[:count]))
    encoder.tally.wraps += int(np.count_nonzero(right_wraps[:count]))
    encoder.pace.have_heard(time[1 : count + 1], usual[count], rate[:count])
    some = slice(row, row + count)
    for column, part in zip(found.columns, (duration, left_travel, right_travel), strict=True):
        column[some] = part[:count]
    _take(encoder, record, found, some, float(lasted[count - 1]))
    return row + count


def _is_huge(counts: Counts) -> bool:
    """Whether differences of integer counts could leave their 64 bits."""
    return counts.dtype.kind == "i" and bool(
        counts.max() >= _LARGEST_COUNT or counts.min() <= -_LARGEST_COUNT
    )


def _as_counts(counts: Counts) -> Counts:
    """Integers of any kind as 64 bits, everything else as floats."""
    if counts.dtype.kind in "iub":
        return counts.astype(np.int64, copy=False)
    return counts.astype(np.float64, copy=False)
