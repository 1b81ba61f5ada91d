# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The engine's robot driven by a Driver on its own odometry, faster than time: no ROS."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from werrimbi_odom.driving.driver import Driver
from werrimbi_odom.driving.limits import Area, Limits, OdometryReading, Watch
from werrimbi_odom.driving.plan import ManoeuvrePlan
from werrimbi_odom.files.robot_files.robot_file import RobotFile
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.model.end_of_piece import PieceTolerance
from werrimbi_odom.model.odometer import Odometer
from werrimbi_odom.model.pose import Pose
from werrimbi_odom.simulation import LiveRobot

LIMITS = Limits(0.3, 1.0, 0.5, 1.5)
"""Those that drive_node has by default."""
TICKS, POSES = 50, 20
"""Readings a second, unless told otherwise."""
STEPS = 200
"""The engine's."""
STANDS = 1.0
"""Before and after each drive [s]: drive_node records on for a while too."""


class InEngine:
    """A robot that drive after drive is driven through plans; odom_node believes its `file`."""

    def __init__(
        self, robot: LiveRobot, file: RobotFile, ticks: int = TICKS, poses: int = POSES
    ) -> None:
        self._robot, self._file = robot, file
        self._per_tick, self._per_pose = STEPS // ticks, STEPS // poses
        self._drives = 0

    def drive(self, plan: ManoeuvrePlan, limits: Limits = LIMITS) -> tuple[Run, Driver]:
        """What is recorded of a drive, and how it ended."""
        robot, odometer = self._robot, Odometer(self._file.robot, PieceTolerance())
        watch = Watch(deviation=0.5, turned_off=1.0)
        driver = Driver(plan, limits, Area(), watch)
        pose, lag = Pose(), max(robot.counters_lag, robot.reference_lag)
        ticks: list[tuple[float, float, float]] = []
        poses: list[tuple[float, ...]] = []
        begun = stood = round(robot.time * STEPS)
        step = begun
        while driver.state in ("waiting", "driving") or step < stood + STANDS * STEPS:
            robot.command(*driver.command)
            robot.advance()
            step += 1
            at = round(step - lag * STEPS) - begun
            time = (begun + at) / STEPS
            if at > 0 and at % self._per_pose == 0:
                poses.append((time, *robot.reference(time)))
            if at > 0 and at % self._per_tick == 0:
                ticks.append((time, *robot.counters(time)))
                estimate = odometer.update(*ticks[-1])
                pose = pose if estimate is None else estimate.pose
                driver.odometry(OdometryReading(time, 0.0, pose), robot.time)
            if driver.state == "waiting" and step == begun + STANDS * STEPS:
                driver.start(robot.time)
            if driver.state in ("waiting", "driving"):
                driver.tick(robot.time)
                stood = step
        self._drives += 1
        name = f"{plan.name}_{self._drives}"
        time, left, right = (np.array(column) for column in zip(*ticks, strict=True))
        measured = (np.array(column) for column in zip(*poses, strict=True))
        return Run(name, Path(name), Ticks(time, left, right), Reference(*measured)), driver
