# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Counters of a whole record to wheel travel: what `Encoder` does row by row, in arrays."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.counter_wraps import differences
from werrimbi_odom.model.encoder import (
    RESOLUTION,
    Counts,
    Encoder,
    EncoderLimits,
    EncoderTally,
    Reading,
    WheelStep,
    reach_rate,
)
from werrimbi_odom.model.motion import WheelTravel
from werrimbi_odom.model.pace import CLOSE, PAUSE
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

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
    parts: list[_Part] = []
    row = 0
    while row < record.rows:
        part, row = _judged_steps(encoder, record, row)
        parts.append(part)
        quiet = row < record.rows
        while quiet:
            part = _quiet_steps(encoder, record, row)
            parts.append(part)
            row += part.row.size
            quiet = part.row.size == _BLOCK
    return WheelSteps(record.first_row(), *_joined(parts), encoder.tally)


class _Record(NamedTuple):
    time: Floats
    left: Counts
    right: Counts

    @property
    def rows(self) -> int:
        return self.time.size

    def reading(self, row: int) -> Reading:
        """One row in Python's numbers, whose integers are exact at any size."""
        return Reading(self.time[row].item(), self.left[row].item(), self.right[row].item())

    def first_row(self) -> int:
        """The first row of finite numbers, -1 when there is none."""
        rows = range(self.rows)
        return next((row for row in rows if all(map(math.isfinite, self.reading(row)))), -1)


class _Part(NamedTuple):
    """Some steps of a record: the arrays of `WheelSteps`."""

    row: NDArray[np.intp]
    time: Floats
    duration: Floats
    left: Floats
    right: Floats
    left_lost: Floats
    right_lost: Floats


def _joined(parts: list[_Part]) -> _Part:
    none = np.empty(0)
    rows = np.concatenate([np.empty(0, dtype=np.intp), *(part.row for part in parts)])
    columns = zip(*((none,) * 4, *(part[1:5] for part in parts)), strict=True)
    lost = _no_loss(rows.size)  # memory that nobody writes to is none, and few parts lose anything
    begin = 0
    for part in parts:
        for whole, some in zip(lost, part[5:], strict=True):
            if some.any():
                whole[begin : begin + some.size] = some
        begin += part.row.size
    time, duration, left, right = (np.concatenate(column) for column in columns)
    return _Part(rows, time, duration, left, right, *lost)


def _no_loss(count: int) -> tuple[Floats, Floats]:
    return np.zeros(count), np.zeros(count)


def _judged_steps(encoder: Encoder, record: _Record, row: int) -> tuple[_Part, int]:
    """A stretch from `row` on, one by one; and the row after it, which follows an accepted one."""
    rows: list[int] = []
    steps: list[WheelStep] = []
    least = row + _STRETCH
    accepted = False
    while row < record.rows and not (accepted and row >= least):
        before = encoder.tally.accepted
        step = encoder.step(*record.reading(row))
        accepted = encoder.tally.accepted > before
        if step is not None:
            rows.append(row)
            steps.append(step)
        row += 1
    columns = np.array(steps, dtype=np.float64).reshape(-1, len(WheelStep._fields)).T
    return _Part(np.array(rows, dtype=np.intp), *columns), row


def _quiet_steps(encoder: Encoder, record: _Record, row: int) -> _Part:
    """Steps to the rows from `row` on that leave no doubt, a block at the most.

    The row before must be the last one that `encoder` accepted; afterwards it stands as if it had
    taken these steps itself.
    """
    robot, limits = encoder.robot, encoder.limits
    rows = slice(row - 1, row + _BLOCK)
    time, left, right = record.time[rows], record.left[rows], record.right[rows]
    if _is_huge(left) or _is_huge(right):
        return _joined([])
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
        least, most = (lasted * reach_rate(robot, limits, each) for each in (0.0, fastest))
        for now, steps in ((left / per_left, left_turns), (right / per_right, right_turns)):
            doubt |= (np.abs(now[1:]) <= most) & (np.abs(steps) > least)
        if limit > 0.0:
            doubt |= np.maximum(np.abs(left_travel), np.abs(right_travel)) > limit * duration
    count = int(doubt.argmax()) if doubt.any() else doubt.size
    part = _Part(
        np.arange(row, row + count),
        time[1 : count + 1],
        duration[:count],
        left_travel[:count],
        right_travel[:count],
        *_no_loss(count),
    )
    if count:
        encoder.tally.wraps += int(np.count_nonzero(left_wraps[:count]))
        encoder.tally.wraps += int(np.count_nonzero(right_wraps[:count]))
        encoder.pace.have_heard(part.time, usual[count], rate[:count])
        encoder.have_taken(
            part.duration,
            float(part.left[-1]),
            float(part.right[-1]),
            float(lasted[count - 1]),
            record.reading(row + count - 1),
        )
    return part


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
