# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Planar poses: compose, inverse, between, wrap. Angles anticlockwise, in radians (REP-103)."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


class Pose(NamedTuple):
    """A planar pose: x and y [m] and yaw [rad] of a body in some frame."""

    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0


def compose(a: Pose, b: Pose) -> Pose:
    """Transform pose `b` from the frame of `a` to the frame in which `a` is given."""
    cos, sin = math.cos(a.yaw), math.sin(a.yaw)
    return Pose(a.x + cos * b.x - sin * b.y, a.y + sin * b.x + cos * b.y, a.yaw + b.yaw)


def inverse(a: Pose) -> Pose:
    """Inverse of `a`: ``compose(a, inverse(a))`` is the origin."""
    cos, sin = math.cos(a.yaw), math.sin(a.yaw)
    return Pose(-cos * a.x - sin * a.y, sin * a.x - cos * a.y, -a.yaw)


def between(a: Pose, b: Pose) -> Pose:
    """Pose `b` relative to `a`: ``compose(a, between(a, b))`` is `b`."""
    return compose(inverse(a), b)


def wrap(angle: float) -> float:
    """Wrap an angle to [-pi, pi]; NaN if it is not finite."""
    return math.remainder(angle, 2.0 * math.pi) if math.isfinite(angle) else math.nan


def wrap_all(angles: Floats) -> Floats:
    """`wrap` for an array of any shape."""
    turns = np.rint(angles / (2.0 * np.pi))
    return np.asarray(angles - 2.0 * np.pi * turns, dtype=np.float64)
