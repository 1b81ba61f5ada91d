# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Counters that lose counts, are read apart, or are wired wrongly: tampering with the record."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..recording import Recording
from ..robot import TrueRobot
from ..sensors import count
from .peculiarity import Counted, Peculiarity
from .wheels import Side

Floats = NDArray[np.float64]


def _angle(recording: Recording, side: Side) -> Floats:
    path = recording.true_path
    return path.left_angle_rad if side == "left" else path.right_angle_rad


def _rows(recording: Recording) -> Iterator[tuple[float, float, float]]:
    """Time and both shafts' angles."""
    path = recording.true_path
    return zip(
        *(each.tolist() for each in (path.t_s, path.left_angle_rad, path.right_angle_rad)),
        strict=True,
    )


def _ticks(recording: Recording, side: Side) -> NDArray[np.int64]:
    return recording.left_ticks if side == "left" else recording.right_ticks


def _with_ticks(recording: Recording, side: Side, ticks: NDArray[np.int64]) -> Recording:
    if side == "left":
        return replace(recording, left_ticks=ticks)
    return replace(recording, right_ticks=ticks)


def _resolution(robot: TrueRobot, side: Side) -> float:
    return robot.left_ticks_per_revolution if side == "left" else robot.right_ticks_per_revolution


@dataclass(frozen=True)
class MissedTicks(Peculiarity):
    """An encoder loses a share of its counts while its wheel is faster than a threshold.

    The share is lost evenly, as where an interrupt is late for every n-th mark, not by chance.

    Parameters
    ----------
    side : "left" or "right"
    fraction : float
        Of the counts.
    above : float
        Speed at the rim beyond which they are lost [m/s].
    """

    side: Side
    fraction: float
    above: float

    def recording(
        self, recording: Recording, robot: TrueRobot, rng: np.random.Generator
    ) -> Recording:
        """Take the lost counts away."""
        t, angle = recording.true_path.t_s, _angle(recording, self.side)
        seen = self.counted(robot)
        counted = np.array([seen(*row) for row in _rows(recording)])
        resolution = _resolution(robot, self.side)
        missing = count(t, angle, recording.t_s, resolution) - count(
            t, counted[:, 0 if self.side == "left" else 1], recording.t_s, resolution
        )
        return _with_ticks(recording, self.side, _ticks(recording, self.side) - missing)

    def counted(self, robot: TrueRobot) -> Counted:
        """Both shafts' angles, the one of this side less what was lost so far."""
        radius = getattr(robot, f"{self.side}_wheel_radius")
        which = 0 if self.side == "left" else 1
        before: tuple[float, float] | None = None  # time and angle
        fast = 0.0

        def count_on(time: float, left: float, right: float) -> tuple[float, float]:
            nonlocal before, fast
            angles = [left, right]
            if before is not None:
                step = angles[which] - before[1]
                if abs(step / (time - before[0])) * radius > self.above:
                    fast += step
            before = time, angles[which]
            angles[which] -= self.fraction * fast
            return angles[0], angles[1]

        return count_on


@dataclass(frozen=True)
class EncoderSkew(Peculiarity):
    """The right counter is read later than the left one (earlier where negative) by `delay` [s]."""

    delay: float

    @property
    def ahead(self) -> float:
        """A counter that is read later shows what comes after its stamp."""
        return max(self.delay, 0.0)

    def recording(
        self, recording: Recording, robot: TrueRobot, rng: np.random.Generator
    ) -> Recording:
        """Let the right counter show what it counted by then."""
        t, angle = recording.true_path.t_s, recording.true_path.right_angle_rad
        resolution = robot.right_ticks_per_revolution
        late = count(t, angle, recording.t_s + self.delay, resolution)
        more = late - count(t, angle, recording.t_s, resolution)
        return replace(recording, right_ticks=recording.right_ticks + more)


@dataclass(frozen=True)
class WheelsSwapped(Peculiarity):
    """Left and right are exchanged."""

    def recording(
        self, recording: Recording, robot: TrueRobot, rng: np.random.Generator
    ) -> Recording:
        """Exchange the columns."""
        left, right = recording.left_ticks, recording.right_ticks
        return replace(recording, left_ticks=right, right_ticks=left)


@dataclass(frozen=True)
class WheelReversed(Peculiarity):
    """One counter counts backwards."""

    side: Side

    def recording(
        self, recording: Recording, robot: TrueRobot, rng: np.random.Generator
    ) -> Recording:
        """Turn its sign."""
        return _with_ticks(recording, self.side, -_ticks(recording, self.side))
