# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""From cumulative counters to wheel travel, with the faults of real counters handled.

Counters are cumulative, so a lost, doubled or late message loses no motion: the next good one
contains it all. Only a counter reset would make the pose jump; `Encoder` describes how a reset is
distinguished from motion.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from math import isfinite
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.counter_wraps import wrapped
from werrimbi_odom.model.pace import USUAL_AT_FIRST, Pace, lasted_over
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.reading_checks import (
    RESOLUTION,
    CountRule,
    Reading,
    exceeds,
    faster_wheel,
    was_reset,
)
from werrimbi_odom.model.robot import Robot

Counts = NDArray[np.float64] | NDArray[np.int64]

CLOCK_JUMP = 1.0
"""A stamp older than the last by more than this [s] is a clock set back, not a late message."""


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
    """When counter readings are rejected."""

    max_wheel_speed: float = 0.0
    """Fastest possible wheel speed [m/s]; 0 if unknown. If given, faster steps are rejected until a
    second message confirms them. If unknown, only a fall to zero is checked."""
    gap_duration: float = 1.0
    """Intervals longer than this [s] are counted as gaps; their motion is kept."""


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
    usual: float = USUAL_AT_FIRST
    """The usual interval, by which the latest step is much too early or is not [s]."""
    _left_speed: float = 0.0
    _right_speed: float = 0.0
    rule: CountRule = field(init=False)

    def __post_init__(self) -> None:
        self.rule = CountRule.of(self.robot, self.limits.max_wheel_speed)

    def retune(self, robot: Robot, limits: EncoderLimits) -> None:
        """Change the parameter values; the state is kept."""
        self.robot, self.limits = robot, limits
        self.__post_init__()

    def step(self, time: float, left: float, right: float) -> WheelStep | None:
        """Return the travel since the last accepted message.

        `time`: stamp of the message [s]. `left`, `right`: cumulative signed counts (fractional or
        integer; integers of any size stay exact). None for the first message and for one that is
        rejected; `tally` counts the reason.
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
        lasted, self.usual = lasted_over(duration, pace.usual), pace.in_motion
        if was_reset(rule, reading, last, left, right, lasted, pace.usual, pace.fastest):
            self.tally.resets += 1
            return self._anchor_anew(reading, duration)
        if rule.top_speed > 0.0 and self._exceeds(last, reading, duration):
            if self._doubted is None or self._exceeds(
                self._doubted, reading, abs(reading.time - self._doubted.time)
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

        `durations` (n,): durations of the steps [s]. `left`, `right`, `lasted`: travel in the last
        of them [m], and the interval to check it over [s]. `last`: the last reading.
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
        """Whether a wheel was too fast; over the usual interval where stamps are close.

        Else messages that a driver sends at once would be refused, and the next one, which agrees
        with the last of them, taken for a jump: the travel of them all would be lost.
        """
        bits = self.robot.encoder_bits
        left = wrapped(end.left - start.left, bits) * self.rule.left_tick
        right = wrapped(end.right - start.right, bits) * self.rule.right_tick
        return exceeds(self.rule, left, right, lasted_over(duration, self.usual))
