# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Motion plan: moves from rest to rest, and the path that they make."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from werrimbi_odom.driving.limits import Area, Limits
from werrimbi_odom.model.motion import BodyMotion, displacement
from werrimbi_odom.model.pose import Pose, between, compose

HEADROOM = 0.85
"""Share of speeds and accelerations that a plan uses; the rest is reserved for control."""

GENTLE = 0.4
"""Share of the acceleration for manoeuvres without hard starts and stops."""

SPACING, SPACING_TURN = 0.05, 0.1
"""Spacing of the points of a path [m, rad]."""

SLACK = 0.05
"""Margin of a planned path to the border [m], for control errors and braking distance."""


@dataclass(frozen=True, slots=True)
class Move:
    """A line, an arc or a turn on the spot, from rest to rest; or a rest only."""

    length: float
    turn: float
    """Signed [m, rad]; both together make an arc."""
    pace: float = 1.0
    """Share of the full speed, at most 1."""
    hard: bool = False
    """Whether to use the full acceleration."""
    rest: float = 0.3
    """Rest after the move [s]."""

    def end(self, start: Pose, share: float = 1.0) -> Pose:
        """The pose after a share of the move."""
        motion = BodyMotion(self.length * share, 0.0, self.turn * share)
        x, y = displacement(motion, start.yaw)
        return Pose(start.x + x, start.y + y, start.yaw + motion.turn)


@dataclass(frozen=True, slots=True)
class ManoeuvrePlan:
    """A manoeuvre as a sequence of moves, with its name and a description."""

    name: str
    words: str
    moves: tuple[Move, ...]

    def starts(self) -> list[Pose]:
        """Start pose of each move, and the end of the last one; the first is (0, 0, 0)."""
        poses = [Pose(0.0, 0.0, 0.0)]
        for move in self.moves:
            poses.append(move.end(poses[-1]))
        return poses

    def path(self) -> list[Pose]:
        """Points along the whole path."""
        points = []
        for start, move in zip(self.starts(), self.moves, strict=False):
            parts = abs(move.length) / SPACING + abs(move.turn) / SPACING_TURN
            count = max(math.ceil(parts), 1)
            points += [move.end(start, part / count) for part in range(count)]
        return [*points, self.starts()[-1]]

    def duration(self, limits: Limits) -> float:
        """Planned duration [s]."""
        return sum(Profile.of(move, limits).duration + move.rest for move in self.moves)


NOTHING = 1e-6
"""Smallest length or turn of a move [m, rad]; avoids division by almost zero in its ramps."""


@dataclass(frozen=True, slots=True)
class Profile:
    """Trapezoidal speed profile: a move's progress from 0 to 1."""

    rate: float
    """Rate of the steady part [1/s]."""
    ramp: float
    """Acceleration and deceleration [1/s^2]."""
    duration: float
    """Duration of the move [s]."""

    @classmethod
    def of(cls, move: Move, limits: Limits) -> Profile:
        """The fastest profile within the limits at the move's pace."""
        if max(abs(move.length), abs(move.turn)) < NOTHING:
            return cls(0.0, 0.0, 0.0)
        brisk = HEADROOM * (1.0 if move.hard else GENTLE)
        most = HEADROOM * move.pace
        rate = min(
            _ratio(most * limits.speed, move.length), _ratio(most * limits.yaw_rate, move.turn)
        )
        ramp = min(
            _ratio(brisk * limits.acceleration, move.length),
            _ratio(brisk * limits.yaw_acceleration, move.turn),
        )
        rate = min(rate, math.sqrt(ramp))  # a short move does not reach full speed
        return cls(rate, ramp, 1.0 / rate + rate / ramp)

    def at(self, time: float) -> tuple[float, float]:
        """Progress, and its rate [1/s], at a time since the start [s]."""
        left = self.duration - time
        if left <= 0.0:
            return 1.0, 0.0
        rise = self.rate / self.ramp
        if time < rise:
            return 0.5 * self.ramp * time * time, self.ramp * time
        if left < rise:
            return 1.0 - 0.5 * self.ramp * left * left, self.ramp * left
        return self.rate * (time - 0.5 * rise), self.rate


def _ratio(limit: float, amount: float) -> float:
    return limit / abs(amount) if amount else math.inf


def room_of(path: Sequence[Pose], area: Area, start: Pose) -> float:
    """Least distance to the border along a path from `start`, a pose in the area's frame [m]."""
    return min(area.room(*compose(start, point)[:2]) for point in path)


def seen_from(start: Pose, pose: Pose) -> Pose:
    """A pose in the frame of `start`, both given in one frame; yaw within half a turn."""
    seen = between(start, pose)
    return seen._replace(yaw=math.remainder(seen.yaw, 2.0 * math.pi))
