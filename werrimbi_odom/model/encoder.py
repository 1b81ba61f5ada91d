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
from math import isfinite
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.counter_wraps import wrapped
from werrimbi_odom.model.pace import USUAL_AT_FIRST, Pace
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

Counts = NDArray[np.float64] | NDArray[np.int64]

CLOCK_JUMP = 1.0
"""A stamp older than the last by more than this [s] is a clock set back, not a late message."""

RESOLUTION = 0.5e-9
"""Stamps count in nanoseconds; two that are closer than this [s] are one."""

LEARNED_MARGIN = 4.0
"""A wheel may go this many times faster than it did of late ..."""
LEARNED_FLOOR = 1.0
"""... or one turn a second, before a fall to zero is called a reset."""


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


class Reading(NamedTuple):
    """What one message says: stamp [s] and cumulative counts."""

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
    _last: Reading | None = None
    _doubted: Reading | None = None
    pace: Pace = field(default_factory=Pace)
    lasted: float = USUAL_AT_FIRST
    """Seconds over which the latest step was judged: its own, but where it came much too soon."""
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
        if not (isfinite(time) and isfinite(left) and isfinite(right)):
            self.tally.not_finite += 1
            return None
        reading = Reading(time, left, right)
        if self._doubted is not None and time == self._doubted.time:
            self.tally.duplicates += 1  # a doubted message does not confirm itself
            return None
        if self._last is None:
            self._last = reading
            self.tally.accepted += 1
            self.pace.begin(time)
            return None
        duration = time - self._last.time
        if duration <= RESOLUTION:
            if not self._goes_on(duration):
                return None
            duration = self.lasted
        return self._advance(reading, duration)

    def _goes_on(self, elapsed: float) -> bool:
        """Whether a message that is no later than the last one follows it all the same."""
        if elapsed >= -RESOLUTION:
            self.tally.duplicates += 1
        elif elapsed >= -CLOCK_JUMP:
            self.tally.out_of_order += 1
        else:
            self.tally.clock_jumps += 1
            return True
        return False

    def _advance(self, reading: Reading, duration: float) -> WheelStep | None:
        assert self._last is not None
        last, robot = self._last, self.robot
        left, right = reading.left - last.left, reading.right - last.right
        if robot.encoder_bits:
            left, right = self._unwrapped(left, right)
        lasted = self.pace.lasted(duration)
        if self._was_reset(reading, left, right, lasted):
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
        if robot.encoder_bits:
            self.tally.wraps += int(left != reading.left - last.left)
            self.tally.wraps += int(right != reading.right - last.right)
        if duration > self.limits.gap_duration:
            self.tally.gaps += 1
        self._accept(reading, duration)
        left_turns = abs(left) / robot.left_ticks_per_revolution
        right_turns = abs(right) / robot.right_ticks_per_revolution
        self.pace.see((left_turns if left_turns > right_turns else right_turns) / lasted)
        self.lasted = lasted
        left_travel, right_travel = left * robot.left_tick, right * robot.right_tick
        self._left_speed, self._right_speed = left_travel / lasted, right_travel / lasted
        return WheelStep(reading.time, duration, left_travel, right_travel)

    def _unwrapped(self, left: float, right: float) -> tuple[float, float]:
        return wrapped(left, self.robot.encoder_bits), wrapped(right, self.robot.encoder_bits)

    def _anchor_anew(self, reading: Reading, duration: float) -> WheelStep:
        lost_left, lost_right = self._left_speed * duration, self._right_speed * duration
        self._accept(reading, duration)
        return WheelStep(reading.time, duration, 0.0, 0.0, lost_left**2, lost_right**2)

    def _accept(self, reading: Reading, duration: float) -> None:
        assert self._last is not None
        if reading.time > self._last.time:
            self.pace.hear(reading.time, duration)
        else:
            self.pace.begin(reading.time)  # the clock was set back
        self._last, self._doubted = reading, None
        self.tally.accepted += 1

    def have_taken(
        self, durations: Floats, left: float, right: float, lasted: float, last: Reading
    ) -> None:
        """Go on behind steps that were taken together elsewhere, which `pace` has heard.

        Parameters
        ----------
        durations : ndarray, shape (n,)
            Of the steps [s].
        left, right, lasted : float
            Travel in the last of them [m], and the seconds to judge it over.
        last : Reading
            The reading they end with.
        """
        self._left_speed, self._right_speed, self.lasted = left / lasted, right / lasted, lasted
        self.tally.messages += durations.size
        self.tally.accepted += durations.size
        self.tally.gaps += int(np.count_nonzero(durations > self.limits.gap_duration))
        self._last, self._doubted = last, None

    def _exceeds(self, limit: float, start: Reading, end: Reading, duration: float) -> bool:
        robot = self.robot
        left = wrapped(end.left - start.left, robot.encoder_bits) * robot.left_tick
        right = wrapped(end.right - start.right, robot.encoder_bits) * robot.right_tick
        return max(abs(left), abs(right)) > limit * abs(duration)

    def _was_reset(self, reading: Reading, left: float, right: float, lasted: float) -> bool:
        assert self._last is not None
        last, robot = self._last, self.robot
        per_left, per_right = robot.left_ticks_per_revolution, robot.right_ticks_per_revolution
        rate = reach_rate(robot, self.limits, self.pace.fastest)
        reach = lasted * rate
        new_left, new_right = reading.left / per_left, reading.right / per_right
        if abs(new_left) > reach < abs(new_right):
            return False
        step_left, step_right = left / per_left, right / per_right
        if new_left == new_right == 0.0:
            far = max(abs(step_left), abs(step_right))
            if far > self.pace.usual * rate:
                return True
        return fell_to_zero(new_left, last.left / per_left, step_left, reach) or fell_to_zero(
            new_right, last.right / per_right, step_right, reach
        )


def fell_to_zero(new: float, old: float, step: float, reach: float) -> bool:
    """Whether a counter came to near zero further than a wheel can reach; all in turns."""
    return abs(new) <= reach and abs(old) > reach and abs(step) > reach


def reach_rate(robot: Robot, limits: EncoderLimits, fastest: float) -> float:
    """Fastest that a wheel is believed to turn [turns/s]."""
    if limits.max_wheel_speed > 0.0:
        return limits.max_wheel_speed / (2.0 * math.pi * robot.wheel_radius)
    return max(LEARNED_FLOOR, LEARNED_MARGIN * fastest)
