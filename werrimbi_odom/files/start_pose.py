# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Where dead reckoning of a run begins: at the reference's first pose."""

from __future__ import annotations

import numpy as np

from werrimbi_odom.files.robot_file import RobotFile
from werrimbi_odom.files.run import Run
from werrimbi_odom.model.pose import Pose
from werrimbi_odom.model.trajectory import trajectory


def start_pose(run: Run, robot_file: RobotFile) -> Pose:
    """The reference's first pose; the origin where nothing was measured.

    Where no heading was measured, the one with which the odometry's path fits the measured
    positions best, in least squares, both turned about the first of them.
    """
    reference = run.reference
    if reference is None:
        return Pose()
    at = np.flatnonzero(reference.has_position)
    x, y = (float(reference.x[at[0]]), float(reference.y[at[0]])) if at.size else (0.0, 0.0)
    facing = np.flatnonzero(reference.has_yaw)
    if facing.size:
        return Pose(x, y, float(reference.yaw[facing[0]]))
    if at.size < 2:
        return Pose(x, y, 0.0)
    driven = trajectory(
        robot_file.robot,
        run.ticks.time,
        run.ticks.left,
        run.ticks.right,
        tolerance=robot_file.tolerance,
        limits=robot_file.limits,
    )
    when = reference.time[at]
    path = np.interp(when, driven.time, driven.x) + 1j * np.interp(when, driven.time, driven.y)
    seen = reference.x[at] + 1j * reference.y[at]
    match = np.sum(np.conj(path - path[0]) * (seen - seen[0]))
    return Pose(x, y, float(np.angle(match)))
