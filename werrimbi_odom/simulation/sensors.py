# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Encoders and a reference, both sampled from the true path."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from .engine import AxlePose, Floats, TruePath
from .robot import TrueRobot

Counts = NDArray[np.int64]

WORLD = AxlePose(0.0, 0.0, 0.0)
"""The world frame."""


@dataclass(frozen=True)
class ReferenceSensor:
    """A motion capture system, or another external measurement of the robot's pose."""

    rate_hz: float = 20.0
    """Sampling rate."""
    sigma_xy: float = 1e-3
    sigma_yaw: float = 2e-3
    """Standard deviations of each coordinate [m] and of the yaw [rad], white noise."""
    frame: AxlePose = WORLD
    """Pose of the reference's frame in the world."""
    mount: AxlePose = WORLD
    """Of the marker on the robot: ahead and left of the axle's midpoint [m], and yaw [rad]."""
    delay: float = 0.0
    """A sample with stamp t was measured at t - delay [s]."""
    heading_delay: float = 0.0
    """Additional delay of the yaw [s]."""
    mirrored: Literal["no", "y_down", "exchanged"] = "no"
    """"no", "y_down" (y and yaw with the wrong sign) or "exchanged" (x and y exchanged, yaw
    clockwise from the new x), as in a left-handed frame."""

    def measure(
        self, path: TruePath, times: Floats, rng: np.random.Generator
    ) -> tuple[Floats, Floats, Floats]:
        """Poses x, y [m], yaw [rad] in the reference's frame at `times`, with noise."""
        # Between rows of the path (5 ms) a chord differs from the arc by a few micrometres at most.
        at = times - self.delay
        heading = np.interp(at, path.t_s, path.yaw_rad)
        x = np.interp(at, path.t_s, path.x_m)
        y = np.interp(at, path.t_s, path.y_m)
        x += np.cos(heading) * self.mount.x - np.sin(heading) * self.mount.y - self.frame.x
        y += np.sin(heading) * self.mount.x + np.cos(heading) * self.mount.y - self.frame.y
        yaw = np.interp(at - self.heading_delay, path.t_s, path.yaw_rad)
        yaw += self.mount.yaw - self.frame.yaw
        cos, sin = math.cos(self.frame.yaw), math.sin(self.frame.yaw)
        x, y = cos * x + sin * y, cos * y - sin * x
        if self.mirrored == "y_down":
            y, yaw = -y, -yaw
        elif self.mirrored == "exchanged":
            x, y, yaw = y, x, math.pi / 2 - yaw
        noise = rng.standard_normal((3, len(times)))
        return (
            x + self.sigma_xy * noise[0],
            y + self.sigma_xy * noise[1],
            wrap(yaw + self.sigma_yaw * noise[2]),
        )


def sampling_times(rate_hz: float, end: float, rng: np.random.Generator) -> Floats:
    """A regular grid of times until `end` [s], from a random start in the first 0.3 s."""
    return np.arange(rng.uniform(0.0, 0.3), end, 1.0 / rate_hz)


def count(
    path_t: Floats, angle: Floats, times: Floats, ticks_per_revolution: float, start: int = 0
) -> Counts:
    """Counter readings of an encoder at `times`, shape (n,), for the shaft angle `angle` [rad].

    A counter steps when the shaft passes a mark, so the angle is rounded down.
    """
    turns = np.interp(times, path_t, angle) / (2 * math.pi)
    return np.floor(turns * ticks_per_revolution).astype(np.int64) + start


def counters(
    path: TruePath, robot: TrueRobot, times: Floats, zeros: Sequence[int]
) -> tuple[Counts, Counts]:
    """Readings of both encoders at `times`, each shape (n,); `zeros` as `start` of `count`."""
    return (
        count(path.t_s, path.left_angle_rad, times, robot.left_ticks_per_revolution, zeros[0]),
        count(path.t_s, path.right_angle_rad, times, robot.right_ticks_per_revolution, zeros[1]),
    )


def wrap(angle: Floats) -> Floats:
    """Angles wrapped to (-pi, pi] [rad]."""
    wrapped: Floats = -((math.pi - angle) % (2 * math.pi) - math.pi)
    return wrapped
