# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Faults of the counters: lost counts, unequal reading times, wrong wiring."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from ..recording import Recording
from ..robot import TrueRobot
from ..sensors import count
from .hidden_effect import Counted, Peculiarity, Rng
from .wheels import Side


def _rows(recording: Recording) -> Iterator[tuple[float, float, float]]:
    """Rows of time and both shaft angles."""
    path = recording.true_path
    return zip(
        *(each.tolist() for each in (path.t_s, path.left_angle_rad, path.right_angle_rad)),
        strict=True,
    )


@dataclass(frozen=True)
class MissedTicks(Peculiarity):
    """An encoder loses a share of its counts while its wheel is faster than a threshold.

    The loss is even, as if an interrupt missed every n-th mark, not random.
    """

    side: Side
    fraction: float
    """Lost share of the counts."""
    above: float
    """Threshold of the rim speed [m/s]."""

    def recording(self, recording: Recording, robot: TrueRobot, rng: Rng) -> Recording:
        """Remove the lost counts."""
        path, seen = recording.true_path, self.counted(robot)
        counted = np.array([seen(*row) for row in _rows(recording)])[:, int(self.side == "right")]
        resolution: float = getattr(robot, f"{self.side}_ticks_per_revolution")
        exact, lossy = (
            count(path.t_s, angle, recording.t_s, resolution)
            for angle in (getattr(path, f"{self.side}_angle_rad"), counted)
        )
        name = f"{self.side}_ticks"
        return replace(recording, **{name: getattr(recording, name) - (exact - lossy)})

    def counted(self, robot: TrueRobot) -> Counted:
        """Both shaft angles, that of this side reduced by the loss so far."""
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
    """The right counter is read `delay` [s] later than the left one (earlier if negative)."""

    delay: float

    @property
    def ahead(self) -> float:
        """Time from the stamp to the later reading [s]."""
        return max(self.delay, 0.0)

    def recording(self, recording: Recording, robot: TrueRobot, rng: Rng) -> Recording:
        """Shift the right counter by the delay."""
        t, angle = recording.true_path.t_s, recording.true_path.right_angle_rad
        resolution = robot.right_ticks_per_revolution
        late = count(t, angle, recording.t_s + self.delay, resolution)
        more = late - count(t, angle, recording.t_s, resolution)
        return replace(recording, right_ticks=recording.right_ticks + more)


@dataclass(frozen=True)
class WheelsSwapped(Peculiarity):
    """Left and right counters are exchanged."""

    def recording(self, recording: Recording, robot: TrueRobot, rng: Rng) -> Recording:
        """Exchange the columns."""
        left, right = recording.left_ticks, recording.right_ticks
        return replace(recording, left_ticks=right, right_ticks=left)


@dataclass(frozen=True)
class WheelReversed(Peculiarity):
    """One counter has the wrong sign."""

    side: Side

    def recording(self, recording: Recording, robot: TrueRobot, rng: Rng) -> Recording:
        """Negate the counter."""
        name = f"{self.side}_ticks"
        return replace(recording, **{name: -getattr(recording, name)})
