# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Four driven wheels that skid as the robot turns, by the balance of their tyres' forces."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..engine import Shift, Shifter, Stride
from ..robot import TrueRobot
from .peculiarity import Peculiarity

LENGTH = 0.35
"""From the rear wheels to the front ones [m]."""

SIDE_BY_SIDE = (0.4, 0.6)
"""Share of the load on the front wheels, and on the left ones: what robots have."""


@dataclass(frozen=True)
class SkidSteer(Peculiarity):
    """The engine's two wheels roll; four tyres, of which none can roll round a turn, push it back.

    Each tyre pushes against its sliding over the floor in proportion to its load and its sliding
    speed, across more than along, and the robot moves so that the forces and their torque are in
    balance (no inertia: that is their sum of zero, solved for the motion).

    Parameters
    ----------
    multiplier : float
        Turning by the wheels over turning of the body, above 1; says how stiff tyres are across.
    front, left : float
        Share of the load on the front and on the left wheels.
    """

    multiplier: float
    front: float = 0.5
    left: float = 0.5

    def __post_init__(self) -> None:
        if self.multiplier <= 1.0:
            raise ValueError("wheels that skid turn a robot less than they roll: above 1")

    def written(self, robot: TrueRobot) -> TrueRobot:
        """The user knows how many wheels there are, and lists them."""
        return replace(robot, wheels_a_side=2)

    def shifter(self, robot: TrueRobot, rng: np.random.Generator) -> Shifter:
        """What the balance moves the body by, less what the engine's two wheels rolled it."""
        along, sideways, turn = self.spin(robot.wheel_separation)
        rolled = 2.0 / robot.wheel_separation

        def shift(stride: Stride) -> Shift:
            half = 0.5 * (stride.right - stride.left)
            back = (turn - rolled) * half
            # The way of this period was rolled on an arc that turned too far: its chord comes back.
            chord = 0.25 * (stride.left + stride.right) * back
            return Shift(along * half, sideways * half + chord, back)

        return shift

    def spin(self, base: float) -> NDArray[np.float64]:
        """Motion ahead, to the left and turn for -1 m of the left and 1 m of the right wheels."""
        # How much of the turning is lost grows straight with the stiffness across.
        lost = [2.0 / base / self._balance(base, across)[2] for across in (1.0, 2.0)]
        across = 1.0 + (self.multiplier - lost[0]) / (lost[1] - lost[0])
        return self._balance(base, across)

    def _balance(self, base: float, across: float) -> NDArray[np.float64]:
        """Solve for the motion at which the four tyres' forces and torque add up to nothing."""
        matrix, pushed = np.zeros((3, 3)), np.zeros(3)
        for x, of_length in ((0.5 * LENGTH, self.front), (-0.5 * LENGTH, 1.0 - self.front)):
            for y, of_width in ((0.5 * base, self.left), (-0.5 * base, 1.0 - self.left)):
                load = of_length * of_width
                # Sliding of the contact, by (ahead, left, turn) of the body; rolling is taken off.
                slides = np.array([[1.0, 0.0, -y], [0.0, 1.0, x]])
                rolls = np.array([-np.sign(y), 0.0])
                force = -load * np.diag([1.0, across])
                lever = np.array([[1.0, 0.0], [0.0, 1.0], [-y, x]])  # force to force and torque
                matrix += lever @ force @ slides
                pushed += lever @ force @ rolls
        return np.asarray(np.linalg.solve(matrix, pushed))


def skid_steer(multiplier: float, rng: np.random.Generator) -> SkidSteer:
    """A robot with its load somewhere about the middle."""
    front, left = rng.uniform(*SIDE_BY_SIDE, 2)
    return SkidSteer(multiplier, float(front), float(left))
