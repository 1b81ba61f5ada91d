# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Abrupt events: a push, a heading kick, a bump, a wheel slip, a jump of the reference.

Times, number and direction are drawn for each drive and written to truth.json.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from ..engine import PERIOD, Shift, Shifter, Stride
from ..recording import Happened, Recording
from ..robot import TrueRobot
from .hidden_effect import Peculiarity, Rng

Kind = Literal["push", "heading_kick", "bump", "wheel_slip"]

FIRST, APART = 3.0, 5.0
"""Earliest time of the first event, and least time between two events [s]."""


def instants(every: float, until: float, rng: Rng) -> list[tuple[float, float]]:
    """Random times [s] and signs (+1 or -1) of events, one in `every` seconds on average."""
    found = []
    time = FIRST + float(rng.uniform(0.0, every))
    while time < until:
        found.append((time, float(rng.choice([-1.0, 1.0]))))
        time += APART + float(rng.exponential(every - APART))
    return found


@dataclass(frozen=True)
class Knock(Peculiarity):
    """The robot is moved within a short time without rotation of its wheels."""

    kind: Kind
    """"push": sideways; "heading_kick": its heading; "bump": along; "wheel_slip": one wheel, left
    or right, travels less than it rolls."""
    size: float
    """Size [m], or [rad] of a heading kick."""
    lasts: float = 0.1
    """Duration of an event [s]."""
    every: float = 25.0
    """Mean time between events [s]."""

    def _moved(self, side: float, robot: TrueRobot) -> Shift:
        """Total motion of one event."""
        if self.kind == "push":
            return Shift(0.0, side * self.size, 0.0)
        if self.kind == "heading_kick":
            return Shift(0.0, 0.0, side * self.size)
        if self.kind == "bump":
            return Shift(side * self.size, 0.0, 0.0)
        return Shift(-self.size / 2, 0.0, side * self.size / robot.wheel_separation)

    def shifter(self, robot: TrueRobot, rng: Rng) -> Shifter:
        """Motion of each event in equal parts over its duration."""
        knocks = instants(self.every, 3600.0, rng)
        parts = round(self.lasts / PERIOD)
        left, current = 0, Shift(0.0, 0.0, 0.0)

        def shift(stride: Stride) -> Shift:
            nonlocal left, current
            if knocks and stride.time >= knocks[0][0]:
                moved = self._moved(knocks.pop(0)[1], robot)
                current = Shift(*(part / parts for part in moved))
                left = parts
            if left == 0:
                return Shift(0.0, 0.0, 0.0)
            left -= 1
            return current

        return shift

    def happened(self, until: float, robot: TrueRobot, rng: Rng) -> tuple[Happened, ...]:
        """Events at the middle of their duration."""
        return tuple(
            Happened(self.kind, time + self.lasts / 2, *self._moved(side, robot))
            for time, side in instants(self.every, until, rng)
        )


@dataclass(frozen=True)
class ReferenceJump(Peculiarity):
    """The reference jumps to another position, for one pose or permanently."""

    live = False
    size: float
    """Length of the jump [m]."""
    stays: bool
    """Whether the offset remains; otherwise the next pose is correct again."""
    every: float = 25.0
    """Mean time between jumps [s]."""

    def _jumps(self, until: float, rng: Rng) -> list[tuple[float, complex]]:
        """Times [s] and sizes x + iy [m] of the jumps."""
        found = instants(self.every, until, rng)
        way = [float(rng.uniform(-math.pi, math.pi)) for _ in found]
        jumps = [complex(self.size * math.cos(at), self.size * math.sin(at)) for at in way]
        return [(time, jump) for (time, _), jump in zip(found, jumps, strict=True)]

    def recording(self, recording: Recording, robot: TrueRobot, rng: Rng) -> Recording:
        """Displace poses of the reference."""
        x, y = recording.reference_x_m.copy(), recording.reference_y_m.copy()
        for time, jump in self._jumps(float(recording.t_s[-1]), rng):
            first = int(np.searchsorted(recording.reference_t_s, time))
            rows = slice(first, None if self.stays else first + 1)
            x[rows] += jump.real
            y[rows] += jump.imag
        return replace(recording, reference_x_m=x, reference_y_m=y)

    def happened(self, until: float, robot: TrueRobot, rng: Rng) -> tuple[Happened, ...]:
        """Jumps in the reference's frame."""
        return tuple(
            Happened("reference_jump", time, jump.real, jump.imag, 0.0)
            for time, jump in self._jumps(until, rng)
        )
