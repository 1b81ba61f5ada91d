# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Wheels that are not discs fixed to their encoders; geometry, so the engine simulates them."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from ..chassis import Chassis, WheelPlan
from ..engine import Engine, Reshaper, Shift, Stride
from .hidden_effect import Peculiarity, Rng, resized

Side = Literal["left", "right"]


def with_wheel(chassis: Chassis, side: Side, **changes: float) -> Chassis:
    """`chassis` with another wheel on one side."""
    return replace(chassis, **{side: replace(getattr(chassis, side), **changes)})


@dataclass(frozen=True)
class EccentricWheel(Peculiarity):
    """The axle does not pass through the wheel's centre."""

    side: Side
    amplitude: float
    """Distance between them [m]."""
    phase: float
    """Angle of the wheel at which its centre is ahead of the axle [rad]; unrelated to the counter,
    unless the robot's counters keep their zero."""

    def chassis(self, chassis: Chassis) -> Chassis:
        """Offset the wheel from its axle."""
        return with_wheel(chassis, self.side, offset=self.amplitude, phase=self.phase)


@dataclass(frozen=True)
class OvalWheel(Peculiarity):
    """An elliptic wheel: an error with twice its rotational frequency."""

    side: Side
    amplitude: float
    """Half the difference between its largest and its smallest radius [m]."""

    def chassis(self, chassis: Chassis) -> Chassis:
        """Replace the sphere by an ellipsoid."""
        wheel: WheelPlan = getattr(chassis, self.side)
        return with_wheel(chassis, self.side, ovality=self.amplitude / wheel.radius)


@dataclass(frozen=True)
class TreadBump(Peculiarity):
    """A bump or a flat on a part of the tread.

    For a small rotation a wheel travels in proportion to the height of its hub. A soft tread has a
    contact patch, and raises the hub by the bump weighted with the pressure in the patch, which is
    a parabola with its maximum at the middle.
    """

    side: Side
    thickness: float
    """Thickness of the bump [m]; negative for the depth of a flat."""
    around: float
    """Angle of the wheel that it covers [rad]."""
    at: float
    """Angle of the wheel at which its middle is on the floor [rad]; see `EccentricWheel.phase`."""
    patch: float = 0.25
    """Half the angle of the contact patch [rad]."""

    def higher(self, angle: float) -> float:
        """Additional height of the hub at an angle of the wheel [m]."""
        off = math.remainder(angle - self.at, 2.0 * math.pi)
        ends = ((off + side * 0.5 * self.around) / self.patch for side in (1.0, -1.0))
        ahead, behind = (min(max(end, -1.0), 1.0) for end in ends)
        return self.thickness * 0.25 * (3.0 * (ahead - behind) - (ahead**3 - behind**3))

    def reshaper(self, chassis: Chassis, rng: Rng) -> Reshaper:
        """Move the robot by the additional travel while the hub is higher.

        If its radius changes within a revolution, a rigid wheel of the engine loses contact, and
        with it a quarter to a half of the effect; a soft one keeps contact.
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
    """Free play between the encoder's shaft and the wheel."""

    side: Side
    travel: float
    """Travel from stop to stop at the rim [m]."""

    def chassis(self, chassis: Chassis) -> Chassis:
        """Add play between wheel and shaft."""
        wheel: WheelPlan = getattr(chassis, self.side)
        return with_wheel(chassis, self.side, play=self.travel / wheel.radius)


@dataclass(frozen=True)
class RadiusDrift(Peculiarity):
    """Both radii grow or shrink steadily; each drive starts with the true radii (cold wheels)."""

    rate: float
    """Relative increase per metre of path or per second."""
    per: Literal["metre", "second"]

    def reshaper(self, chassis: Chassis, rng: Rng) -> Reshaper:
        """Change the radii a little after each period."""
        distance = 0.0

        def factor(stride: Stride) -> float:
            nonlocal distance
            distance += abs(stride.left + stride.right) / 2
            return 1 + self.rate * (distance if self.per == "metre" else stride.time)

        return resized(chassis.wheels, factor)
