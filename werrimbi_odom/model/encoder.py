# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""From cumulative counters to wheel travel, through everything that happens to real counters.

Counters are cumulative, so a lost, doubled or late message loses no motion: the next good one holds
it all. What would make the pose jump is a counter that starts anew; see `Encoder` for how that is
told from motion.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields
from typing import Any, NamedTuple, overload

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

Counts = NDArray[np.float64] | NDArray[np.int64]

CLOCK_JUMP = 1.0
"""A stamp older than the last by more than this [s] is a clock set back, not a late message."""

_BLOCK = 8192  # rows of a record taken together: their arrays stay in the cache
_STRETCH = 256  # rows taken one by one where one was in doubt
_LARGEST_COUNT = 1 << 61  # integer counts from which rows are taken one by one

_LEARNED_MARGIN = 4.0  # a wheel may go this many times faster than it ever did ...
_LEARNED_FLOOR = 1.0  # ... or one turn a second, before a fall to zero is called a reset


@dataclass(slots=True)
class EncoderTally:
    """What happened to the messages so far; every one of them is counted once in `messages`."""

    messages: int = 0
    accepted: int = 0
    duplicates: int = 0
    out_of_order: int = 0
    not_finite: int = 0
    implausible: int = 0
    clock_jumps: int = 0
    gaps: int = 0
    wraps: int = 0
    resets: int = 0
    jumps: int = 0

    def as_dict(self) -> dict[str, int]:
        """Counts by name."""
        return {item.name: int(getattr(self, item.name)) for item in fields(self)}


@dataclass(frozen=True, slots=True)
class EncoderLimits:
    """When counters are doubted.

    Parameters
    ----------
    max_wheel_speed : float
        Fastest that a wheel can go [m/s]; 0 when unknown. Given, faster steps are refused until
        a second message confirms them. Unknown, nothing but a fall back to zero is doubted.
    gap_duration : float
        Intervals longer than this [s] are counted as gaps; their motion is kept.
    """

    max_wheel_speed: float = 0.0
    gap_duration: float = 1.0


class WheelStep(NamedTuple):
    """Travel between two accepted messages."""

    time: float
    """Stamp of the later message [s]."""
    duration: float
    """Seconds since the earlier one; greater than zero."""
    left: float
    """Signed travel of the left wheel [m]."""
    right: float
    """Signed travel of the right wheel [m]."""
    left_lost: float = 0.0
    """Variance of left travel that no counter saw [m²]; zero but for a reset."""
    right_lost: float = 0.0
    """Variance of right travel that no counter saw [m²]; zero but for a reset."""


class _Reading(NamedTuple):
    time: float
    left: float
    right: float


