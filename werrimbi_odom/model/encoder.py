# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""From cumulative counters to wheel travel, with the faults of real counters handled.

Counters are cumulative, so a lost, doubled or late message loses no motion: the next good one
contains it all. Only a counter reset would make the pose jump; `Encoder` describes how a reset is
distinguished from motion.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields
from math import isfinite
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.counter_wraps import wrapped
from werrimbi_odom.model.pace import PAUSE, USUAL_AT_FIRST, Pace, lasted_over
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

Counts = NDArray[np.float64] | NDArray[np.int64]

CLOCK_JUMP = 1.0
"""A stamp older than the last by more than this [s] is a clock set back, not a late message."""

RESOLUTION = 0.5e-9
"""Stamps have a resolution of nanoseconds; two that are closer than this [s] are equal."""

LEARNED_MARGIN = 4.0
"""Without a known top speed, a wheel may go this many times faster than it did recently ..."""
LEARNED_FLOOR = 1.0
"""... or one turn a second, before a fall to zero is taken as a reset."""


@dataclass(slots=True)
class EncoderTally:
    """Counts of message faults so far; `messages` counts every message once."""

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
    """When counter readings are rejected.

    Parameters
    ----------
    max_wheel_speed : float
        Fastest possible wheel speed [m/s]; 0 if unknown. If given, faster steps are rejected until
        a second message confirms them. If unknown, only a fall to zero is checked.
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
    """Time since the earlier message [s]; greater than zero."""
    left: float
    """Signed travel of the left wheel [m]."""
    right: float
    """Signed travel of the right wheel [m]."""
    left_lost: float = 0.0
    """Variance of left travel that no counter saw [m²]; zero except after a reset."""
    right_lost: float = 0.0
    """Variance of right travel that no counter saw [m²]; zero except after a reset."""


class Reading(NamedTuple):
    """Content of one message: stamp [s] and cumulative counts."""

    time: float
    left: float
    right: float


class CountRule(NamedTuple):
    """How counts are scaled and checked, for one robot and its limits."""

    left_tick: float
    """Travel per count [m]."""
    right_tick: float
    left_per_turn: float
    """Counts per turn of the wheel."""
    right_per_turn: float
    half: float
    """Half the range of counters that wrap, in counts; infinite if they do not wrap."""
    top_speed: float
    """Fastest possible wheel speed [m/s], and `top_rate` [turns/s]; 0 if unknown."""
    top_rate: float

    @staticmethod
    def of(robot: Robot, limits: EncoderLimits) -> CountRule:
        """Create the rule for a robot's encoders."""
        return CountRule(
            robot.left_tick,
            robot.right_tick,
            robot.left_ticks_per_revolution,
            robot.right_ticks_per_revolution,
            2.0 ** (robot.encoder_bits - 1) if robot.encoder_bits else math.inf,
            limits.max_wheel_speed,
            limits.max_wheel_speed / (2.0 * math.pi * robot.wheel_radius),
        )


@dataclass(slots=True)
class Encoder:
    """Counters to wheel travel, one message at a time, in constant time and memory.

    A counter was reset (a restarted driver) if it falls to near zero faster than its wheel can
    turn, or if both fall to exactly zero from farther away than one message explains. The travel of
    that interval is lost: it is taken as zero, with the last speed times the interval as its
    standard deviation, and counting continues from the new reading.
    """

    robot: Robot
    limits: EncoderLimits = field(default_factory=EncoderLimits)
    tally: EncoderTally = field(default_factory=EncoderTally)
    _last: Reading | None = None
    _doubted: Reading | None = None
    pace: Pace = field(default_factory=Pace)
    lasted: float = USUAL_AT_FIRST
    """Interval for checking the latest step [s]: its own, unless it arrived much too early."""
    _left_speed: float = 0.0
    _right_speed: float = 0.0
    rule: CountRule = field(init=False)

    def __post_init__(self) -> None:
        self.rule = CountRule.of(self.robot, self.limits)

    def retune(self, robot: Robot, limits: EncoderLimits) -> None:
        """Change the parameter values; the state is kept."""
        self.robot, self.limits = robot, limits
        self.__post_init__()

    def step(self, time: float, left: float, right: float) -> WheelStep | None:
        """Return the travel since the last accepted message.

        Parameters
        ----------
        time : float
            Stamp of the message [s].
        left, right : float or int
            Cumulative signed counts (fractional or integer; integers of any size stay exact).

        Returns
        -------
        WheelStep or None
            None for the first message and for one that is rejected; `tally` counts the reason.
        """
        self.tally.messages += 1
        if not (isfinite(time) and isfinite(left) and isfinite(right)):
            self.tally.not_finite += 1
            return None
        reading = Reading(time, left, right)
        if self._doubted is not None and time == self._doubted.time:
            self.tally.duplicates += 1  # a doubtful message does not confirm itself
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
        """Whether a message that is no later than the last one is accepted nevertheless."""
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
        last, rule, bits, pace = self._last, self.rule, self.robot.encoder_bits, self.pace
        left, right = reading.left - last.left, reading.right - last.right
        if bits:
            left, right = wrapped(left, bits), wrapped(right, bits)
        lasted = lasted_over(duration, pace.usual)
        if was_reset(rule, reading, last, left, right, lasted, pace.usual, pace.fastest):
            self.tally.resets += 1
            return self._anchor_anew(reading, duration)
        if rule.top_speed > 0.0 and self._exceeds(last, reading, duration):
            if self._doubted is None or self._exceeds(
                self._doubted, reading, reading.time - self._doubted.time
            ):
                self.tally.implausible += 1
                self._doubted = reading
                return None
            self.tally.jumps += 1
            return self._anchor_anew(reading, duration)
        if bits:
            self.tally.wraps += int(left != reading.left - last.left)
            self.tally.wraps += int(right != reading.right - last.right)
        if duration > self.limits.gap_duration:
            self.tally.gaps += 1
        self._accept(reading, duration)
        pace.see(faster_wheel(rule, left, right) / lasted)
        self.lasted = lasted
        left_travel, right_travel = left * rule.left_tick, right * rule.right_tick
        self._left_speed, self._right_speed = left_travel / lasted, right_travel / lasted
        return WheelStep(reading.time, duration, left_travel, right_travel)

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
        """Update the state after steps that were processed elsewhere; `pace` has them already.

        Parameters
        ----------
        durations : ndarray, shape (n,)
            Durations of the steps [s].
        left, right, lasted : float
            Travel in the last of them [m], and the interval to check it over [s].
        last : Reading
            The last reading.
        """
        self._left_speed, self._right_speed, self.lasted = left / lasted, right / lasted, lasted
        self.tally.messages += durations.size
        self.tally.accepted += durations.size
        self.tally.gaps += int(np.count_nonzero(durations > self.limits.gap_duration))
        self._last, self._doubted = last, None

    def have_stepped(self, step: WheelStep, last: Reading) -> None:
        """Update the state after a step processed elsewhere; `tally` and `pace` have it already."""
        self.lasted = step.duration
        self._left_speed, self._right_speed = step.left / step.duration, step.right / step.duration
        self._last, self._doubted = last, None

    @property
    def last(self) -> Reading | None:
        """The last reading; None while a later one is doubtful."""
        return self._last if self._doubted is None else None

    def _exceeds(self, start: Reading, end: Reading, duration: float) -> bool:
        bits = self.robot.encoder_bits
        left = wrapped(end.left - start.left, bits) * self.rule.left_tick
        right = wrapped(end.right - start.right, bits) * self.rule.right_tick
        return exceeds(self.rule, left, right, duration)


