# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A true wheel base or wheel radii that differ from the nominal ones."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ..robot import TrueRobot
from .hidden_effect import Peculiarity

PLAUSIBLE = 1.15
"""Largest plausible factor: beyond it, the error is in the robot file and not in the robot."""


def _of_robot_and_file(factor: float) -> tuple[float, float]:
    """Factors of the true robot, and of what its file says: the other one is 1."""
    return (factor, 1.0) if 1 / PLAUSIBLE <= factor <= PLAUSIBLE else (1.0, factor)


@dataclass(frozen=True)
class TrackWidth(Peculiarity):
    """The true wheel base is `multiplier` times the nominal one."""

    multiplier: float

    def robot(self, robot: TrueRobot) -> TrueRobot:
        """Change the true base, if the factor is plausible."""
        true, _ = _of_robot_and_file(self.multiplier)
        return replace(robot, wheel_separation=robot.wheel_separation * true)

    def written(self, robot: TrueRobot) -> TrueRobot:
        """Otherwise a wrong base in the robot file, for example half the base or millimetres."""
        base = robot.nominal.wheel_separation / _of_robot_and_file(self.multiplier)[1]
        return replace(robot, nominal=replace(robot.nominal, wheel_separation=base))


@dataclass(frozen=True)
class WheelRadiusScale(Peculiarity):
    """Both true radii are `multiplier` times the nominal one."""

    multiplier: float

    def robot(self, robot: TrueRobot) -> TrueRobot:
        """Change the true radii, if the factor is plausible."""
        true, _ = _of_robot_and_file(self.multiplier)
        left, right = robot.left_wheel_radius * true, robot.right_wheel_radius * true
        return replace(robot, left_wheel_radius=left, right_wheel_radius=right)

    def written(self, robot: TrueRobot) -> TrueRobot:
        """Otherwise a wrong radius in the robot file, for example the diameter or millimetres."""
        radius = robot.nominal.wheel_radius / _of_robot_and_file(self.multiplier)[1]
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
