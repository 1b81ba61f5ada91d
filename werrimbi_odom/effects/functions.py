# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Functions for effects that accept a float (one step in the node) or an array (a whole run).

Floats are computed with `math`: numpy is ten times slower on single numbers.
"""

from __future__ import annotations

import math

import numpy as np

from werrimbi_odom.model.motion import Number, sinc
from werrimbi_odom.model.pose import wrap, wrap_all

__all__ = [
    "cos",
    "exp",
    "limited",
    "log",
    "saturated",
    "share",
    "sign",
    "sin",
    "sinc",
    "within_half_a_turn",
]


def cos(angle: Number) -> Number:
    """Cosine of an angle [rad]."""
    return np.cos(angle) if isinstance(angle, np.ndarray) else math.cos(angle)


def sin(angle: Number) -> Number:
    """Sine of an angle [rad]."""
    return np.sin(angle) if isinstance(angle, np.ndarray) else math.sin(angle)


def exp(x: Number) -> Number:
    """Exponential function."""
    return np.exp(x) if isinstance(x, np.ndarray) else math.exp(x)


def log(x: Number) -> Number:
    """Natural logarithm of a positive number."""
    return np.log(x) if isinstance(x, np.ndarray) else math.log(x)


def sign(x: Number) -> Number:
    """Sign: +1, -1, or 0 for zero."""
    return np.sign(x) if isinstance(x, np.ndarray) else float((x > 0.0) - (x < 0.0))


def limited(x: Number, low: Number | float, high: Number | float) -> Number:
    """The value clipped to [low, high]."""
    if isinstance(x, np.ndarray):
        return np.minimum(np.maximum(x, low), high)
    return min(max(x, low), high)


def saturated(travel: Number, limit: Number) -> Number:
    """Travel limited to `limit`: min(travel, limit) if positive.

    A negative limit gives the opposite sign. It is unphysical, but needed for a two-sided
    derivative at a limit of zero.
    """
    size = abs(limit)
    taken = limited(travel, -size, size)
    if isinstance(limit, np.ndarray):
        return np.copysign(1.0, limit) * taken
    return math.copysign(1.0, limit) * taken


def share(part: Number, whole: Number) -> Number:
    """Part / whole, or 0 if the whole is 0 (such as the sharpness of turning at rest)."""
    if isinstance(part, np.ndarray):
        return np.divide(part, whole, out=np.zeros_like(part), where=whole != 0.0)
    return part / whole if whole != 0.0 else 0.0


def within_half_a_turn(angle: Number) -> Number:
    """An angle wrapped to (-pi, pi] [rad]."""
    return wrap_all(angle) if isinstance(angle, np.ndarray) else wrap(angle)
