# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Tyres that creep under their forces, wheel bases that depend on the turn, and castors.

The engine's contacts do not creep by themselves, so the body is moved after the step.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from ..engine import Shift, Shifter, Stride
from ..robot import TrueRobot
from .hidden_effect import MovesEachStride, Peculiarity, Rng


@dataclass(frozen=True)
class LongitudinalSlip(Peculiarity):
    """Slip proportional to force: a driven wheel travels less than it rolls, a braked one more."""

    coefficient: float
    """Share of the travel lost per acceleration of the wheel [s^2/m]. For a tyre of stiffness C
    under a mass m it is m / C."""
    turning: float = 1.0
    """Moment of inertia about the vertical over mass * (base / 2)^2: 1 with all mass over the
    wheels, 0 with all of it between them."""

    def shifter(self, robot: TrueRobot, rng: Rng) -> Shifter:
        """Each wheel lags by coefficient * acceleration * path."""
        return _falling_back(self.coefficient, 0.0, self.turning, robot)


@dataclass(frozen=True)
class CoulombSlip(Peculiarity):
    """A wheel grips up to a certain force and slips above it."""

    coefficient: float
    """Share of the travel lost per acceleration above the threshold [s^2/m]."""
    above: float
    """Threshold of the wheel's acceleration [m/s^2]."""
    turning: float = 1.0
    """As of `LongitudinalSlip`."""

    def shifter(self, robot: TrueRobot, rng: Rng) -> Shifter:
        """Each wheel lags by coefficient * (|acceleration| - above) * path."""
        return _falling_back(self.coefficient, self.above, self.turning, robot)


def _falling_back(coefficient: float, above: float, turning: float, robot: TrueRobot) -> Shifter:
    """Lag of each wheel, from the part above a threshold of its force over half the mass [m/s^2].

    The force of mass m and moment of inertia I on the two wheels is m a / 2 -+ I alpha / base.
    """
    before = (0.0, 0.0)

    def lag(force: float, travel: float) -> float:
        beyond = math.copysign(max(abs(force) - above, 0.0), force)
        return -coefficient * beyond * abs(travel)

    def shift(stride: Stride) -> Shift:
        nonlocal before
        left = (stride.left - before[0]) / stride.period**2
        right = (stride.right - before[1]) / stride.period**2
        before = (stride.left, stride.right)
        along, about = (left + right) / 2, turning * (right - left) / 2
        left, right = lag(along - about, stride.left), lag(along + about, stride.right)
        return Shift((left + right) / 2, 0.0, (right - left) / robot.wheel_separation)

    return shift


@dataclass(frozen=True)
class LateralSlip(MovesEachStride):
    """Tyres creep outwards in curves."""

    creep: float
    """Outward speed per centripetal acceleration (speed times yaw rate) [s]."""

    def shift(self, stride: Stride, robot: TrueRobot) -> Shift:
        """Sideways motion of -creep * speed * turn."""
        speed = (stride.left + stride.right) / 2 / stride.period
        turn = (stride.right - stride.left) / robot.wheel_separation
        return Shift(0.0, -self.creep * speed * turn, 0.0)


@dataclass(frozen=True)
class TurnDependentTrack(MovesEachStride):
    """The effective wheel base depends on the kind of turn."""

    coefficient: float
    """Relative increase of the base: at sharpness 1, or in left turns (with opposite sign in right
    turns)."""
    on: Literal["sharpness", "sense"]
    """Sharpness is |R - L| / (|R| + |L|): 0 on a line, 1 in pivots and spins."""

    def shift(self, stride: Stride, robot: TrueRobot) -> Shift:
        """Subtract the part of the turn that the wider base does not make."""
        difference = stride.right - stride.left
        total = abs(stride.right) + abs(stride.left)
        if total < 1e-9:
            return Shift(0.0, 0.0, 0.0)
        how = abs(difference) / total if self.on == "sharpness" else np.sign(difference)
        grown = 1 + self.coefficient * float(how)
        return Shift(0.0, 0.0, difference / robot.wheel_separation * (1 / grown - 1))


PARTS = 4
"""Steps of the castor's angle in one of the controller: it follows within some centimetres."""


@dataclass(frozen=True)
class CastorSwing(Peculiarity):
    """A stiff castor drags the robot round wherever it swings, as a trailer of one wheel does."""

    drag: float
    """Heading gained per angle that the castor swings [1]."""
    pivot: float
    """From the axle forwards to the pivot, in wheel separations; negative behind the axle."""
    trail: float
    """From the pivot to the castor's contact, in wheel separations."""
    start: float
    """Its angle when a drive begins, 0 where it trails in forward motion [rad]."""

    def shifter(self, robot: TrueRobot, rng: Rng) -> Shifter:
        """Step the castor's angle with the wheels' motion."""
        ahead = self.pivot * robot.wheel_separation
        trail = self.trail * robot.wheel_separation
        angle = self.start

        def shift(stride: Stride) -> Shift:
            nonlocal angle
            along = (stride.left + stride.right) / 2
            turn = (stride.right - stride.left) / robot.wheel_separation
            before = angle
            for _ in range(PARTS):
                sideways = ahead * turn * math.cos(angle) - along * math.sin(angle)
                angle += (sideways / trail - turn) / PARTS
            return Shift(0.0, 0.0, self.drag * (angle - before))

        return shift


@dataclass(frozen=True)
class CastorKick(Peculiarity):
    """After each reversal the castor swings round and changes the heading."""

    angle: float
    """Total change of heading [rad]."""
    alternating: bool
    """True: +angle when it starts to drive forwards, -angle backwards; False: always +angle."""
    trail: float = 0.04
    """Distance over which the swing decays by a factor e [m]."""
    lead: float = 2e-3
    """Travel that counts as a reversal [m]; excludes the settling of a motor at a stop."""

    def shifter(self, robot: TrueRobot, rng: Rng) -> Shifter:
        """Distribute the change of heading over the path after a reversal."""
        direction = 0.0
        against = 0.0
        backlog = 0.0

        def shift(stride: Stride) -> Shift:
            nonlocal direction, against, backlog
            along = (stride.left + stride.right) / 2
            against = max(against - along * direction, 0.0) if direction else against + abs(along)
            if against > self.lead:
                if direction:
                    backlog = self.angle * (-direction if self.alternating else 1.0)
                direction, against = float(np.sign(along)), 0.0
            kick = backlog * (1 - np.exp(-abs(along) / self.trail))
            backlog -= kick
            return Shift(0.0, 0.0, float(kick))

        return shift
