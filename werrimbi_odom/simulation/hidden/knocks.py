# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What happens at an instant, now and then: a push, a kick, a bump, a slip, a reference that jumps.

When, how often and to which side is drawn for each drive anew; truth.json tells it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from ..engine import PERIOD, Shift, Shifter, Stride
from ..recording import Happened, Recording
from ..robot import TrueRobot
from .peculiarity import Peculiarity

Kind = Literal["push", "heading_kick", "bump", "wheel_slip"]

FIRST, APART = 3.0, 5.0
"""Time before the first one, and between two at the least [s]."""


def instants(every: float, until: float, rng: np.random.Generator) -> list[tuple[float, float]]:
    """When things happen, and to which side (+1 or -1): at random, `every` so often on average."""
    found = []
    time = FIRST + float(rng.uniform(0.0, every))
    while time < until:
        found.append((time, float(rng.choice([-1.0, 1.0]))))
        time += APART + float(rng.exponential(every - APART))
    return found


@dataclass(frozen=True)
class Knock(Peculiarity):
    """The robot is moved at once, and no wheel turned for it.

    Parameters
    ----------
    kind : str
        "push": sideways; "heading_kick": its heading; "bump": along; "wheel_slip": one wheel, left
        or right, rolls less than it turns.
    size : float
        [m], or [rad] of a kick.
    lasts : float
        How long it takes [s].
    every : float
        Mean time between two of them [s].
    """

    kind: Kind
    size: float
    lasts: float = 0.1
    every: float = 25.0

    def _moved(self, side: float, robot: TrueRobot) -> Shift:
        """By one of them."""
        if self.kind == "push":
            return Shift(0.0, side * self.size, 0.0)
        if self.kind == "heading_kick":
            return Shift(0.0, 0.0, side * self.size)
        if self.kind == "bump":
            return Shift(side * self.size, 0.0, 0.0)
        return Shift(-self.size / 2, 0.0, side * self.size / robot.wheel_separation)

    def shifter(self, robot: TrueRobot, rng: np.random.Generator) -> Shifter:
        """Move it by equal parts for as long as a knock lasts."""
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

    def happened(
        self, until: float, robot: TrueRobot, rng: np.random.Generator
    ) -> tuple[Happened, ...]:
        """In their middle."""
        return tuple(
            Happened(self.kind, time + self.lasts / 2, *self._moved(side, robot))
            for time, side in instants(self.every, until, rng)
        )


@dataclass(frozen=True)
class ReferenceJump(Peculiarity):
    """The reference takes another place for the robot's, for one pose or from then on.

    Parameters
    ----------
    size : float
        [m]
    stays : bool
        Whether it goes on from there; else the next pose is right again.
    every : float
        Mean time between two [s].
    """

    size: float
    stays: bool
    every: float = 25.0

    def _jumps(self, until: float, rng: np.random.Generator) -> list[tuple[float, float]]:
        """When, and in which direction [rad]."""
        found = instants(self.every, until, rng)
        return [(time, float(rng.uniform(-math.pi, math.pi))) for time, _ in found]

    def recording(
        self, recording: Recording, robot: TrueRobot, rng: np.random.Generator
    ) -> Recording:
        """Move poses of the reference."""
        x, y = recording.reference_x_m.copy(), recording.reference_y_m.copy()
        for time, direction in self._jumps(float(recording.t_s[-1]), rng):
            first = int(np.searchsorted(recording.reference_t_s, time))
            rows = slice(first, None if self.stays else first + 1)
            x[rows] += self.size * math.cos(direction)
            y[rows] += self.size * math.sin(direction)
        return replace(recording, reference_x_m=x, reference_y_m=y)

    def happened(
        self, until: float, robot: TrueRobot, rng: np.random.Generator
    ) -> tuple[Happened, ...]:
        """In the reference's frame."""
        return tuple(
            Happened(
                "reference_jump",
                time,
                self.size * math.cos(direction),
                self.size * math.sin(direction),
                0.0,
            )
            for time, direction in self._jumps(until, rng)
        )
