# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""From wheel travel to body motion to displacement (paper, equations 13 and 14).

Every function takes floats or arrays of one shape alike: the node feeds single steps, a recorded
run all its steps at once, and both walk the same lines of code.
"""

from __future__ import annotations

import math
from typing import Generic, NamedTuple, TypeVar, overload

import numpy as np

from werrimbi_odom.model.pose import Floats

Number = TypeVar("Number", float, Floats)


class WheelTravel(NamedTuple, Generic[Number]):
    """Signed travel of the two wheels over a step or a piece [m]: L and R of the paper."""

    left: Number
    right: Number


class BodyMotion(NamedTuple, Generic[Number]):
    """Motion of the axle's midpoint over a step, as a constant twist held for the step.

    `along` and `sideways` [m] are in the body frame (x forward, y left); `turn` [rad] is
    anticlockwise.
    """

    along: Number
    sideways: Number
    turn: Number


def wheels_to_body(travel: WheelTravel[Number], track: float) -> BodyMotion[Number]:
    """Body motion of a wheel travel: D = (L + R) / 2 and Δ = (R - L) / B."""
    along = 0.5 * (travel.left + travel.right)
    return BodyMotion(along, 0.0 * along, (travel.right - travel.left) / track)


@overload
def sinc(x: float) -> float: ...
@overload
def sinc(x: Floats) -> Floats: ...
def sinc(x: float | Floats) -> float | Floats:
    """sin(x) / x, and 1 at zero (not numpy's sinc, which takes turns of pi)."""
    if isinstance(x, np.ndarray):
        return np.divide(np.sin(x), x, out=np.ones_like(x), where=x != 0.0)
    return math.sin(x) / x if x != 0.0 else 1.0


def displacement(motion: BodyMotion[Number], yaw: Number) -> tuple[Number, Number]:
    """Displacement of the axle's midpoint in the frame in which `yaw` was its heading at the start.

    A constant twist traces an arc; its chord is sinc(Δ/2) times the path and points along the
    heading half way (paper, equation 13, in the form that holds for Δ = 0 too).

    Returns
    -------
    dx, dy : float or ndarray, [m]
    """
    half = 0.5 * motion.turn
    shrink = sinc(half)
    middle = yaw + half
    if isinstance(middle, np.ndarray):
        cos, sin = np.cos(middle), np.sin(middle)
    else:
        cos, sin = math.cos(middle), math.sin(middle)
    dx = shrink * (cos * motion.along - sin * motion.sideways)
    dy = shrink * (sin * motion.along + cos * motion.sideways)
    return dx, dy
