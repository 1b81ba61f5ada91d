# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What others do at every tick, for the benchmarks: P <- J P J' + G Q G' in plain Python floats.

As fast as Python goes without arrays: `test.plain_twin` does the same with 3 x 3 matrices.
"""

from __future__ import annotations

import math

from werrimbi_odom.model.covariance import PoseCovariance
from werrimbi_odom.model.robot import Robot


class PerTick:
    """Pose and covariance, one tick after the other."""

    def __init__(self, robot: Robot) -> None:
        self.robot = robot
        self.x = self.y = self.yaw = 0.0
        self.covariance: PoseCovariance[float] = PoseCovariance(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)

    def roll(self, left: float, right: float) -> None:
        """Let the wheels roll by `left` and `right` metres."""
        robot = self.robot
        track = robot.track
        along, turn = 0.5 * (left + right), (right - left) / track
        half = 0.5 * turn
        cos, sin = math.cos(self.yaw + half), math.sin(self.yaw + half)
        chord = along * (math.sin(half) / half if half else 1.0)
        dx, dy = chord * cos, chord * sin
        left_noise = robot.left_wheel_noise**2 * abs(left)
        right_noise = robot.right_wheel_noise**2 * abs(right)
        # G: how the pose goes with the travel of each wheel.
        gl = (0.5 * cos + 0.5 * dy / track, 0.5 * sin - 0.5 * dx / track, -1.0 / track)
        gr = (0.5 * cos - 0.5 * dy / track, 0.5 * sin + 0.5 * dx / track, 1.0 / track)
        xx, xy, xyaw, yy, yyaw, yawyaw = self.covariance
        self.covariance = PoseCovariance(
            xx
            - 2.0 * dy * xyaw
            + dy * dy * yawyaw
            + left_noise * gl[0] ** 2
            + right_noise * gr[0] ** 2,
            xy
            + dx * xyaw
            - dy * yyaw
            - dx * dy * yawyaw
            + left_noise * gl[0] * gl[1]
            + right_noise * gr[0] * gr[1],
            xyaw - dy * yawyaw + left_noise * gl[0] * gl[2] + right_noise * gr[0] * gr[2],
            yy
            + 2.0 * dx * yyaw
            + dx * dx * yawyaw
            + left_noise * gl[1] ** 2
            + right_noise * gr[1] ** 2,
            yyaw + dx * yawyaw + left_noise * gl[1] * gl[2] + right_noise * gr[1] * gr[2],
            yawyaw + left_noise * gl[2] ** 2 + right_noise * gr[2] ** 2,
        )
        self.x, self.y, self.yaw = self.x + dx, self.y + dy, self.yaw + turn


def per_tick(robot: Robot, left: list[int], right: list[int]) -> PerTick:
    """A whole record of cumulative counts."""
    state = PerTick(robot)
    for row in range(1, len(left)):
        state.roll(
            (left[row] - left[row - 1]) * robot.left_tick,
            (right[row] - right[row - 1]) * robot.right_tick,
        )
    return state
