# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Floors that carry the robot off."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..engine import Shift, Shifter, Stride
from ..robot import TrueRobot
from .peculiarity import Peculiarity


@dataclass(frozen=True)
class FloorSlope(Peculiarity):
    """On a slope tyres creep downhill with every metre they roll.

    Parameters
    ----------
    creep : float
        Drift per metre of path [1].
    downhill : float
        Its direction in the world [rad].
    """

    creep: float
    downhill: float

    def shifter(self, robot: TrueRobot, rng: np.random.Generator) -> Shifter:
        """Drift in a fixed direction of the world."""

        def shift(stride: Stride) -> Shift:
            drift = self.creep * abs(stride.left + stride.right) / 2
            bearing = self.downhill - stride.pose.yaw
            return Shift(drift * math.cos(bearing), drift * math.sin(bearing), 0.0)

        return shift


@dataclass(frozen=True)
class GrainedFloor(Peculiarity):
    """A ribbed floor: a wheel rolls on the ribs' crests along them, and over each of them across.

    Parameters
    ----------
    gain : float
        Share by which the way along the grain is longer than the mean; across it is shorter.
    grain : float
        Its direction in the world [rad].
    """

    gain: float
    grain: float

    def shifter(self, robot: TrueRobot, rng: np.random.Generator) -> Shifter:
        """More way along the grain, by how much of the motion lies along it and how much across."""

        def shift(stride: Stride) -> Shift:
            along = (stride.left + stride.right) / 2
            off = stride.pose.yaw - self.grain
            return Shift(self.gain * along * (math.cos(off) ** 2 - math.sin(off) ** 2), 0.0, 0.0)

        return shift


@dataclass(frozen=True)
class SlipperySpot(Peculiarity):
    """An oil stain: a wheel on it travels less than it rolls. Outside the library.

    Parameters
    ----------
    loss : float
        Share of the travel that is lost on it.
    x, y, radius : float
        Where it lies in the world, and how large it is [m].
    """

    loss: float
    x: float
    y: float
    radius: float

    def shifter(self, robot: TrueRobot, rng: np.random.Generator) -> Shifter:
        """Each wheel by where it stands."""
        half = robot.wheel_separation / 2

        def lost(travel: float, stride: Stride, along_axle: float) -> float:
            x = stride.pose.x - along_axle * math.sin(stride.pose.yaw)
            y = stride.pose.y + along_axle * math.cos(stride.pose.yaw)
            on_it = math.hypot(x - self.x, y - self.y) < self.radius
            return self.loss * travel if on_it else 0.0

        def shift(stride: Stride) -> Shift:
            left = -lost(stride.left, stride, half)
            right = -lost(stride.right, stride, -half)
            return Shift((left + right) / 2, 0.0, (right - left) / robot.wheel_separation)

        return shift


@dataclass(frozen=True)
class CablePull(Peculiarity):
    """A cable drags the tail, so the robot turns towards one direction as it goes. Outside.

    Parameters
    ----------
    rate : float
        Heading gained per metre of path when square to that direction [rad/m].
    towards : float
        That direction in the world [rad].
    """

    rate: float
    towards: float

    def shifter(self, robot: TrueRobot, rng: np.random.Generator) -> Shifter:
        """Turn by the sine of the angle to that direction."""

        def shift(stride: Stride) -> Shift:
            path = abs(stride.left + stride.right) / 2
            return Shift(0.0, 0.0, self.rate * path * math.sin(self.towards - stride.pose.yaw))

        return shift
