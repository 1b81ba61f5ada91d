# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A true wheel base or wheel radii that differ from the nominal ones."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ..robot import TrueRobot
from .hidden_effect import Peculiarity

PLAUSIBLE = 1.15
"""Largest plausible factor: beyond it, the error is in the robot file and not in the robot."""


def _believable(factor: float) -> bool:
    return 1 / PLAUSIBLE <= factor <= PLAUSIBLE


@dataclass(frozen=True)
class TrackWidth(Peculiarity):
    """The true wheel base is `multiplier` times the nominal one."""

    multiplier: float

    def robot(self, robot: TrueRobot) -> TrueRobot:
        """Change the true base, if the factor is plausible."""
        if not _believable(self.multiplier):
            return robot
        return replace(robot, wheel_separation=robot.wheel_separation * self.multiplier)

    def written(self, robot: TrueRobot) -> TrueRobot:
        """Otherwise a wrong base in the robot file, for example half the base or millimetres."""
        if _believable(self.multiplier):
            return robot
        base = robot.nominal.wheel_separation / self.multiplier
        return replace(robot, nominal=replace(robot.nominal, wheel_separation=base))


@dataclass(frozen=True)
class WheelRadiusScale(Peculiarity):
    """Both true radii are `multiplier` times the nominal one."""

    multiplier: float

    def robot(self, robot: TrueRobot) -> TrueRobot:
        """Change the true radii, if the factor is plausible."""
        if not _believable(self.multiplier):
            return robot
        return replace(
            robot,
            left_wheel_radius=robot.left_wheel_radius * self.multiplier,
            right_wheel_radius=robot.right_wheel_radius * self.multiplier,
        )

    def written(self, robot: TrueRobot) -> TrueRobot:
        """Otherwise a wrong radius in the robot file, for example the diameter or millimetres."""
        if _believable(self.multiplier):
            return robot
        radius = robot.nominal.wheel_radius / self.multiplier
        return replace(robot, nominal=replace(robot.nominal, wheel_radius=radius))


@dataclass(frozen=True)
class UnequalWheelRadii(Peculiarity):
    """The right radius is `ratio` times the left one (UMBmark's E_d), with the same mean."""

    ratio: float

    def robot(self, robot: TrueRobot) -> TrueRobot:
        """Increase one radius and decrease the other."""
        return replace(
            robot,
            left_wheel_radius=robot.left_wheel_radius * 2 / (1 + self.ratio),
            right_wheel_radius=robot.right_wheel_radius * 2 * self.ratio / (1 + self.ratio),
        )