@dataclass(slots=True)
class Encoder:
    """Counters to wheel travel, a message at a time, in constant time and memory.

    A counter has been reset (a restarted driver) when it falls to near zero faster than its wheel
    can turn, or when both fall to exactly zero from further away than one message explains. The
    travel of that one interval is lost: it is taken as zero, with the last speed over the interval
    as its standard deviation, and counting goes on from the new reading.
    """

    robot: Robot
    limits: EncoderLimits = field(default_factory=EncoderLimits)
    tally: EncoderTally = field(default_factory=EncoderTally)
    _last: _Reading | None = None
    _doubted: _Reading | None = None
    _period: float = 0.0
    _fastest: float = 0.0
    _left_speed: float = 0.0
    _right_speed: float = 0.0

    def step(self, time: float, left: float, right: float) -> WheelStep | None:
        """Travel since the last accepted message.

        Parameters
        ----------
        time : float
            Stamp of the message [s].
        left, right : float or int
            Cumulative signed counts (whole or not; integers of any size stay exact).

        Returns
        -------
        WheelStep or None
            None for the first message and for one that is refused; `tally` says why.
        """
        self.tally.messages += 1
        if not (math.isfinite(time) and math.isfinite(left) and math.isfinite(right)):
            self.tally.not_finite += 1
            return None
        reading = _Reading(time, left, right)
        if self._doubted is not None and time == self._doubted.time:
            self.tally.duplicates += 1  # a doubted message does not confirm itself
            return None
        if self._last is None:
            self._last = reading
            self.tally.accepted += 1
            return None
        duration = self._duration(time - self._last.time)
        if duration is None:
            return None
        return self._advance(reading, duration)

    def _duration(self, elapsed: float) -> float | None:
        """Seconds to divide by, or None when the message does not follow the last one."""
        if elapsed > 0.0:
            return elapsed
        if elapsed == 0.0:
            self.tally.duplicates += 1
            return None
        if elapsed >= -CLOCK_JUMP:
            self.tally.out_of_order += 1
            return None
        self.tally.clock_jumps += 1
        return self._period or 1.0

    def _advance(self, reading: _Reading, duration: float) -> WheelStep | None:
        assert self._last is not None
        last, robot = self._last, self.robot
        left = wrapped(reading.left - last.left, robot.encoder_bits)
        right = wrapped(reading.right - last.right, robot.encoder_bits)
        if self._was_reset(reading, left, right, duration):
            self.tally.resets += 1
            return self._anchor_anew(reading, duration)
        limit = self.limits.max_wheel_speed
        if limit > 0.0 and self._exceeds(limit, last, reading, duration):
            if self._doubted is None or self._exceeds(
                limit, self._doubted, reading, reading.time - self._doubted.time
            ):
                self.tally.implausible += 1
                self._doubted = reading
                return None
            self.tally.jumps += 1
            return self._anchor_anew(reading, duration)
        self.tally.wraps += int(left != reading.left - last.left)
        self.tally.wraps += int(right != reading.right - last.right)
        self.tally.gaps += int(duration > self.limits.gap_duration)
        left_travel, right_travel = left * robot.left_tick, right * robot.right_tick
        self._left_speed, self._right_speed = left_travel / duration, right_travel / duration
        turns = max(
            abs(left) / robot.left_ticks_per_revolution,
            abs(right) / robot.right_ticks_per_revolution,
        )
        self._fastest = max(self._fastest, turns / duration)
        self._accept(reading, duration)
        return WheelStep(reading.time, duration, left_travel, right_travel)

    def _anchor_anew(self, reading: _Reading, duration: float) -> WheelStep:
        lost_left, lost_right = self._left_speed * duration, self._right_speed * duration
        self._accept(reading, duration)
        return WheelStep(reading.time, duration, 0.0, 0.0, lost_left**2, lost_right**2)

    def _accept(self, reading: _Reading, duration: float) -> None:
        self._last, self._doubted, self._period = reading, None, duration
        self.tally.accepted += 1

    def _have_taken(self, steps: _Part, last: _Reading, fastest: float) -> None:
        """Go on behind steps that were taken together; `last` is the reading they end with."""
        duration = float(steps.duration[-1])
        self._left_speed = float(steps.left[-1]) / duration
        self._right_speed = float(steps.right[-1]) / duration
        self._fastest = fastest
        self.tally.messages += steps.row.size
        self.tally.accepted += steps.row.size
        self.tally.gaps += int(np.count_nonzero(steps.duration > self.limits.gap_duration))
        self._last, self._doubted, self._period = last, None, duration

    def _exceeds(self, limit: float, start: _Reading, end: _Reading, duration: float) -> bool:
        robot = self.robot
        left = wrapped(end.left - start.left, robot.encoder_bits) * robot.left_tick
        right = wrapped(end.right - start.right, robot.encoder_bits) * robot.right_tick
        return max(abs(left), abs(right)) > limit * abs(duration)

    def _was_reset(self, reading: _Reading, left: float, right: float, duration: float) -> bool:
        assert self._last is not None
        last, robot = self._last, self.robot
        per_left, per_right = robot.left_ticks_per_revolution, robot.right_ticks_per_revolution
        usual = min(duration, self._period or duration)
        if reading.left == 0 and reading.right == 0:
            far = max(abs(left) / per_left, abs(right) / per_right)
            if far > self._reach(usual):
                return True
        reach = self._reach(duration)
        return fell_to_zero(
            reading.left / per_left, last.left / per_left, left / per_left, reach
        ) or fell_to_zero(
            reading.right / per_right, last.right / per_right, right / per_right, reach
        )

    def _reach(self, duration: float) -> float:
        """Turns that a wheel can have made in a time [s]."""
        return duration * _reach_rate(self.robot, self.limits, self._fastest)


