# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""One scan: echoes on the floor plan, each seen at its own time while the robot moved."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from werrimbi_odom.model.pose import Floats


@dataclass(frozen=True, eq=False)
class Sweep:
    """The echoes of one turn of a lidar; k of them."""

    time: float
    """Of the middle of the sweep, which is where its pose is told [s]."""
    points: Floats
    """In the lidar's frame at the instant of each, shape (k, 2) [m]."""
    share: Floats
    """Of the turn, from its middle to where each was seen, shape (k,); -0.5 to 0.5."""
    duration: float
    """Of the turn [s]; 0 where all are seen at once, negative where the last is seen first."""
    spacing: Floats
    """Distance between neighbouring beams there, shape (k,) [m]."""


@dataclass(frozen=True)
class SweepMotion:
    """How the lidar moved about the middle of a sweep, in its own frame then: b t + c t^2."""

    linear: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """[m/s, m/s, rad/s]"""
    quadratic: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """[m/s^2, m/s^2, rad/s^2]"""


def sweep_of(
    time: float,
    ranges: Floats,
    angles: Floats,
    beam_interval: float = 0.0,
    nearest: float = 0.0,
    farthest: float = np.inf,
) -> Sweep:
    """A sweep from the ranges of one turn.

    Parameters
    ----------
    time : float
        When the first beam was measured [s].
    ranges : ndarray, shape (n,)
        [m]; 0, infinity, NaN and what is beyond the lidar's limits are no echoes.
    angles : ndarray, shape (n,)
        Directions of the beams, even steps [rad].
    beam_interval : float
        Time between two beams [s]; 0 where all are measured at once, as in some simulators.
    nearest, farthest : float
        Limits that the lidar states [m].
    """
    with np.errstate(invalid="ignore"):
        echo = np.isfinite(ranges) & (ranges > max(nearest, 0.0)) & (ranges <= farthest)
    number = np.flatnonzero(echo)
    distance, direction = ranges[number], angles[number]
    points = distance[:, None] * np.column_stack([np.cos(direction), np.sin(direction)])
    middle = 0.5 * (ranges.size - 1) * beam_interval
    step = abs(float(angles[1] - angles[0])) if angles.size > 1 else 0.0
    share = np.asarray((number - 0.5 * (ranges.size - 1)) / max(ranges.size, 1), dtype=np.float64)
    return Sweep(time + middle, points, share, ranges.size * beam_interval, distance * step)


def deskewed(sweep: Sweep, course: SweepMotion) -> Floats:
    """The echoes as they would have been seen from where the lidar was at the middle, (k, 2)."""
    t = sweep.duration * sweep.share[:, None]
    moved = t * np.array(course.linear) + t * t * np.array(course.quadratic)
    cos, sin = np.cos(moved[:, 2]), np.sin(moved[:, 2])
    x, y = sweep.points.T
    return np.column_stack([cos * x - sin * y + moved[:, 0], sin * x + cos * y + moved[:, 1]])


def own_course(motion: Floats, duration: float) -> SweepMotion:
    """The course of a lidar that goes on as in its last motion (3,), which took `duration`."""
    x, y, turn = (motion / duration).tolist()
    # The mean of the way is seen from its start; the middle of the turn is what stays as it is.
    return SweepMotion((x, y, turn), (-0.5 * turn * y, 0.5 * turn * x, 0.0))
