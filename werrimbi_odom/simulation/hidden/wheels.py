# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Wheels that are not plain discs fixed to their encoders: geometry, so the engine makes them."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from ..chassis import Chassis, WheelPlan
from ..engine import Engine, Reshaper, Shift, Stride
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
class TreadBump(Peculiarity):
    """Something on one part of the tread, or worn off it.

    A wheel goes, for a small turn, as far as its hub is high. A soft tread stands on a patch, and
    the hub is higher by as much of the bump as carries it: the pressure of the patch is that of a
    parabola, most in its middle.

    Parameters
    ----------
    side : "left" or "right"
    thickness : float
        Of the bump [m]; negative: how deep the flat is.
    around : float
        Angle of the wheel that it covers [rad].
    at : float
        Angle of the wheel at which it stands on its middle [rad]; as of `EccentricWheel.phase`.
    patch : float
        Half the angle of the wheel on which it stands [rad].
    """

    side: Side
    thickness: float
    around: float
    at: float
    patch: float = 0.25

    def higher(self, angle: float) -> float:
        """How much higher the hub stands when the wheel has turned to an angle [m]."""
        off = math.remainder(angle - self.at, 2.0 * math.pi)
        ends = ((off + side * 0.5 * self.around) / self.patch for side in (1.0, -1.0))
        ahead, behind = (min(max(end, -1.0), 1.0) for end in ends)
        return self.thickness * 0.25 * (3.0 * (ahead - behind) - (ahead**3 - behind**3))

    def reshaper(self, chassis: Chassis, rng: np.random.Generator) -> Reshaper:
        """Move the robot by what the wheel goes farther while its hub is higher.

        A hard wheel of the engine that grows and shrinks within a turn leaves the floor and loses
        a quarter to a half of what the bump does; a soft one stays on it.
        """
        wheel: WheelPlan = getattr(chassis, self.side)
        base = chassis.left.y - chassis.right.y
        before: float | None = None

        def reshape(engine: Engine, stride: Stride) -> None:
            nonlocal before
            angle = engine.wheel_angles[self.side == "right"]
            turned = 0.0 if before is None else angle - before
            farther = self.higher(angle - 0.5 * turned) * turned
            before = angle
            engine.move((Shift(0.5 * farther, 0.0, -np.sign(wheel.y) * farther / base),))

        return reshape


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
