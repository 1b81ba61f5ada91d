# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The obvious slow odometry that checks the clever one: textbook propagation, message by message.

Nothing of `werrimbi_odom` is used but the numbers in `Robot`: wheel travel from counts by hand, the
pose along each message's arc, and P <- J P J' + G Q G' at every message, with 3 x 3 matrices. There
are no pieces, no closed form and no cases. What a message adds is taken at its middle; `substeps`
splits messages that are too long for that.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from werrimbi_odom.model.robot import Robot


@dataclass
class PlainTwin:
    """Pose (x, y, yaw) and its 3 x 3 covariance, one wheel step after the other."""

    robot: Robot
    substeps: int = 1

    def __post_init__(self) -> None:
        robot = self.robot
        self.pose = np.zeros(3)
        self.covariance = np.zeros((3, 3))
        self.track = robot.wheel_separation * robot.wheel_separation_multiplier
        around = 2.0 * math.pi * robot.wheel_radius
        self.left_tick = (
            around * robot.left_wheel_radius_multiplier / robot.left_ticks_per_revolution
        )
        self.right_tick = (
            around * robot.right_wheel_radius_multiplier / robot.right_ticks_per_revolution
        )

    def count(self, left: float, right: float) -> None:
        """Take a message by which the counters have gone on by so many counts."""
        for _ in range(self.substeps):
            self.roll(
                left * self.left_tick / self.substeps, right * self.right_tick / self.substeps
            )

    def roll(self, left: float, right: float) -> None:
        """Let the wheels roll by `left` and `right` metres, on one arc."""
        along, turn = 0.5 * (left + right), (right - left) / self.track
        middle = self.pose[2] + 0.5 * turn
        chord = along * (math.sin(0.5 * turn) / (0.5 * turn) if turn else 1.0)
        dx, dy = chord * math.cos(middle), chord * math.sin(middle)
        by_pose = np.array([[1.0, 0.0, -dy], [0.0, 1.0, dx], [0.0, 0.0, 1.0]])
        by_travel_and_turn = np.array(
            [[math.cos(middle), -0.5 * dy], [math.sin(middle), 0.5 * dx], [0.0, 1.0]]
        )
        by_wheels = by_travel_and_turn @ np.array(
            [[0.5, 0.5], [-1.0 / self.track, 1.0 / self.track]]
        )
        wheels = np.diag(
            [
                self.robot.left_wheel_noise**2 * abs(left),
                self.robot.right_wheel_noise**2 * abs(right),
            ]
        )
        self.covariance = by_pose @ self.covariance @ by_pose.T + by_wheels @ wheels @ by_wheels.T
        self.pose = self.pose + np.array([dx, dy, turn])


def plain_run(
    robot: Robot, left: np.ndarray, right: np.ndarray, substeps: int = 1
) -> tuple[np.ndarray, np.ndarray]:
    """Poses, shape (n, 3), and covariances, shape (n, 3, 3), after each message but the first.

    `left` and `right` are cumulative counts that neither wrap nor are reset.
    """
    twin = PlainTwin(robot, substeps)
    poses, covariances = [], []
    for step in zip(np.diff(left).tolist(), np.diff(right).tolist(), strict=True):
        twin.count(*step)
        poses.append(twin.pose)
        covariances.append(twin.covariance)
    return np.array(poses).reshape(-1, 3), np.array(covariances).reshape(-1, 3, 3)
