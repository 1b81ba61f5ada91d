# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`phases`, online: steps of the odometry and measured headings are added as they arrive."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from werrimbi_odom.model.driven_motion import DrivenStep
from werrimbi_odom.model.phases import HeadingRows, Phase, Sample, Turning, learnable
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot


class _Node(NamedTuple):
    time: float
    sums: Floats


class PhaseLearner:
    """Estimates the phases of a robot's effects during a drive.

    Steps of the odometer and readings of the reference may arrive in any order, stamped by one
    clock. The memory is bounded. `robot`: with at least one `learnable` effect.
    """

    MEMORY = 1000
    """Largest number of steps, and of readings, that wait for each other."""

    def __init__(self, robot: Robot) -> None:
        self.effects = learnable(robot)
        self._rows = HeadingRows(self.effects)
        self._turning = Turning(robot, self.effects)
        self._nodes: deque[_Node] = deque(maxlen=self.MEMORY)
        self._waiting: deque[tuple[int, float, float]] = deque(maxlen=self.MEMORY)
        self._chain = 0
        self._rate: tuple[float, float, float] | None = None

    def retune(self, robot: Robot) -> None:
        """Change the robot's parameter values; the estimates are kept.

        Phases to be estimated still count as unknown, whatever values the robot has for them.
        """
        unknown = {applied.name: applied.unknown for applied in self.effects}
        effects = tuple(replace(e, unknown=unknown.get(e.name, e.unknown)) for e in robot.effects)
        self.effects = self._rows.effects = tuple(e for e in effects if e.name in unknown)
        self._turning = Turning(replace(robot, effects=effects), self.effects)

    def step(self, time: float, step: DrivenStep) -> None:
        """Add a step of the odometer that ends at `time` [s]."""
        drive = step.drive
        begin = time - drive.duration
        if not self._nodes or abs(self._nodes[-1].time - begin) > 1e-6:
            self.interrupt()
            self._nodes.clear()
            self._waiting.clear()  # the clock was set: waiting readings have stamps of the old time
            nothing = [0.0] * (1 + 2 * len(self.effects))
            angles = [drive.left_angle.start, drive.right_angle.start]
            self._nodes.append(_Node(begin, np.array([*nothing, *angles])))
        turned = [drive.left_angle.change, drive.right_angle.change]
        change = np.array([*self._turning.of(step.raw, drive), *turned])
        self._nodes.append(_Node(time, self._nodes[-1].sums + change))
        self._meet()

    def see_yaw(self, time: float, yaw: float) -> None:
        """Add a measured heading [rad]."""
        if math.isfinite(time) and math.isfinite(yaw):
            self._waiting.append((self._chain, time, yaw))
            self._meet()

    def see_rate(self, time: float, rate: float) -> None:
        """Add a measured yaw rate [rad/s], integrated by the trapezoidal rule.

        One with the stamp of the last is the same, told again.
        """
        if not (math.isfinite(time) and math.isfinite(rate)):
            return
        if self._rate is not None and time == self._rate[0]:
            return
        if self._rate is None or not 0.0 < time - self._rate[0] < 0.5:
            self.interrupt()
            self._rate = (time, rate, 0.0)
        else:
            before, last, yaw = self._rate
            self._rate = (time, rate, yaw + 0.5 * (last + rate) * (time - before))
        self.see_yaw(time, self._rate[2])

    def interrupt(self) -> None:
        """Start a new chain: headings are not compared across this instant."""
        self._chain += 1

    def phases(self) -> tuple[Phase, ...]:
        """Estimate of each phase so far; an unknown one has an infinite standard deviation."""
        return self._rows.phases()

    def _meet(self) -> None:
        """Match readings with the steps at their times."""
        while self._waiting and self._nodes and self._waiting[0][1] <= self._nodes[-1].time:
            chain, time, yaw = self._waiting.popleft()
            while len(self._nodes) > 2 and self._nodes[1].time <= time:
                self._nodes.popleft()
            before, after = self._nodes[0], self._nodes[min(1, len(self._nodes) - 1)]
            if before.time <= time <= after.time and after.time > before.time:
                share = (time - before.time) / (after.time - before.time)
                sums = before.sums + share * (after.sums - before.sums)
                self._rows.take(Sample(chain, time, yaw, sums))
