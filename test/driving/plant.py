# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A robot on paper that is driven by a Driver: it obeys with a delay, and its wheels err."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from werrimbi_odom.driving.driver import Driver
from werrimbi_odom.driving.limits import STILL, Command, OdometryReading
from werrimbi_odom.model.motion import BodyMotion, displacement
from werrimbi_odom.model.pose import Pose


@dataclass
class Plant:
    """What obeys the commands, every 20 ms."""

    lag: int = 2
    """Periods until a command acts."""
    noise: float = 0.0
    """Share by which each step of travel and turn scatters."""
    seed: int = 0
    period: float = 0.02
    pose: Pose = field(default_factory=lambda: Pose(0.3, -0.2, 0.7))
    time: float = 10.0
    sent: list[Command] = field(default_factory=list)
    poses: list[Pose] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._rng = np.random.default_rng(self.seed)

    def step(
        self,
        driver: Driver,
        spoil: Callable[[OdometryReading], OdometryReading | None] | None = None,
    ) -> None:
        """One period: the robot moves, the odometry comes (or what became of it)."""
        acting = self.sent[-self.lag] if len(self.sent) >= self.lag else STILL
        scatter = 1.0 + self.noise * self._rng.standard_normal(2)
        turn = acting.yaw_rate * self.period * scatter[1]
        motion = BodyMotion(acting.speed * self.period * scatter[0], 0.0, turn)
        x, y = displacement(motion, self.pose.yaw)
        yaw = math.remainder(self.pose.yaw + turn, 2.0 * math.pi)
        self.pose = Pose(self.pose.x + float(x), self.pose.y + float(y), float(yaw))
        self.time += self.period
        reading: OdometryReading | None = OdometryReading(self.time, 0.005, self.pose)
        if spoil is not None:
            assert reading is not None
            reading = spoil(reading)
        if reading is not None:
            driver.odometry(reading, self.time)
        driver.tick(self.time)
        self.sent.append(driver.command)
        self.poses.append(self.pose)

    def rest(self, driver: Driver, periods: int = 30) -> None:
        """Let the odometry come for a while."""
        for _ in range(periods):
            self.step(driver)

    def drive(self, driver: Driver, most: float = 600.0) -> None:
        """Start, and drive to the end of it [s]."""
        self.rest(driver)
        driver.start(self.time)
        until = self.time + most
        while driver.state == "driving" and self.time < until:
            self.step(driver)
