# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Wheel travel reconstructed from odometry, for drivers that publish nothing else."""

from __future__ import annotations

from array import array
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.bag import BagMessage, stamp_of
from werrimbi_odom.files.bag_reference import planar
from werrimbi_odom.files.robot_file import RobotFile
from werrimbi_odom.files.run import Ticks, integrated
from werrimbi_odom.model.pose import Floats

TOLD = (
    "the wheels' travel is turned back from the poses of the robot's own odometry, by wheel_radius "
    "and wheel_separation of the robot file without their multipliers: these must be what the "
    "driver itself works with; where it takes its heading from a gyro, so does this"
)
FROM_TWIST = "its poses never change, so its twist was integrated"


class OdometryTurnedBack:
    """Collects odometry, and computes the wheel counts that would produce it."""

    def __init__(self, path: Path, topic: str, robot_file: RobotFile) -> None:
        self._place = f"{path}: {topic}"
        self._robot = robot_file.robot
        self._time = array("d")
        self._poses = array("d")
        self._twists = array("d")

    def take(self, message: BagMessage) -> None:
        """Add a message."""
        content = message.content
        self._time.append(stamp_of(message))
        self._poses.extend(planar(content.pose.pose.position, content.pose.pose.orientation))
        twist = content.twist.twist
        self._twists.extend((float(twist.linear.x), float(twist.angular.z)))

    def ticks(self) -> tuple[Ticks, list[str]]:
        """Counts of both wheels, from zero, and the method in words."""
        time = np.array(self._time)
        x, y, yaw = np.array(self._poses).reshape(-1, 3).T
        speed, rate = np.array(self._twists).reshape(-1, 2).T
        words = [TOLD]
        if not np.isfinite(x + y + yaw).any():
            raise InputError(f"{self._place}: no message holds a finite pose")
        if not (np.ptp(x[np.isfinite(x)]) or np.ptp(y[np.isfinite(y)])) and np.any(speed):
            along, turned = integrated(time, speed), integrated(time, rate)
            words.append(FROM_TWIST)
        else:
            whole = np.isfinite(x + y + yaw)
            time = time[whole]
            along, turned = _driven(x[whole], y[whole], yaw[whole])
        robot = self._robot
        half = 0.5 * robot.wheel_separation * turned
        left, right = (
            (along + sign * half) * (per_turn / (2.0 * np.pi * robot.wheel_radius))
            for sign, per_turn in (
                (-1.0, robot.left_ticks_per_revolution),
                (1.0, robot.right_ticks_per_revolution),
            )
        )
        return Ticks(time, left, right), words


def _driven(x: Floats, y: Floats, yaw: Floats) -> tuple[Floats, Floats]:
    """Cumulative path of the axle's midpoint, backwards negative, and turn at each pose.

    Between two poses the robot drove an arc; its length follows from chord and turn.
    """
    steps = np.diff(x) + 1j * np.diff(y)
    turns: NDArray[np.float64] = np.angle(np.exp(1j * np.diff(yaw)))
    heading = np.exp(1j * (yaw[:-1] + 0.5 * turns))
    chord = np.abs(steps) * np.where((steps * heading.conj()).real < 0.0, -1.0, 1.0)
    arc = chord / np.sinc(0.5 * turns / np.pi)
    return tuple(np.concatenate([[0.0], np.cumsum(part)]) for part in (arc, turns))  # type: ignore[return-value]
