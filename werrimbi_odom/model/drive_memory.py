# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Computes `Drive` online, one step at a time, with constant memory."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from werrimbi_odom.model.castor import swing
from werrimbi_odom.model.drive import ROLLBACK, SMOOTHING, Drive, RawStep, Span
from werrimbi_odom.model.motion import BodyMotion, displacement
from werrimbi_odom.model.pose import Pose
from werrimbi_odom.model.step_speeds import SpeedMemory, StepSpeeds


def smoothed(before: float, speed: float, duration: float) -> float:
    """Low-pass filtered speed (`SMOOTHING`) after a step at constant `speed` [m/s]."""
    return speed + (before - speed) * math.exp(-duration / SMOOTHING)


@dataclass(slots=True)
class _Shuttle:
    """Travel since the last reversal of something that moves back and forth."""

    flicker: float
    direction: float = 0.0
    reversals: int = 0
    _position: float = 0.0
    _turned_at: float = 0.0
    _farthest: float = 0.0

    @property
    def since(self) -> float:
        """Travel since the last reversal [m]."""
        return abs(self._farthest - self._turned_at)

    def step(self, travel: float) -> Span[float]:
        """Add one step; return the travel since reversal at its start and end."""
        self._position += travel
        start = self.since
        ahead = (self._position - self._farthest) * (self.direction or 1.0)
        if self.direction == 0.0:
            if abs(self._position) > self.flicker:
                self.direction = 1.0 if self._position > 0.0 else -1.0
                self._farthest = self._position
        elif ahead > 0.0:
            self._farthest = self._position
        elif -ahead > self.flicker:
            self._turned_at, self._farthest = self._farthest, self._position
            self.direction = -self.direction
            self.reversals += 1
            start = 0.0
        return Span(start, self.since)


@dataclass(slots=True)
class DriveMemory:
    """State behind `Drive`: constant in size, updated once per step."""

    flicker: float
    """A wheel that goes back by less (or by less than `ROLLBACK`) has not reversed [m]."""
    track: float
    """Wheel separation [m]."""
    left_angle: float = 0.0
    right_angle: float = 0.0
    """Angles of the wheels at the first message, from the counters' zeros [rad]."""
    _time: float = 0.0
    _distance: float = 0.0
    _castor: float = 0.0
    _speeds: SpeedMemory = field(default_factory=SpeedMemory)
    _means: StepSpeeds | None = None
    _smooth: tuple[float, float] = (0.0, 0.0)
    _left: _Shuttle = field(init=False)
    _right: _Shuttle = field(init=False)
    _middle: _Shuttle = field(init=False)

    def __post_init__(self) -> None:
        least = max(self.flicker, ROLLBACK)
        self._left, self._right, self._middle = _Shuttle(least), _Shuttle(least), _Shuttle(least)

    def step(
        self, raw: RawStep, pose: Pose, channels: Mapping[str, Span[float]] | None = None
    ) -> Drive[float]:
        """Add one step that begins at `pose`; return what an effect may read in it."""
        time = Span(self._time, self._time + raw.duration)
        distance = Span(self._distance, self._distance + abs(raw.along))
        means = self._speeds.step(raw)
        speed, yaw_rate, left_speed, right_speed = map(Span, self._means or means, means)
        before = self._smooth if self._means else (means.left, means.right)
        after = (
            smoothed(before[0], means.left, raw.duration),
            smoothed(before[1], means.right, raw.duration),
        )
        left_angle = Span(self.left_angle, self.left_angle + raw.left_angle)
        right_angle = Span(self.right_angle, self.right_angle + raw.right_angle)
        left, right = self._left.step(raw.left), self._right.step(raw.right)
        middle = self._middle.step(raw.along)
        swung = self._castor + swing(self._castor, raw.along, raw.turn, self.track)
        castor = Span(self._castor, swung)
        x, y, heading = pose
        dx, dy = displacement(BodyMotion(raw.along, 0.0, raw.turn), heading)
        self._time, self._distance, self._castor = time.end, distance.end, castor.end
        self._means, self._smooth = means, after
        self.left_angle, self.right_angle = left_angle.end, right_angle.end
        return Drive(
            duration=raw.duration,
            time=time,
            speed=speed,
            yaw_rate=yaw_rate,
            left_speed=left_speed,
            right_speed=right_speed,
            left_smooth_speed=Span(before[0], after[0]),
            right_smooth_speed=Span(before[1], after[1]),
            left_acceleration=(after[0] - before[0]) / raw.duration,
            right_acceleration=(after[1] - before[1]) / raw.duration,
            left_angle=left_angle,
            right_angle=right_angle,
            distance=distance,
            left_since_reversal=left,
            right_since_reversal=right,
            since_reversal=middle,
            left_direction=self._left.direction,
            right_direction=self._right.direction,
            direction=self._middle.direction,
            reversals=float(self._middle.reversals),
            left_reversals=float(self._left.reversals),
            right_reversals=float(self._right.reversals),
            castor_angle=castor,
            heading=Span(heading, heading + raw.turn),
            x=Span(x, x + dx),
            y=Span(y, y + dy),
            channels=channels or {},
        )