def wrapped(difference: float, bits: int) -> float:
    """A difference of counts read from counters that wrap at `bits` (0: they do not)."""
    if bits == 0:
        return difference
    half = 1 << (bits - 1)
    if -half <= difference < half:
        return difference
    return (difference + half) % (2 * half) - half


@overload
def fell_to_zero(new: float, old: float, step: float, reach: float) -> bool: ...
@overload
def fell_to_zero(new: Floats, old: Floats, step: Floats, reach: Floats) -> NDArray[np.bool_]: ...
def fell_to_zero(new: Any, old: Any, step: Any, reach: Any) -> Any:
    """Whether a counter came to near zero further than a wheel can reach; all in turns."""
    return (abs(new) <= reach) & (abs(old) > reach) & (abs(step) > reach)


def _reach_rate(robot: Robot, limits: EncoderLimits, fastest: float) -> float:
    """Fastest that a wheel is believed to turn [turns/s]."""
    if limits.max_wheel_speed > 0.0:
        return limits.max_wheel_speed / (2.0 * math.pi * robot.wheel_radius)
    return max(_LEARNED_FLOOR, _LEARNED_MARGIN * fastest)


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

    def reading(self, row: int) -> _Reading:
        """One row in Python's numbers, whose integers are exact at any size."""
        return _Reading(self.time[row].item(), self.left[row].item(), self.right[row].item())

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
    rows = [np.empty(0, dtype=np.intp), *(part.row for part in parts)]
    columns = zip(*((none,) * 6, *(part[1:] for part in parts)), strict=True)
    return _Part(np.concatenate(rows), *(np.concatenate(column) for column in columns))


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
        left_count, left_wraps = _differences(left, robot.encoder_bits)
        right_count, right_wraps = _differences(right, robot.encoder_bits)
        left_turns, right_turns = left_count / per_left, right_count / per_right
        rate = np.maximum(np.abs(left_turns), np.abs(right_turns)) / duration
        fastest = np.maximum.accumulate(np.concatenate([[encoder._fastest], rate]))
        if limit > 0.0:
            reach = duration * _reach_rate(robot, limits, 0.0)
        else:
            reach = duration * np.maximum(_LEARNED_FLOOR, _LEARNED_MARGIN * fastest[:-1])
        left_travel, right_travel = left_count * robot.left_tick, right_count * robot.right_tick
        doubt = ~((duration > 0.0) & (duration < np.inf) & (rate < np.inf))
        doubt |= (left[1:] == 0) & (right[1:] == 0) & (rate > 0.0)
        for turns, steps in ((left / per_left, left_turns), (right / per_right, right_turns)):
            doubt |= fell_to_zero(turns[1:], turns[:-1], steps, reach)
        if limit > 0.0:
            doubt |= np.maximum(np.abs(left_travel), np.abs(right_travel)) > limit * duration
    count = int(doubt.argmax()) if doubt.any() else doubt.size
    part = _Part(
        np.arange(row, row + count),
        time[1 : count + 1],
        duration[:count],
        left_travel[:count],
        right_travel[:count],
        np.zeros(count),
        np.zeros(count),
    )
    if count:
        encoder.tally.wraps += int(np.count_nonzero(left_wraps[:count]))
        encoder.tally.wraps += int(np.count_nonzero(right_wraps[:count]))
        encoder._have_taken(part, record.reading(row + count - 1), float(fastest[count]))
    return part


def _differences(counts: Counts, bits: int) -> tuple[Floats, NDArray[np.bool_]]:
    """`wrapped` differences of consecutive counts, and where they wrapped."""
    steps = np.diff(counts)
    wraps = np.zeros(steps.shape, dtype=np.bool_)
    if bits > 0:
        half = 1 << (bits - 1)
        wraps = (steps < -half) | (steps >= half)
        if wraps.any():
            steps[wraps] = (steps[wraps] + half) % (2 * half) - half
    return steps.astype(np.float64, copy=False), wraps


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
