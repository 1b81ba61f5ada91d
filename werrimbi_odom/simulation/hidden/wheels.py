# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Wheels that are not plain discs fixed to their encoders: geometry, so the engine makes them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from ..chassis import Chassis, WheelPlan
from ..engine import Engine, Reshaper, Stride
from .peculiarity import Peculiarity

Side = Literal["left", "right"]


def with_wheel(chassis: Chassis, side: Side, wheel: WheelPlan) -> Chassis:
    """`chassis` with another wheel on one side."""
    return replace(chassis, left=wheel) if side == "left" else replace(chassis, right=wheel)


@dataclass(frozen=True)
class EccentricWheel(Peculiarity):
    """The axle passes the wheel's centre at a distance.

    Parameters
    ----------
    side : "left" or "right"
    amplitude : float
        That distance [m].
    phase : float
        Angle of the wheel at which its centre is ahead of the axle [rad]. It says nothing about
        the counter, unless the robot's counters keep their zero.
    """

    side: Side
    amplitude: float
    phase: float

    def chassis(self, chassis: Chassis) -> Chassis:
        """A wheel hung off its centre."""
        wheel = replace(getattr(chassis, self.side), offset=self.amplitude, phase=self.phase)
        return with_wheel(chassis, self.side, wheel)


@dataclass(frozen=True)
class OvalWheel(Peculiarity):
    """A wheel pressed out of round: an error twice a turn.

    Parameters
    ----------
    side : "left" or "right"
    amplitude : float
        Half the difference between its largest and its smallest radius [m].
    """

    side: Side
    amplitude: float

    def chassis(self, chassis: Chassis) -> Chassis:
        """An ellipsoid in the sphere's place."""
        wheel: WheelPlan = getattr(chassis, self.side)
        oval = replace(wheel, ovality=self.amplitude / wheel.radius)
        return with_wheel(chassis, self.side, oval)


@dataclass(frozen=True)
class Backlash(Peculiarity):
    """Free play between the encoder's shaft and the wheel.

    Parameters
    ----------
    side : "left" or "right"
    travel : float
        From stop to stop, measured at the rim [m].
    """

    side: Side
    travel: float

    def chassis(self, chassis: Chassis) -> Chassis:
        """A wheel that turns on its shaft between two stops."""
        wheel: WheelPlan = getattr(chassis, self.side)
        return with_wheel(chassis, self.side, replace(wheel, play=self.travel / wheel.radius))


@dataclass(frozen=True)
class RadiusDrift(Peculiarity):
    """Both wheels swell or shrink steadily; each drive begins with the true radii (cold wheels).

    Parameters
    ----------
    rate : float
        Relative growth per metre of path or per second.
    per : "metre" or "second"
    """

    rate: float
    per: Literal["metre", "second"]

    def reshaper(self, chassis: Chassis, rng: np.random.Generator) -> Reshaper:
        """Resize the wheels a little after each period."""
        distance = 0.0

        def reshape(engine: Engine, stride: Stride) -> None:
            nonlocal distance
            distance += abs(stride.left + stride.right) / 2
            grown = 1 + self.rate * (distance if self.per == "metre" else stride.time)
            for wheel in chassis.wheels:
                engine.set_radius(wheel.side, wheel.radius * grown)

        return reshape
