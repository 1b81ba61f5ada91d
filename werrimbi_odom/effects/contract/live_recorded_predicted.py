# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The law that a drive gives equal results live, recorded and predicted.

Live, each step has its start pose. A recorded run is computed at once, and a predicted one from
measured poses: there, effects that read the pose get it in further passes. The quantities that an
effect reads are recorded while it runs (`werrimbi_odom.model.effects_over_run`).
"""

from __future__ import annotations

from functools import partial

import numpy as np

from werrimbi_odom.effects.contract.demands import demand, in_words, settings
from werrimbi_odom.effects.contract.sample_drive import RADIUS, TRACK, Rehearsal
from werrimbi_odom.model.driven_motion import Driving, features
from werrimbi_odom.model.effect import AppliedEffect, Effect
from werrimbi_odom.model.effects_over_run import driven, driven_from_measured
from werrimbi_odom.model.measured_poses import MeasuredPoses
from werrimbi_odom.model.motion import BodyMotion, WheelTravel, displacement
from werrimbi_odom.model.pose import Floats, Pose
from werrimbi_odom.model.robot import Robot

_START = Pose(0.4, -0.3, 2.1)
"""Not at the origin, where an effect could be right without the pose."""

_EVERY = 25
"""Steps between measured poses."""

_TICKS = 2000.0


def drives_alike(effect: Effect, rehearsal: Rehearsal) -> None:
    """Compute the rehearsal live, recorded and predicted."""
    for values in settings(effect):
        robot = Robot(TRACK, RADIUS, _TICKS, _TICKS, effects=(AppliedEffect(effect, values),))
        poses, live = _live(robot, rehearsal)
        drive = features(
            robot, rehearsal.duration, rehearsal.travel, (0.0, 0.0), rehearsal.measured
        )
        recorded = driven(robot, rehearsal.travel, drive, _START)
        predicted = driven_from_measured(robot, rehearsal.travel, drive, partial(_measured, poses))
        for way, found in (("recorded", recorded), ("predicted", predicted)):
            apart = float(np.max(np.abs(np.array(found.motion) - live)))
            demand(
                apart <= 1e-9,
                effect,
                "live, recorded and predicted are the same",
                f"with {in_words(values)} the drive comes out differently by {apart:g} when {way}: "
                "look at the drive's quantities by their names, and nowhere else",
            )


def _measured(poses: Floats) -> MeasuredPoses:
    """The `poses` (3, n) of some steps, as if they were measured."""
    first = np.arange(poses.shape[1]) // _EVERY * _EVERY
    x, y, yaw = poses[:, first]
    return MeasuredPoses(yaw, first, x + 1j * y, first)


def _live(robot: Robot, rehearsal: Rehearsal) -> tuple[Floats, Floats]:
    """Start poses (3, n) of the steps, and motions (3, n), step by step."""
    measured = rehearsal.measured
    driving, pose = Driving(robot), _START
    driving.begin(0.0, 0.0, {name: float(span.start[0]) for name, span in measured.items()})
    poses, motions = [], []
    rows = zip(*(part.tolist() for part in (rehearsal.duration, *rehearsal.travel)), strict=True)
    for i, (duration, left, right) in enumerate(rows):
        now = {name: float(span.end[i]) for name, span in measured.items()}
        _, motion = driving.step(duration, WheelTravel(left, right), pose, now)
        poses.append(pose)
        motions.append(motion)
        dx, dy = displacement(BodyMotion(*motion), pose.yaw)
        pose = Pose(pose.x + dx, pose.y + dy, pose.yaw + motion.turn)
    return np.array(poses).T, np.array(motions).T
