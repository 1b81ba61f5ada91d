# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""From wheel travel to body motion to displacement (paper, equations 13 and 14).

Every function takes floats or arrays of one shape. So the node, which computes single steps, and a
recorded run, computed all at once, use the same code.
"""

from __future__ import annotations

import math
from typing import Any, Generic, NamedTuple, TypeVar, overload

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
    """Body motion for a wheel travel: D = (L + R) / 2 and Δ = (R - L) / B."""
    left, right = travel
    along = 0.5 * (left + right)
    return BodyMotion(along, 0.0 * along, (right - left) / track)


def mean_twist(motion: BodyMotion[Number], duration: float) -> BodyMotion[Number]:
    """Mean speeds [m/s, m/s, rad/s] of a motion over a duration [s]."""
    along, sideways, turn = motion
    per_second = 1.0 / duration
    return BodyMotion(along * per_second, sideways * per_second, turn * per_second)


@overload
def sinc(x: float) -> float: ...
@overload
def sinc(x: Floats) -> Floats: ...
def sinc(x: float | Floats) -> float | Floats:
    """sin(x) / x, and 1 at zero (numpy's sinc has a factor of pi)."""
    if isinstance(x, np.ndarray):
        with np.errstate(invalid="ignore"):  # 0 / 0
            found = np.asarray(np.sin(x) / x)
        found[x == 0.0] = 1.0
        return found
    return sinc_of_float(x)


def sinc_of_float(x: float) -> float:
    """`sinc` for a single number."""
    return math.sin(x) / x if x != 0.0 else 1.0


@overload
def cos_sin(angle: float) -> tuple[float, float]: ...
@overload
def cos_sin(angle: Floats) -> tuple[Floats, Floats]: ...
def cos_sin(angle: Any) -> Any:
    """Cosine and sine of an angle [rad]."""
    if isinstance(angle, np.ndarray):
        return np.cos(angle), np.sin(angle)
    return cos_sin_of_float(angle)


def cos_sin_of_float(angle: float) -> tuple[float, float]:
    """`cos_sin` for a single number."""
    return math.cos(angle), math.sin(angle)


def displacement(motion: BodyMotion[Number], yaw: Number) -> tuple[Number, Number]:
    """Displacement of the axle's midpoint, in the frame in which its start heading is `yaw`.

    A constant twist traces an arc. Its chord is sinc(Δ/2) times as long and points along the
    heading at mid-arc (paper, equation 13, in a form that also holds for Δ = 0).

    Returns
    -------
    dx, dy : float or ndarray, [m]
    """
    along, sideways, turn = motion
    half = 0.5 * turn
    shrink = sinc(half)
    cos, sin = cos_sin(yaw + half)
    return shrink * (cos * along - sin * sideways), shrink * (sin * along + cos * sideways)


class Chord(NamedTuple, Generic[Number]):
    """Chord of the arc of a constant twist: relative length and direction."""

    shrink: Number
    """sinc(Δ/2): its length relative to the arc."""
    cos: Number
    """Cosine of the heading at mid-arc ..."""
    sin: Number
    """... and sine."""


def chord_of(turn: Number, yaw: Number) -> Chord[Number]:
    """Chord of a turn that begins at heading `yaw` [rad]."""
    half = 0.5 * turn
    cos, sin = cos_sin(yaw + half)
    return Chord(sinc(half), cos, sin)


def along_chord(motion: BodyMotion[Number], chord: Chord[Number]) -> tuple[Number, Number]:
    """`displacement` [m] of a motion, given its chord."""
    along, sideways, _ = motion
    shrink, cos, sin = chord
    return shrink * (cos * along - sin * sideways), shrink * (sin * along + cos * sideways)
