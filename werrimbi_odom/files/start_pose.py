# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Where dead reckoning of a run begins: at the reference's first pose."""

from __future__ import annotations

import cmath
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.robot_file import RobotFile
from werrimbi_odom.files.run import Reference, Run
from werrimbi_odom.model.pose import Floats, Pose
from werrimbi_odom.model.trajectory import Trajectory, trajectory


class Start(NamedTuple):
    """The pose at the first row of ticks, and in words where it comes from."""

    pose: Pose
    told: str


def start_pose(run: Run, robot_file: RobotFile) -> Pose:
    """The reference's first pose; see `start_of`."""
    return start_of(run, robot_file).pose


def start_of(run: Run, robot_file: RobotFile) -> Start:
    """The reference's first pose; the origin where nothing was measured.

    What the first row of the reference leaves out is taken from the next row that has it, brought
    back by the odometry between the two. Where no heading was measured at all, it is the one with
    which the odometry's path fits the measured positions best, in least squares, both turned about
    the first of them.
    """
    reference = run.reference
    if reference is None:
        return Start(Pose(), "the origin; there is no reference")
    known = np.flatnonzero(reference.has_position | reference.has_yaw)
    if known.size == 0:
        return Start(Pose(), "the origin; the reference measured nothing")
    first = known[0]
    if reference.has_position[first] and reference.has_yaw[first]:
        row = (reference.x[first], reference.y[first], reference.yaw[first])
        return Start(Pose(*map(float, row)), "the reference's first pose")
    driven = trajectory(
        robot_file.robot,
        run.ticks.time,
        run.ticks.left,
        run.ticks.right,
        tolerance=robot_file.tolerance,
        limits=robot_file.limits,
    )
    return _pieced_together(reference, driven, float(reference.time[first]))


def _pieced_together(reference: Reference, driven: Trajectory, begin: float) -> Start:
    """The pose at the time `begin`, from a path that was driven from the origin."""
    at, facing = np.flatnonzero(reference.has_position), np.flatnonzero(reference.has_yaw)
    positions = reference.x + 1j * reference.y
    path = _path(driven, reference.time)
    yaw_then = float(np.interp(begin, driven.time, driven.yaw))
    if facing.size:
        yaw_seen = np.interp(reference.time[facing[0]], driven.time, driven.yaw)
        turned = float(reference.yaw[facing[0]] - yaw_seen)
        told = "the reference's first position and first heading"
    else:
        seen, reckoned = positions[at] - positions[at[0]], path[at] - path[at[0]]
        match = complex(np.vdot(reckoned, seen))
        turned = cmath.phase(match) if match else -yaw_then
        told = (
            "the reference's first position; no heading was measured, so the start heading is "
            "the one that fits the path to the measured positions best (least squares)"
            if match
            else "the reference's first position, heading 0: none was measured, nor any travel"
        )
    if at.size == 0:
        return Start(Pose(0.0, 0.0, yaw_then + turned), "the origin with the first heading")
    then = complex(_path(driven, np.array([begin]))[0])
    back = complex(path[at[0]]) - then
    position = complex(positions[at[0]]) - cmath.rect(1.0, turned) * back
    return Start(Pose(position.real, position.imag, yaw_then + turned), told)


def _path(driven: Trajectory, time: Floats) -> NDArray[np.complex128]:
    x, y = (np.interp(time, driven.time, values) for values in (driven.x, driven.y))
    return np.asarray(x + 1j * y)
