# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What the odometry, the scan and the gyro must not show while the robot is driven."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from werrimbi_odom.driving.limits import Limits
from werrimbi_odom.model.pose import Pose

JUMP, JUMP_TURN = 0.05, 0.15
"""By which a pose may go beyond what the fastest allowed motion explains [m, rad]: slack for
stamps that scatter, and for a robot that is faster than it was told."""
JUMP_FACTOR = 2.0
"""Times the fastest allowed motion that is believed."""
SLIP_WINDOW = 0.2
"""Over which turns by the wheels and by the gyro are compared [s]."""


class OdometryReading(NamedTuple):
    """One odometry message: its stamp [s], how old it was when it came [s], the pose."""

    stamp: float
    age: float
    pose: Pose


@dataclass(frozen=True, slots=True)
class Watch:
    """When to stop.

    Parameters
    ----------
    odom_timeout : float
        Longest silence of the odometry, and delay beyond the least one seen [s].
    deviation, turned_off : float
        Farthest from where the robot should be now [m], [rad].
    scan_min_distance : float
        Nearest that a scan may see anything [m]; 0: there is no scan.
    scan_timeout : float
        Longest silence of the scan [s].
    slip : float
        By how much wheels and gyro may differ in a turn of SLIP_WINDOW [rad]; 0: there is no gyro.
    """

    odom_timeout: float = 0.2
    deviation: float = 0.15
    turned_off: float = 0.5
    scan_min_distance: float = 0.0
    scan_timeout: float = 0.5
    slip: float = 0.0


def fault_between(before: OdometryReading, now: OdometryReading, limits: Limits) -> str:
    """What is wrong with an odometry message after the one before it; "" if nothing."""
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
