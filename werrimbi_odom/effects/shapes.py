# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Means of functions over a step: a square, a step, a curve, a wave, a spot.

A quantity is linear in time between a step's start and its end. The mean of a function over it is
exact, so that it does not depend on the message rate.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from werrimbi_odom.effects.functions import cos, limited, share, sin, sinc
from werrimbi_odom.model.drive import Drive, Span
from werrimbi_odom.model.motion import Number
from werrimbi_odom.model.pose import Floats

__all__ = [
    "mean_cos",
    "mean_curve",
    "mean_product",
    "mean_ratio",
    "mean_sin",
    "mean_square",
    "mean_step",
    "share_inside",
    "standing",
    "steady",
]


def steady(value: Number) -> Span[Number]:
    """A quantity that is constant during the step."""
    return Span(value, value)


def mean_square(span: Span[Number]) -> Number:
    """Mean of the square of a quantity."""
    return (span.start * span.start + span.start * span.end + span.end * span.end) / 3.0


def mean_product(one: Span[Number], other: Span[Number]) -> Number:
    """Mean of the product of two quantities."""
    return one.mean * other.mean + one.change * other.change / 12.0


def mean_ratio(one: Span[Number], other: Span[Number]) -> Number:
    """Mean of the ratio of two quantities; the ratio of their means if the second comes near zero.

    The second is middle * (1 + swing * s), with s from -1 to 1. With m = artanh(swing) / swing, the
    mean of 1 / (1 + swing * s) is m, and that of s / (1 + swing * s) is (1 - m) / swing.
    """
    middle = other.mean
    swing = share(0.5 * other.change, middle)
    even, odd = _over_a_line(swing)
    return share(one.mean * even + 0.5 * one.change * odd, middle)


def _over_a_line(swing: Number) -> tuple[Number, Number]:
    """Means of 1 / (1 + swing * s) and of s / (1 + swing * s)."""
    if isinstance(swing, np.ndarray):
        small, wild = np.abs(swing) < _GENTLE, np.abs(swing) > _NEAR_ZERO
        even, odd = _series(np.where(small, swing, 0.0))
        usual = np.where(small | wild, _GENTLE, swing)
        mean = np.arctanh(usual) / usual
        other = small | wild
        return np.where(other, even, mean), np.where(other, odd, (1.0 - mean) / usual)
    if abs(swing) > _NEAR_ZERO:
        return 1.0 + 0.0 * swing, 0.0 * swing
    if abs(swing) < _GENTLE:
        return _series(swing)
    mean = math.atanh(swing) / swing
    return mean, (1.0 - mean) / swing


def _series(swing: Number) -> tuple[Number, Number]:
    """Series expansion of `_over_a_line` for a small swing."""
    square = swing * swing
    rest = 1.0 / 3.0 + square * (1.0 / 5.0 + square / 7.0)
    return 1.0 + square * rest, -swing * rest


_NEAR_ZERO, _GENTLE = 0.9, 0.01
"""Half the relative change of a denominator in a step: above the first it is too close to zero;
below the second the first terms of the series are exact to rounding."""


def mean_cos(span: Span[Number]) -> Number:
    """Mean of the cosine of an angle [rad]."""
    return sinc(0.5 * span.change) * cos(span.mean)


def mean_sin(span: Span[Number]) -> Number:
    """Mean of the sine of an angle [rad]."""
    return sinc(0.5 * span.change) * sin(span.mean)


def mean_step(span: Span[Number], edge: float, width: float) -> Number:
    """Mean of a step from 0 to 1 with a linear rise over `width` around `edge`."""
    return mean_curve(span, (edge - 0.5 * width, edge + 0.5 * width), (0.0, 1.0))


def mean_curve(span: Span[Number], knots: Sequence[float], heights: Sequence[float]) -> Number:
    """Mean of a piecewise linear curve with `heights` at `knots`, constant beyond both ends."""
    change = span.change
    area = _area(span.end, knots, heights) - _area(span.start, knots, heights)
    here = _height(span.mean, knots, heights)
    if isinstance(change, np.ndarray):
        moving = abs(change) > _STILL
        return np.where(moving, np.divide(area, change, out=here.copy(), where=moving), here)
    return area / change if abs(change) > _STILL else here


_STILL = 1e-7
"""Change of a quantity (in its unit) below which its mean value is used."""


def _height(value: Number, knots: Sequence[float], heights: Sequence[float]) -> Number:
    found = heights[0] + 0.0 * value
    for i in range(len(knots) - 1):
        slope = (heights[i + 1] - heights[i]) / (knots[i + 1] - knots[i])
        found = found + slope * (limited(value, knots[i], knots[i + 1]) - knots[i])
    return found


def _area(value: Number, knots: Sequence[float], heights: Sequence[float]) -> Number:
    """Area under the curve, from the first knot to a value."""
    found = heights[0] * (value - knots[0])
    for i in range(len(knots) - 1):
        slope = (heights[i + 1] - heights[i]) / (knots[i + 1] - knots[i])
        within = limited(value, knots[i], knots[i + 1]) - knots[i]
        beyond = value - limited(value, -math.inf, knots[i + 1])
        width = knots[i + 1] - knots[i]
        found = found + slope * (0.5 * within * within + width * beyond)
    return found


def share_inside(
    x: Span[Number], y: Span[Number], centre_x: float, centre_y: float, radius: float
) -> Number:
    """Share of the straight path from (x, y) at a step's start to its end inside a circle."""
    if isinstance(x.start, np.ndarray):
        return _inside(x, y, centre_x, centre_y, radius)
    one_x, one_y = (Span(np.array([s.start]), np.array([s.end])) for s in (x, y))
    return float(_inside(one_x, one_y, centre_x, centre_y, radius)[0])


def standing(drive: Drive[Number], left: float) -> tuple[Span[Number], Span[Number]]:
    """Spans of x and y [m] of a point (a wheel) `left` [m] of the axle's midpoint."""
    start, end = drive.heading
    return (
        Span(drive.x.start - left * sin(start), drive.x.end - left * sin(end)),
        Span(drive.y.start + left * cos(start), drive.y.end + left * cos(end)),
    )


def _inside(x: Span[Floats], y: Span[Floats], at_x: float, at_y: float, radius: float) -> Floats:
    way_x, way_y = x.change, y.change
    from_x, from_y = x.start - at_x, y.start - at_y
    # Points of the path are (from + u * way), u from 0 to 1. They are inside the circle where
    # way² u² + 2 (from · way) u + from² - radius² < 0.
    square = way_x * way_x + way_y * way_y
    along = from_x * way_x + from_y * way_y
    apart = from_x * from_x + from_y * from_y - radius * radius
    still = square < 1e-18
    middle = share(-along, square)
    root = np.sqrt(np.maximum(middle * middle - share(apart, square), 0.0))
    inside = limited(middle + root, 0.0, 1.0) - limited(middle - root, 0.0, 1.0)
    return np.asarray(np.where(still, np.where(apart < 0.0, 1.0, 0.0), inside))