def exceeds(rule: CountRule, left: float, right: float, duration: float) -> bool:
    """Whether a wheel would have exceeded its top speed with these travels [m]."""
    return max(abs(left), abs(right)) > rule.top_speed * abs(duration)


def faster_wheel(rule: CountRule, left: float, right: float) -> float:
    """Turns of the wheel that turned more, for these differences of counts."""
    left_turns, right_turns = abs(left) / rule.left_per_turn, abs(right) / rule.right_per_turn
    return left_turns if left_turns > right_turns else right_turns


def was_reset(
    rule: CountRule,
    now: Reading,
    last: Reading,
    left: float,
    right: float,
    lasted: float,
    usual: float,
    fastest: float,
) -> bool:
    """Whether a counter was reset between two readings; see `Encoder`.

    Parameters
    ----------
    left, right : float
        Differences of the readings, unwrapped.
    lasted : float
        Interval to check them over [s].
    usual, fastest : float
        The usual interval [s], and the fastest recent turn rate of a wheel [turns/s].
    """
    rate = reach_rate(rule, fastest)
    reach = lasted * rate
    new_left, new_right = now.left / rule.left_per_turn, now.right / rule.right_per_turn
    if abs(new_left) > reach < abs(new_right):
        return False
    step_left, step_right = left / rule.left_per_turn, right / rule.right_per_turn
    if new_left == 0.0 and new_right == 0.0:
        far = max(abs(step_left), abs(step_right))
        if far > usual * rate:
            return True
    return fell_to_zero(new_left, last.left / rule.left_per_turn, step_left, reach) or fell_to_zero(
        new_right, last.right / rule.right_per_turn, step_right, reach
    )


def fell_to_zero(new: float, old: float, step: float, reach: float) -> bool:
    """Whether a counter fell to near zero by more than a wheel can turn; all in turns."""
    return abs(new) <= reach and abs(old) > reach and abs(step) > reach


def reach_rate(rule: CountRule, fastest: float) -> float:
    """Fastest plausible turn rate of a wheel [turns/s]."""
    if rule.top_speed > 0.0:
        return rule.top_rate
    return max(LEARNED_FLOOR, LEARNED_MARGIN * fastest)


class Undoubted(NamedTuple):
    """Content of a reading that passes all checks."""

    left: float
    """Travel since the previous reading [m]."""
    right: float
    rate: float
    """Speed of the faster wheel [turns/s]."""
    lasted: float
    """Interval that `rate` refers to [s]."""


def undoubted(
    rule: CountRule, now: Reading, last: Reading, usual: float, fastest: float
) -> tuple[bool, Undoubted]:
    """Whether `Encoder` would accept a reading without special handling; and its content.

    Comparisons with NaN are false, so numbers that are not finite never pass.
    """
    duration = now.time - last.time
    left, right = float(now.left - last.left), float(now.right - last.right)
    lasted = lasted_over(duration, usual)
    rate = faster_wheel(rule, left, right) / lasted
    step = Undoubted(left * rule.left_tick, right * rule.right_tick, rate, lasted)
    if not (RESOLUTION < duration <= PAUSE and rate < math.inf):
        return False, step
    if not (-rule.half <= left < rule.half and -rule.half <= right < rule.half):
        return False, step
    if rule.top_speed > 0.0 and exceeds(rule, step.left, step.right, duration):
        return False, step
    return not was_reset(rule, now, last, left, right, lasted, usual, fastest), step
