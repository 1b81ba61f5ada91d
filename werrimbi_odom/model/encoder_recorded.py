# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Counters of a whole record to wheel travel: the result of `Encoder`, in array operations."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.compiled import compiled_for
from werrimbi_odom.model.counter_wraps import differences
from werrimbi_odom.model.encoder_online import Counts, Encoder, EncoderLimits, EncoderTally
from werrimbi_odom.model.motion import WheelTravel
from werrimbi_odom.model.pace import CLOSE, PAUSE
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.reading_checks import RESOLUTION, Reading, reach_rate
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.scalar_loop import Heard, read_on

_BLOCK = 8192  # rows of a record processed together: their arrays stay in the cache
_STRETCH = 256  # rows processed one by one from a doubtful one on
_LARGEST_COUNT = 1 << 61  # size of integer counts from which rows are processed one by one


@dataclass(frozen=True, slots=True)
class WheelSteps:
    """The accepted steps of a recorded run; arrays of shape (n,), as in `WheelStep`.

    `row` is the row of the record at which each step ends; `first_row` the row at which the first
    step begins (-1 if no row was accepted).
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
    """Variances of travel that no counter saw [m²], by the step in which it was lost."""
    where = np.flatnonzero((steps.left_lost > 0.0) | (steps.right_lost > 0.0))
    left, right = steps.left_lost[where].tolist(), steps.right_lost[where].tolist()
    return dict(zip(where.tolist(), map(WheelTravel, left, right), strict=True))


def wheel_steps(
    robot: Robot, time: Floats, left: Counts, right: Counts, limits: EncoderLimits | None = None
) -> WheelSteps:
    """Compute all steps of a record at once; the same as passing its rows to an `Encoder`.

    Rows that pass all checks are processed together in array operations. From a doubtful row on,
    the `Encoder` processes a number of rows one by one. `time` (n,) [s]. `left`, `right` (n,):
    cumulative signed counts, integer or float.
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
        """Whether differences of integer counts could exceed 64 bits."""
        return _is_huge(self.left) or _is_huge(self.right)

    def reading(self, row: int) -> Reading:
        """Return one row as Python numbers; its integers are exact at any size."""
        return Reading(self.time[row].item(), self.left[row].item(), self.right[row].item())

    def first_row(self) -> int:
        """First row of finite numbers, -1 if there is none."""
        rows = range(self.rows)
        return next((row for row in rows if all(map(math.isfinite, self.reading(row)))), -1)


class _Found(NamedTuple):
    """The accepted steps, stored at the row of the record at which each ends."""

    taken: NDArray[np.bool_]
    columns: Floats
    """Duration, and travel of the two wheels, shape (3, rows)."""
    lost: dict[int, tuple[float, float]]
    """Variances of travel that no counter saw [m²], by the row."""

    @classmethod
    def of(cls, rows: int) -> _Found:
        """Create an empty store."""
        return cls(np.zeros(rows, dtype=np.bool_), np.empty((3, rows)), {})

    def steps(self, record: _Record, tally: EncoderTally) -> WheelSteps:
        """Collect all steps; without a copy if no row in between was rejected."""
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
    """Process rows from `row` on one by one; return the next row, which follows an accepted one."""
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
    """`_quiet_steps` with the compiled `read_on`, without a limit on the number of rows."""
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
    """Update the encoder's state as if it had processed these rows; their columns are written."""
    found.taken[rows] = True
    durations, left, right = found.columns[:, rows]
    last = record.reading(rows.stop - 1)
    encoder.have_taken(durations, float(left[-1]), float(right[-1]), lasted, last)


def _quiet_steps(encoder: Encoder, record: _Record, found: _Found, row: int) -> int:
    """Process the rows from `row` on that pass all checks, at most a block; return the next row.

    The previous row must be the last that `encoder` accepted. Its state is then as if it had
    processed the rows itself.
    """
    robot, limits = encoder.robot, encoder.limits
    rows = slice(row - 1, row + _BLOCK)
    time, left, right = record.time[rows], record.left[rows], record.right[rows]
    if _is_huge(left) or _is_huge(right):
        return row
    per_left, per_right = robot.left_ticks_per_revolution, robot.right_ticks_per_revolution
    limit = limits.max_wheel_speed
    with np.errstate(all="ignore"):  # numbers that are not finite count as doubtful
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
        # Doubtful: a step beyond the least reach of a wheel, to a reading within its greatest reach
        # of zero.
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
    """Whether differences of integer counts could exceed 64 bits."""
    return counts.dtype.kind == "i" and bool(
        np.any((counts >= _LARGEST_COUNT) | (counts <= -_LARGEST_COUNT))
    )


def _as_counts(counts: Counts) -> Counts:
    """Convert integers of any kind to 64 bits, everything else to floats."""
    if counts.dtype.kind in "iub":
        return counts.astype(np.int64, copy=False)
    return counts.astype(np.float64, copy=False)
