# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""One scan: 2-D echoes, each measured at its own time while the robot moved."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from werrimbi_odom.model.pose import Floats


@dataclass(frozen=True, eq=False)
class Sweep:
    """Echoes of one turn of a lidar; k of them."""

    time: float
    """Middle of the sweep, for which its pose is estimated [s]."""
    points: Floats
    """Echoes in the lidar's frame at their own instants, shape (k, 2) [m]."""
    share: Floats
    """Time of each echo from the middle, as a share of the turn, -0.5 to 0.5, shape (k,)."""
    duration: float
    """Duration of the turn [s]; 0 if all beams are simultaneous, negative if the order is
    reversed."""
    spacing: Floats
    """Distance between neighbouring beams at each echo, shape (k,) [m]."""


@dataclass(frozen=True)
class SweepMotion:
    """Motion b t + c t^2 of the lidar, t from the middle of a sweep, in its frame there."""

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
    """Sweep from the ranges of one turn.

    Parameters
    ----------
    time : float
        Time of the first beam [s].
    ranges : ndarray, shape (n,)
        Ranges [m]; 0, infinity, NaN and values at or beyond the lidar's limits are no echoes. Nor
        is the largest if several beams give it to the last digit: some drivers write a range for
        beams without echo, which would be a round wall that goes with the robot.
    angles : ndarray, shape (n,)
        Directions of the beams in equal steps [rad].
    beam_interval : float
        Time between two beams [s]; 0 if all are simultaneous, as in some simulators.
    nearest, farthest : float
        Range limits stated by the lidar [m].
    """
    with np.errstate(invalid="ignore"):
        echo = np.isfinite(ranges) & (ranges > max(nearest, 0.0)) & (ranges < farthest)
    largest = echo & (ranges == np.max(ranges, initial=0.0, where=echo))
    if np.count_nonzero(largest) > 1:
        echo &= ~largest
    number = np.flatnonzero(echo)
    distance, direction = ranges[number], angles[number]
    points = distance[:, None] * np.column_stack([np.cos(direction), np.sin(direction)])
    middle = 0.5 * (ranges.size - 1) * beam_interval
    step = abs(float(angles[1] - angles[0])) if angles.size > 1 else 0.0
    share = np.asarray((number - 0.5 * (ranges.size - 1)) / max(ranges.size, 1), dtype=np.float64)
    return Sweep(time + middle, points, share, ranges.size * beam_interval, distance * step)


def deskewed(sweep: Sweep, course: SweepMotion) -> Floats:
    """Echoes corrected for the motion during the sweep, shape (k, 2) [m]."""
    t = sweep.duration * sweep.share[:, None]
    moved = t * np.array(course.linear) + t * t * np.array(course.quadratic)
    cos, sin = np.cos(moved[:, 2]), np.sin(moved[:, 2])
    x, y = sweep.points.T
    return np.column_stack([cos * x - sin * y + moved[:, 0], sin * x + cos * y + moved[:, 1]])


def own_course(motion: Floats, duration: float) -> SweepMotion:
    """Sweep motion if the lidar goes on as in its last motion (3,), which took `duration` [s]."""
    x, y, turn = (motion / duration).tolist()
    # Constant velocity in the lidar's own frame: turning bends its path, hence the quadratic terms.
    return SweepMotion((x, y, turn), (-0.5 * turn * y, 0.5 * turn * x, 0.0))
