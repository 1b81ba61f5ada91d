# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Limits set by the user: speeds, accelerations, the allowed area, and what stops a drive.

`driver.Driver` checks the rest of them against what it follows: silence, the area, what is near, a
robot that does not follow, and wheels that slip.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from werrimbi_odom.model.pose import Pose


class Command(NamedTuple):
    """Speed [m/s] and yaw rate [rad/s] of a `cmd_vel` message."""

    speed: float
    yaw_rate: float


STILL = Command(0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Limits:
    """Largest absolute values of commands and their rates of change; all positive."""

    speed: float
    yaw_rate: float
    """[m/s], [rad/s]"""
    acceleration: float
    yaw_acceleration: float
    """[m/s^2], [rad/s^2]"""

    def kept(self, wanted: Command, before: Command, duration: float) -> Command:
        """The command nearest to `wanted` within the limits, `duration` [s] after `before`."""
        return Command(
            _kept(wanted.speed, before.speed, self.speed, self.acceleration * duration),
            _kept(
                wanted.yaw_rate, before.yaw_rate, self.yaw_rate, self.yaw_acceleration * duration
            ),
        )


def _kept(wanted: float, before: float, most: float, step: float) -> float:
    wanted = min(max(wanted, -most), most)
    return min(max(wanted, before - step), before + step)


@dataclass(frozen=True, slots=True)
class Area:
    """Area that the whole robot must stay in, in the frame of its first start (x ahead, y left)."""

    ahead: float = math.inf
    behind: float = math.inf
    left: float = math.inf
    right: float = math.inf
    """Distances of the sides of a rectangle from the start [m]; infinite for no side."""
    radius: float = math.inf
    """Radius of a circle about the start [m]; infinite for no circle."""
    robot_radius: float = 0.0
    """Radius of the circle about the middle of the axle that encloses the robot [m]."""

    def room(self, x: float, y: float) -> float:
        """Distance between the robot and the nearest border [m]; negative outside."""
        sides = (self.ahead - x, self.behind + x, self.left - y, self.right + y)
        return min(*sides, self.radius - math.hypot(x, y)) - self.robot_radius


JUMP, JUMP_TURN = 0.05, 0.15
"""Tolerance of a pose step beyond the fastest allowed motion [m, rad]: stamps have jitter, and the
robot may be faster than its limits say."""
JUMP_FACTOR = 2.0
"""Factor on the fastest allowed motion in this check."""
SLIP_WINDOW = 0.2
"""Window in which turns by the wheels and by the gyro are compared [s]."""


class OdometryReading(NamedTuple):
    """One odometry message: its stamp [s], its age on arrival [s], the pose."""

    stamp: float
    age: float
    pose: Pose


@dataclass(frozen=True, slots=True)
class Watch:
    """Limits at which a drive is stopped."""

    odom_timeout: float = 0.2
    """Longest silence of the odometry, and longest delay beyond the least one seen [s]."""
    deviation: float = 0.15
    turned_off: float = 0.5
    """Largest position error [m] and heading error [rad] against the plan."""
    scan_min_distance: float = 0.0
    """Least distance that a scan may measure [m]; 0 if there is no scan."""
    scan_timeout: float = 0.5
    """Longest silence of the scan [s]."""
    slip: float = 0.0
    """Largest difference of wheels and gyro in a turn over SLIP_WINDOW [rad]; 0: no gyro."""


def fault_between(before: OdometryReading, now: OdometryReading, limits: Limits) -> str:
    """Fault of an odometry message relative to the one before it; "" if none."""
    step = now.stamp - before.stamp
    if step <= 0.0:
        return f"the odometry's stamps go back or stand, by {abs(step):.3f} s"
    gone = math.hypot(now.pose.x - before.pose.x, now.pose.y - before.pose.y)
    if gone > JUMP_FACTOR * limits.speed * step + JUMP:
        return f"the odometry jumped by {gone:.2f} m in {step:.3f} s"
    turned = abs(math.remainder(now.pose.yaw - before.pose.yaw, 2.0 * math.pi))
    if turned > JUMP_FACTOR * limits.yaw_rate * step + JUMP_TURN:
        return f"the odometry jumped by {math.degrees(turned):.0f} deg in {step:.3f} s"
    return ""
