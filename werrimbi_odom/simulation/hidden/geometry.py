# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A robot whose base or radii are not what its maker believes."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ..robot import TrueRobot
from .peculiarity import Peculiarity

PLAUSIBLE = 1.15
"""A factor beyond this is a slip of the pen in the robot file, not a slip of the workshop."""


def _believable(factor: float) -> bool:
    return 1 / PLAUSIBLE <= factor <= PLAUSIBLE


@dataclass(frozen=True)
class TrackWidth(Peculiarity):
    """The true base is `multiplier` times the believed one."""

    multiplier: float

    def robot(self, robot: TrueRobot) -> TrueRobot:
        """Wheels mounted further apart or closer, where that is believable."""
        if not _believable(self.multiplier):
            return robot
        return replace(robot, wheel_separation=robot.wheel_separation * self.multiplier)

    def written(self, robot: TrueRobot) -> TrueRobot:
        """Else half the base, or its millimetres, in the robot file."""
        if _believable(self.multiplier):
            return robot
        base = robot.nominal.wheel_separation / self.multiplier
        return replace(robot, nominal=replace(robot.nominal, wheel_separation=base))


@dataclass(frozen=True)
class WheelRadiusScale(Peculiarity):
    """Both true radii are `multiplier` times the believed one."""

    multiplier: float

    def robot(self, robot: TrueRobot) -> TrueRobot:
        """Larger or smaller wheels, where that is believable."""
        if not _believable(self.multiplier):
            return robot
        return replace(
            robot,
            left_wheel_radius=robot.left_wheel_radius * self.multiplier,
            right_wheel_radius=robot.right_wheel_radius * self.multiplier,
        )

    def written(self, robot: TrueRobot) -> TrueRobot:
        """Else a diameter, or millimetres, in the robot file."""
        if _believable(self.multiplier):
            return robot
        radius = robot.nominal.wheel_radius / self.multiplier
        return replace(robot, nominal=replace(robot.nominal, wheel_radius=radius))


@dataclass(frozen=True)
class UnequalWheelRadii(Peculiarity):
    """The right wheel is `ratio` times as large as the left one (UMBmark's E_d); same mean."""

    ratio: float

    def robot(self, robot: TrueRobot) -> TrueRobot:
        """One wheel larger, the other smaller."""
        return replace(
            robot,
            left_wheel_radius=robot.left_wheel_radius * 2 / (1 + self.ratio),
            right_wheel_radius=robot.right_wheel_radius * 2 * self.ratio / (1 + self.ratio),
        )
