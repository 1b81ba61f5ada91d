# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Start pose of a run, and the wheels' phases, from its reference."""

from __future__ import annotations

import cmath
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.robot_files.robot_file import RobotFile
from werrimbi_odom.files.run import Reference, Run
from werrimbi_odom.model.effect import AppliedEffect, view_of
from werrimbi_odom.model.phases import KNOWN_WELL_ENOUGH, Phase, learnable, phases_of_run
from werrimbi_odom.model.pose import Floats, Pose, between, compose
from werrimbi_odom.model.reference_measurement import Path, axle_of, shown
from werrimbi_odom.model.reference_view import View
from werrimbi_odom.model.trajectory import Trajectory, trajectory


class StartPose(NamedTuple):
    """Pose at the first row of ticks, and its origin in words."""

    pose: Pose
    """Pose of the axle's midpoint in the odometry frame, which is right-handed."""
    told: str
    shown: Pose
    """The same as measured by the reference, in its own frame."""


def start_pose(run: Run, robot_file: RobotFile) -> Pose:
    """Pose of the axle at the reference's first pose; see `start_of`."""
    return start_of(run, robot_file).pose


def start_of(run: Run, robot_file: RobotFile) -> StartPose:
    """Pose of the axle at the reference's first pose; the origin without a reference.

    If the robot file has the reference measure another point or axis, a mirrored frame or another
    time, the start is the pose at which the reference would measure its first pose.

    Quantities missing in the first row of the reference are taken from the next row that has them,
    propagated back by the odometry between the two. If no heading was measured, the start heading
    is the one that fits the odometry's path to the measured positions best (least squares), both
    rotated about the first of them.
    """
    view = view_of(robot_file.robot.effects)
    if run.reference is None:
        return _origin("the origin; there is no reference", view)
    reference = run.reference
    if view.mirrored:
        reference = replace(reference, y=-reference.y, yaw=-reference.yaw)
    right_handed = view._replace(mirrored=False)
    known = np.flatnonzero(reference.has_position | reference.has_yaw)
    if known.size == 0:
        return _origin("the origin; the reference measured nothing", view)
    first = known[0]
    if reference.has_position[first] and reference.has_yaw[first]:
        row = (reference.x[first], reference.y[first], reference.yaw[first])
        first_pose, told = Pose(*map(float, row)), "the reference's first pose"
    else:
        path = shown(driven(run, robot_file, Pose()), right_handed)
        first_pose, told = _pieced_together(reference, path, float(reference.time[first]))
    start = axle_of(first_pose, right_handed)
    if not reference.has_position.any():
        start = Pose(0.0, 0.0, start.yaw)
        first_pose = compose(start, Pose(view.ahead, view.left, view.yaw))
    elif min(view.delay, view.delay + view.heading_delay) < 0.0:
        start = _brought_back(run, robot_file, start, first_pose, right_handed)
    return StartPose(start, told + _seen_how(view), _mirrored(first_pose, view))


def _origin(told: str, view: View) -> StartPose:
    return StartPose(Pose(), told, _mirrored(Pose(view.ahead, view.left, view.yaw), view))


def _mirrored(pose: Pose, view: View) -> Pose:
    return Pose(pose.x, -pose.y, -pose.yaw) if view.mirrored else pose


def _seen_how(view: View) -> str:
    """Difference between the reference's pose and the axle's, in words."""
    parts = []
    if view.ahead or view.left:
        parts.append(f"{1e3 * view.ahead:.0f} mm ahead and {1e3 * view.left:.0f} mm to the left")
    if view.yaw:
        parts.append(f"turned by {np.degrees(view.yaw):.2f}°")
    if view.mirrored:
        parts.append("in a mirrored frame")
    return f", which it measures {', '.join(parts)}" if parts else ""


def driven(run: Run, robot_file: RobotFile, start: Pose) -> Trajectory:
    """Dead reckoning of a run with everything in the robot file."""
    return trajectory(
        robot_file.robot,
        run.ticks.time,
        run.ticks.left,
        run.ticks.right,
        start=start,
        tolerance=robot_file.tolerance,
        limits=robot_file.limits,
        channels=run.ticks.channels,
    )


def _brought_back(
    run: Run, robot_file: RobotFile, start: Pose, first_pose: Pose, view: View
) -> Pose:
    """Start at which a reference with early stamps would measure its first pose at once."""
    for _ in range(2):  # an effect may read the heading, so once is not quite enough
        path = shown(driven(run, robot_file, start), view)
        begin = Pose(float(path.x[0]), float(path.y[0]), float(path.yaw[0]))
        start = compose(first_pose, between(begin, start))
    return start


def _pieced_together(reference: Reference, driven: Path, begin: float) -> tuple[Pose, str]:
    """Pose at the time `begin`, from a drive that starts at the origin; and the method in words."""
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
        return Pose(0.0, 0.0, yaw_then + turned), "the origin with the first heading"
    then = complex(_path(driven, np.array([begin]))[0])
    back = complex(path[at[0]]) - then
    position = complex(positions[at[0]]) - cmath.rect(1.0, turned) * back
    return Pose(position.real, position.imag, yaw_then + turned), told


def _path(driven: Path, time: Floats) -> NDArray[np.complex128]:
    x, y = (np.interp(time, driven.time, values) for values in (driven.x, driven.y))
    return np.asarray(x + 1j * y)


def with_learnt_phases(run: Run, robot_file: RobotFile) -> tuple[RobotFile, tuple[str, ...]]:
    """Set the phases of a run in the robot file, estimated from its reference; also return remarks.

    Effects with an unknown phase are left out of dead reckoning; the remarks say so.
    """
    learnt: dict[str, Phase] = {}
    if learnable(robot_file.robot) and run.reference is not None:
        view = view_of(robot_file.robot.effects)
        reference = run.reference
        found = phases_of_run(
            robot_file.robot,
            run.ticks.time,
            run.ticks.left,
            run.ticks.right,
            reference.time - view.delay - view.heading_delay,
            -reference.yaw if view.mirrored else reference.yaw,
            limits=robot_file.limits,
            channels=run.ticks.channels,
        )
        learnt = {phase.effect: phase for phase in found}
    effects = tuple(_completed(item, learnt.get(item.name)) for item in robot_file.effects)
    remarks = tuple(
        _told(item, learnt.get(item.name)) for item in robot_file.effects if item.unknown
    )
    return replace(robot_file, effects=effects), remarks


def _completed(applied: AppliedEffect, phase: Phase | None) -> AppliedEffect:
    if phase is None or phase.std > KNOWN_WELL_ENOUGH:
        return applied
    return applied.learnt(**{phase.parameter: phase.value})


def _told(applied: AppliedEffect, phase: Phase | None) -> str:
    if phase is not None and phase.std <= KNOWN_WELL_ENOUGH:
        return (
            f"{phase.effect}: {phase.parameter} {phase.value:.3f} ± {phase.std:.3f} rad, learnt "
            "from the reference of this run"
        )
    what = " and ".join(applied.unknown)
    if phase is None or not np.isfinite(phase.std):
        why = "and there is nothing in this run to learn it from"
    else:
        why = f"and the reference of this run tells it only to {phase.std:.2f} rad"
    return f"{applied.name} is left out: its {what} is another in each run, {why}"
