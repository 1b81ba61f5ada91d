# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Recent odometry, and its pose at any instant by interpolation."""

from __future__ import annotations

import math
from collections import deque
from typing import Literal, NamedTuple

import numpy as np

from werrimbi_odom.model.covariance import PoseCovariance, carried
from werrimbi_odom.model.motion import BodyMotion, displacement, sinc
from werrimbi_odom.model.pose import Pose, between, wrap

KEPT = 2_000
"""Number of odometry messages kept: 40 s at 50 Hz, 2 s at 1 kHz."""
GAP = 1.0
"""Longest interval of the odometry [s] that is interpolated."""

# A pose that contradicts its twist was set: by ~/reset, set_pose, a restart.
_SET_BY = 0.05  # m
_SET_BY_TURN = 0.1  # rad

Added = Literal["first", "next", "old", "set", "back"]


class TimedPose(NamedTuple):
    """A pose at an instant, and the covariance of its error, both in the pose's own frame."""

    time: float
    """[s]"""
    pose: Pose
    covariance: PoseCovariance[float]
    path: float = 0.0
    """Path length since the beginning, both directions counted positive [m]; odometry only."""
    turned: float = 0.0
    """Absolute turn since the beginning [rad]; odometry only."""


class OdometryTrack:
    """Stores odometry, and interpolates it between messages."""

    def __init__(self) -> None:
        self._kept: deque[TimedPose] = deque(maxlen=KEPT)

    @property
    def oldest(self) -> float:
        """Time of the first stored reading [s]; infinite if there is none."""
        return self._kept[0].time if self._kept else math.inf

    @property
    def newest(self) -> float:
        """Time of the last reading [s]; minus infinity if there is none."""
        return self._kept[-1].time if self._kept else -math.inf

    def add(self, reading: TimedPose, twist: BodyMotion[float]) -> Added:
        """Add a reading, whose `path` and `turned` are ignored, and the twist of the same message.

        Returns first; next: it continues the last; old: not newer than the last, ignored; set: it
        contradicts the last reading and the twist; back: the clock was set back.
        """
        if not self._kept:
            self._kept.append(reading._replace(path=0.0, turned=0.0))
            return "first"
        last = self._kept[-1]
        dt = reading.time - last.time
        if -GAP < dt <= 0.0:
            return "old"
        moved = between(last.pose, reading.pose)
        motion = motion_between(moved)
        if dt <= 0.0 or _was_set(moved, motion, twist, dt):
            self._kept.clear()
            self._kept.append(reading._replace(path=0.0, turned=0.0))
            return "back" if dt <= 0.0 else "set"
        path = math.hypot(motion.along, motion.sideways)
        self._kept.append(
            reading._replace(path=last.path + path, turned=last.turned + abs(motion.turn))
        )
        return "next"

    def at(self, time: float) -> TimedPose | None:
        """Reading at an instant; None outside the stored span or in a gap.

        Between two messages the robot is assumed to move along one arc, with its noise distributed
        evenly.
        """
        if not self.oldest <= time <= self.newest:
            return None
        after = self._kept[-1]
        for before in reversed(self._kept):
            if before.time <= time:
                break
            after = before
        if before.time == time:
            return before
        dt = after.time - before.time
        return None if dt > GAP else _part_way(before, after, (time - before.time) / dt)


def motion_between(moved: Pose) -> BodyMotion[float]:
    """Constant twist that produces a relative pose, with less than half a turn."""
    turn = wrap(moved.yaw)
    cos, sin, shrink = math.cos(0.5 * turn), math.sin(0.5 * turn), sinc(0.5 * turn)
    along = (cos * moved.x + sin * moved.y) / shrink
    return BodyMotion(along, (cos * moved.y - sin * moved.x) / shrink, turn)


def _was_set(moved: Pose, motion: BodyMotion[float], twist: BodyMotion[float], dt: float) -> bool:
    """Whether a pose contradicts its twist, with a tolerance for a smoothed twist."""
    said = BodyMotion(*(dt * part for part in twist))
    if not all(map(math.isfinite, said)):
        return False
    x, y = displacement(said, 0.0)
    way = max(math.hypot(said.along, said.sideways), math.hypot(motion.along, motion.sideways))
    turn = max(abs(said.turn), abs(motion.turn))
    # Half the path: a twist averaged over some intervals, during acceleration from rest.
    apart = math.hypot(moved.x - x, moved.y - y)
    turned = abs(wrap(moved.yaw - said.turn))
    return apart > _SET_BY + 0.5 * min(way, 0.5) or turned > _SET_BY_TURN + 0.5 * min(turn, 0.5)


def _part_way(before: TimedPose, after: TimedPose, share: float) -> TimedPose:
    start = before.pose
    motion = motion_between(between(start, after.pose))
    part = BodyMotion(*(share * each for each in motion))
    dx, dy = displacement(part, start.yaw)
    pose = Pose(start.x + dx, start.y + dy, start.yaw + part.turn)
    whole = carried(before.covariance, after.pose.x - start.x, after.pose.y - start.y)
    added = np.subtract(after.covariance, whole)
    so_far = np.array(carried(before.covariance, dx, dy)) + share * added
    return TimedPose(
        before.time + share * (after.time - before.time),
        pose,
        PoseCovariance(*so_far.tolist()),
        before.path + share * (after.path - before.path),
        before.turned + share * (after.turned - before.turned),
    )
