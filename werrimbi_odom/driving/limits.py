# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Limits set by the user: speeds, accelerations, and the allowed area."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple


class Command(NamedTuple):
    """Speed [m/s] and yaw rate [rad/s] of a `cmd_vel` message."""

    speed: float
    yaw_rate: float


STILL = Command(0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Limits:
    """Largest absolute values of commands and their rates of change; all positive.

    Parameters
    ----------
    speed, yaw_rate : float
        [m/s], [rad/s].
    acceleration, yaw_acceleration : float
        [m/s^2], [rad/s^2].
    """

    speed: float
    yaw_rate: float
    acceleration: float
    yaw_acceleration: float

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
    """Area that the whole robot must stay in, in the frame of its first start (x ahead, y left).

    Parameters
    ----------
    ahead, behind, left, right : float
        Distances of the sides of a rectangle from the start [m]; infinite for no side.
    radius : float
        Radius of a circle about the start [m]; infinite for no circle.
    robot_radius : float
        Radius of the circle about the middle of the axle that encloses the robot [m].
    """

    ahead: float = math.inf
    behind: float = math.inf
    left: float = math.inf
    right: float = math.inf
    radius: float = math.inf
    robot_radius: float = 0.0

    def room(self, x: float, y: float) -> float:
        """Distance between the robot and the nearest border [m]; negative outside."""
        sides = (self.ahead - x, self.behind + x, self.left - y, self.right + y)
        return min(*sides, self.radius - math.hypot(x, y)) - self.robot_radius
