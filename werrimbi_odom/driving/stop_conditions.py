# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Limits of what stops a drive, and faults between two odometry messages.

`driver.Driver` checks the rest of them against what it follows: silence, the area, what is near, a
robot that does not follow, and wheels that slip.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from werrimbi_odom.driving.limits import Limits
from werrimbi_odom.model.pose import Pose

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
    """Limits at which a drive is stopped.

    Parameters
    ----------
    odom_timeout : float
        Longest silence of the odometry, and longest delay beyond the least one seen [s].
    deviation, turned_off : float
        Largest position error [m] and heading error [rad] against the plan.
    scan_min_distance : float
        Least distance that a scan may measure [m]; 0 if there is no scan.
    scan_timeout : float
        Longest silence of the scan [s].
    slip : float
        Largest difference of wheels and gyro in a turn over SLIP_WINDOW [rad]; 0 if there is no
        gyro.
    """

    odom_timeout: float = 0.2
    deviation: float = 0.15
    turned_off: float = 0.5
    scan_min_distance: float = 0.0
    scan_timeout: float = 0.5
    slip: float = 0.0


def fault_between(before: OdometryReading, now: OdometryReading, limits: Limits) -> str:
    """Fault of an odometry message relative to the one before it; "" if none."""
    step = now.stamp - before.stamp
    if step <= 0.0:
        return f"the odometry's stamps go back or stand, by {-step:.3f} s"
    gone = math.hypot(now.pose.x - before.pose.x, now.pose.y - before.pose.y)
    if gone > JUMP_FACTOR * limits.speed * step + JUMP:
        return f"the odometry jumped by {gone:.2f} m in {step:.3f} s"
    turned = abs(math.remainder(now.pose.yaw - before.pose.yaw, 2.0 * math.pi))
    if turned > JUMP_FACTOR * limits.yaw_rate * step + JUMP_TURN:
        return f"the odometry jumped by {math.degrees(turned):.0f} deg in {step:.3f} s"
    return ""
