# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Checks of one counter reading: reset, too fast, or accepted.

Plain functions of numbers, which `encoder_online.Encoder` applies, and numba compiles for recorded
runs.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from werrimbi_odom.model.pace import PAUSE, lasted_over
from werrimbi_odom.model.robot import Robot

RESOLUTION = 0.5e-9
"""Stamps have a resolution of nanoseconds; two that are closer than this [s] are equal."""

LEARNED_MARGIN = 4.0
"""Without a known top speed, a wheel may go this many times faster than it did recently ..."""
LEARNED_FLOOR = 1.0
"""... or one turn a second, before a fall to zero is taken as a reset."""


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
    def of(robot: Robot, max_wheel_speed: float) -> CountRule:
        """Create the rule for a robot's encoders, and its top speed [m/s] (0: unknown)."""
        return CountRule(
            robot.left_tick,
            robot.right_tick,
            robot.left_ticks_per_revolution,
            robot.right_ticks_per_revolution,
            2.0 ** (robot.encoder_bits - 1) if robot.encoder_bits else math.inf,
            max_wheel_speed,
            max_wheel_speed / (2.0 * math.pi * robot.wheel_radius),
        )


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

    `left`, `right`: differences of the readings, unwrapped. `lasted`: interval to check them over
    [s]. `usual`, `fastest`: the usual interval [s], and the fastest recent turn rate of a wheel
    [turns/s].
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
