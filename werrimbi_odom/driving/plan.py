# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What is to be driven: moves from rest to rest, and where they lead."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from werrimbi_odom.driving.limits import Area, Limits
from werrimbi_odom.model.motion import BodyMotion, displacement
from werrimbi_odom.model.pose import Pose, between, compose

HEADROOM = 0.85
"""Share of speeds and accelerations that a plan uses; the rest is for the control."""

GENTLE = 0.4
"""Share of the acceleration where a manoeuvre does not ask for hard starts and stops."""

SPACING, SPACING_TURN = 0.05, 0.1
"""Between the points of the path that are checked and shown [m, rad]."""

SLACK = 0.05
"""Room that a planned path leaves to the border [m], for the control and for the way of a stop."""


@dataclass(frozen=True, slots=True)
class Move:
    """A line, an arc or a turn on the spot, from rest to rest; or a rest.

    Parameters
    ----------
    length, turn : float
        Signed [m, rad]; both at once make an arc.
    pace : float
        Share of the full speed, to 1.
    hard : bool
        With all the acceleration there is.
    rest : float
        Standstill afterwards [s].
    """

    length: float
    turn: float
    pace: float = 1.0
    hard: bool = False
    rest: float = 0.3

    def end(self, start: Pose, share: float = 1.0) -> Pose:
        """The pose after a share of it."""
        motion = BodyMotion(self.length * share, 0.0, self.turn * share)
        x, y = displacement(motion, start.yaw)
        return Pose(start.x + x, start.y + y, start.yaw + motion.turn)


@dataclass(frozen=True, slots=True)
class ManoeuvrePlan:
    """A manoeuvre.

    Parameters
    ----------
    name, words : str
        What it is called, and what it is.
    """

    name: str
    words: str
    moves: tuple[Move, ...]

    def starts(self) -> list[Pose]:
        """Where each move begins, and where the last one ends; from (0, 0, 0) on."""
        poses = [Pose(0.0, 0.0, 0.0)]
        for move in self.moves:
            poses.append(move.end(poses[-1]))
        return poses

    def path(self) -> list[Pose]:
        """Points along the whole way."""
        points = []
        for start, move in zip(self.starts(), self.moves, strict=False):
            parts = abs(move.length) / SPACING + abs(move.turn) / SPACING_TURN
            count = max(math.ceil(parts), 1)
            points += [move.end(start, part / count) for part in range(count)]
        return [*points, self.starts()[-1]]

    def duration(self, limits: Limits) -> float:
        """How long it takes [s], if the robot follows."""
        return sum(Profile.of(move, limits).duration + move.rest for move in self.moves)


NOTHING = 1e-6
"""Of a move [m, rad]: what is smaller is none, and ramps that divide by it are no numbers."""


@dataclass(frozen=True, slots=True)
class Profile:
    """A move's progress from 0 to 1: faster, steadily on, slower.

    Parameters
    ----------
    rate : float
        Of the steady part [1/s].
    ramp : float
        Of its rise and fall [1/s^2].
    duration : float
        [s]
    """

    rate: float
    ramp: float
    duration: float

    @classmethod
    def of(cls, move: Move, limits: Limits) -> Profile:
        """The quickest within the limits, at the move's pace."""
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
        rate = min(rate, math.sqrt(ramp))  # a short move never reaches full speed
        return cls(rate, ramp, 1.0 / rate + rate / ramp)

    def at(self, time: float) -> tuple[float, float]:
        """Progress, and its rate [1/s], a time [s] after the begin."""
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
    """The least room along a path that begins at `start`, a pose in the frame of the area [m]."""
    return min(area.room(*compose(start, point)[:2]) for point in path)


def seen_from(start: Pose, pose: Pose) -> Pose:
    """A pose as seen from `start`, both in one frame; the heading within half a turn."""
    seen = between(start, pose)
    return seen._replace(yaw=math.remainder(seen.yaw, 2.0 * math.pi))
