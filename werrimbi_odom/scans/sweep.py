# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""One scan: 2-D echoes, each measured at its own time while the robot moved."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.pose import Floats
from werrimbi_odom.scans.line_features import reach_of
from werrimbi_odom.scans.matching import MAD

PARTS, FEWEST = 4, 12
"""Parts of a scan, near to far, whose noise is told apart, and fewest echoes in each."""


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
    reach: Floats
    """Distance from each echo over which its neighbours show the direction of a wall, shape (k,)
    [m]."""


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
    reach = reach_of(distance * step, range_noise(distance, number, step))
    return Sweep(time + middle, points, share, ranges.size * beam_interval, reach)


def range_noise(ranges: Floats, number: NDArray[np.intp], step: float) -> Floats:
    """Noise of the ranges as far as each of them, shape (k,) [m]; zero where few echoes tell it.

    One over the range is a cosine along a straight wall, of which three beams in a row have a
    second difference of nothing but noise, at whatever angle they meet it. The median does not see
    edges. It is taken in parts of equal numbers, near to far, as noise grows with the range.

    Parameters
    ----------
    ranges : ndarray, shape (k,)
        Of the beams with an echo, in their order [m].
    number : ndarray, shape (k,)
        Which beams these are.
    step : float
        Angle between beams [rad].
    """
    inner = np.flatnonzero(number[2:] - number[:-2] == 2) + 1
    if inner.size < PARTS * FEWEST:
        return np.zeros(ranges.size)
    inner = inner[np.argsort(ranges[inner], kind="stable")]
    near, inverse = ranges[inner], 1.0 / ranges
    change = inverse[inner - 1] + inverse[inner + 1] - 2.0 * math.cos(step) * inverse[inner]
    off = near**2 * np.abs(change)
    parts = zip(np.array_split(near, PARTS), np.array_split(off, PARTS), strict=True)
    middle, size = np.array([[np.median(part) for part in both] for both in parts]).T
    return np.asarray(np.interp(ranges, middle, MAD / math.sqrt(6.0) * size))


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
