# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Floors that displace the robot."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..engine import Shift, Stride
from ..robot import TrueRobot
from .hidden_effect import MovesEachStride


@dataclass(frozen=True)
class FloorSlope(MovesEachStride):
    """On a slope tyres creep downhill while they roll."""

    creep: float
    """Drift per metre of path [1]."""
    downhill: float
    """Downhill direction in the world [rad]."""

    def shift(self, stride: Stride, robot: TrueRobot) -> Shift:
        """Drift in a fixed direction of the world."""
        drift = self.creep * abs(stride.left + stride.right) / 2
        bearing = self.downhill - stride.pose.yaw
        return Shift(drift * math.cos(bearing), drift * math.sin(bearing), 0.0)


@dataclass(frozen=True)
class GrainedFloor(MovesEachStride):
    """A ribbed floor: across the ribs a wheel's contact path is longer than the way travelled."""

    gain: float
    """Relative increase of the distance along the grain, and decrease across it."""
    grain: float
    """Direction of the grain in the world [rad]."""

    def shift(self, stride: Stride, robot: TrueRobot) -> Shift:
        """Change of the distance by the direction of motion relative to the grain."""
        along = (stride.left + stride.right) / 2
        off = stride.pose.yaw - self.grain
        return Shift(self.gain * along * (math.cos(off) ** 2 - math.sin(off) ** 2), 0.0, 0.0)


@dataclass(frozen=True)
class SlipperySpot(MovesEachStride):
    """An oil stain: a wheel on it travels less than it rolls. Outside the library."""

    loss: float
    """Share of the travel lost on it."""
    x: float
    y: float
    radius: float
    """Centre in the world, and radius [m]."""

    def shift(self, stride: Stride, robot: TrueRobot) -> Shift:
        """Loss of each wheel by its position."""
        half = robot.wheel_separation / 2

        def lost(travel: float, along_axle: float) -> float:
            x = stride.pose.x - along_axle * math.sin(stride.pose.yaw)
            y = stride.pose.y + along_axle * math.cos(stride.pose.yaw)
            on_it = math.hypot(x - self.x, y - self.y) < self.radius
            return self.loss * travel if on_it else 0.0

        left, right = -lost(stride.left, half), -lost(stride.right, -half)
        return Shift((left + right) / 2, 0.0, (right - left) / robot.wheel_separation)


@dataclass(frozen=True)
class CablePull(MovesEachStride):
    """A dragged cable turns the robot towards one direction. Outside the library."""

    rate: float
    """Change of heading per metre of path when at right angles to that direction [rad/m]."""
    towards: float
    """The direction in the world [rad]."""

    def shift(self, stride: Stride, robot: TrueRobot) -> Shift:
        """Turn proportional to the sine of the angle to that direction."""
        path = abs(stride.left + stride.right) / 2
        return Shift(0.0, 0.0, self.rate * path * math.sin(self.towards - stride.pose.yaw))
