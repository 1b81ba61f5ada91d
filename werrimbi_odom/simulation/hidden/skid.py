# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Skid steering: four driven wheels that slide in turns, by the force balance of their tyres."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..engine import Floats, Shift, Shifter, Stride
from ..robot import TrueRobot
from .hidden_effect import Peculiarity, Rng

LENGTH = 0.35
"""Distance from the rear to the front wheels [m]."""

SIDE_BY_SIDE = (0.4, 0.6)
"""Realistic range of the share of the load on the front wheels, and on the left ones."""


@dataclass(frozen=True)
class SkidSteer(Peculiarity):
    """Corrects the rolling of the engine's two wheels to the motion of four sliding tyres.

    The force of each tyre opposes its sliding on the floor and is proportional to its load and
    sliding velocity, with a larger factor across than along. The motion is that of zero total force
    and torque (without inertia).
    """

    multiplier: float
    """Turn by the wheels over turn of the body, at least 1; determines the lateral stiffness."""
    front: float = 0.5
    left: float = 0.5
    """Share of the load on the front and on the left wheels."""

    def __post_init__(self) -> None:
        if self.multiplier < 1.0:
            raise ValueError("wheels that skid turn a robot less than they roll: at least 1")

    def written(self, robot: TrueRobot) -> TrueRobot:
        """List two wheels per side, as the user knows their number."""
        return replace(robot, wheels_a_side=2)

    def shifter(self, robot: TrueRobot, rng: Rng) -> Shifter:
        """Motion by the force balance minus the motion by rolling of the engine's two wheels."""
        along, sideways, turn = self.spin(robot.wheel_separation)
        rolled = 2.0 / robot.wheel_separation

        def shift(stride: Stride) -> Shift:
            half = 0.5 * (stride.right - stride.left)
            back = (turn - rolled) * half
            # The engine rolled along an arc that turned too far; this corrects its chord.
            chord = 0.25 * (stride.left + stride.right) * back
            return Shift(along * half, sideways * half + chord, back)

        return shift

    def spin(self, base: float) -> Floats:
        """Motion (ahead, left, turn) for -1 m of the left wheels and 1 m of the right ones."""
        # The lost share of the turn is linear in the lateral stiffness.
        lost = [2.0 / base / self._balance(base, across)[2] for across in (1.0, 2.0)]
        across = 1.0 + (self.multiplier - lost[0]) / (lost[1] - lost[0])
        # Without any, no balance would say how it moves sideways.
        return self._balance(base, max(across, 1e-6))

    def _balance(self, base: float, across: float) -> Floats:
        """Solve for the motion at which the forces and torques of the four tyres sum to zero."""
        matrix, pushed = np.zeros((3, 3)), np.zeros(3)
        for x, of_length in ((0.5 * LENGTH, self.front), (-0.5 * LENGTH, 1.0 - self.front)):
            for y, of_width in ((0.5 * base, self.left), (-0.5 * base, 1.0 - self.left)):
                load = of_length * of_width
                # Sliding of the contact due to (ahead, left, turn) of the body, minus rolling.
                slides = np.array([[1.0, 0.0, -y], [0.0, 1.0, x]])
                rolls = np.array([-np.sign(y), 0.0])
                force = -load * np.diag([1.0, across])
                lever = np.array([[1.0, 0.0], [0.0, 1.0], [-y, x]])  # to force and torque
                matrix += lever @ force @ slides
                pushed += lever @ force @ rolls
        return np.asarray(np.linalg.solve(matrix, pushed))


def skid_steer(multiplier: float, rng: Rng) -> SkidSteer:
    """A robot with its centre of mass near the middle."""
    front, left = rng.uniform(*SIDE_BY_SIDE, 2)
    return SkidSteer(multiplier, float(front), float(left))
