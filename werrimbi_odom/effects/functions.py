# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Functions for laws: of a float (the node, a step at a time) or an array (a whole run) alike.

Floats go through `math`: numpy on single numbers would cost the node ten times as much.
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
    """Natural logarithm, of what is positive."""
    return np.log(x) if isinstance(x, np.ndarray) else math.log(x)


def sign(x: Number) -> Number:
    """+1, -1, and 0 of nothing."""
    return np.sign(x) if isinstance(x, np.ndarray) else float((x > 0.0) - (x < 0.0))


def limited(x: Number, low: Number | float, high: Number | float) -> Number:
    """The nearest to x between low and high."""
    if isinstance(x, np.ndarray):
        return np.minimum(np.maximum(x, low), high)
    return min(max(x, low), high)


def saturated(travel: Number, limit: Number) -> Number:
    """What of a travel has happened when no more than `limit` can: min(travel, limit), if positive.

    A negative limit gives the same with the other sign: physics has no such thing, but a derivative
    at a limit of zero, taken over both sides, needs it.
    """
    size = abs(limit)
    taken = limited(travel, -size, size)
    if isinstance(limit, np.ndarray):
        return np.copysign(1.0, limit) * taken
    return math.copysign(1.0, limit) * taken


def share(part: Number, whole: Number) -> Number:
    """Part / whole, and 0 where the whole is 0 (a robot at rest has no sharpness of turning)."""
    if isinstance(part, np.ndarray):
        return np.divide(part, whole, out=np.zeros_like(part), where=whole != 0.0)
    return part / whole if whole != 0.0 else 0.0


def within_half_a_turn(angle: Number) -> Number:
    """The same direction between -pi and pi [rad]."""
    return wrap_all(angle) if isinstance(angle, np.ndarray) else wrap(angle)
