# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Manoeuvres: commands of speed and yaw rate, piecewise linear in time, and a library of them.

Squares, out and back, spins, eights, arcs, free and hard driving.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Knot = tuple[float, float, float]


@dataclass(frozen=True)
class Manoeuvre:
    """A scripted drive: commands to the robot's speed controller, as from a joystick."""

    name: str
    """Name of the run folder."""
    knots: tuple[Knot, ...]
    """Knots of the piecewise linear commands [s, m/s, rad/s] in the order of time; anticlockwise is
    positive. Two knots at the same time make a step."""

    @property
    def duration(self) -> float:
        """Time of the last knot [s]."""
        return self.knots[-1][0]

    def commands(self, times: Floats) -> tuple[Floats, Floats]:
        """Mean speed [m/s] and yaw rate [rad/s] over each interval between `times` [s].

        Exact means, not samples, so that a commanded path closes on any time grid. Commands are
        zero before the first and after the last knot. Shapes are (n + 1,) of the times and (n,) of
        the means.
        """
        t, speed, yaw_rate = (np.array(column) for column in zip(*self.knots, strict=True))
        return _means(t, speed, times), _means(t, yaw_rate, times)


def _means(t: Floats, value: Floats, times: Floats) -> Floats:
    """Exact mean of the piecewise linear `value` between successive `times`."""
    at = np.clip(times, t[0], t[-1])
    integral_at_knots = np.concatenate(
        ([0.0], np.cumsum(np.diff(t) * (value[1:] + value[:-1]) / 2))
    )
    left = np.clip(np.searchsorted(t, at, side="right") - 1, 0, len(t) - 2)
    width = t[left + 1] - t[left]
    slope = np.divide(
        value[left + 1] - value[left], width, out=np.zeros_like(width), where=width > 0
    )
    since = at - t[left]
    integral = integral_at_knots[left] + value[left] * since + slope * since**2 / 2
    means: Floats = np.diff(integral) / np.diff(times)
    return means


@dataclass(frozen=True)
class MoveLimits:
    """Limits of speed and acceleration for moves."""

    speed: float = 0.4
    acceleration: float = 0.5
    """[m/s], [m/s^2]."""
    yaw_rate: float = 1.2
    yaw_acceleration: float = 2.5
    """[rad/s], [rad/s^2]."""
    pause: float = 0.3
    """Rest after each move [s]."""


def moves(
    name: str, steps: Sequence[tuple[float, float]], pace: MoveLimits | None = None
) -> Manoeuvre:
    """A manoeuvre of moves from rest to rest, each a line, an arc or a turn on the spot.

    Steps are (length, turn), signed [m, rad]; both together make an arc, (0, 0) a rest.
    """
    pace = pace or MoveLimits()
    knots: list[Knot] = [(0.0, 0.0, 0.0)]
    for length, turn in steps:
        start = knots[-1][0]
        knots += [
            (start + t, length * rate, turn * rate) for t, rate in _trapezium(length, turn, pace)
        ]
        knots.append((knots[-1][0] + pace.pause, 0.0, 0.0))
    return Manoeuvre(name, tuple(knots))


def _trapezium(length: float, turn: float, pace: MoveLimits) -> list[tuple[float, float]]:
    """Trapezoidal speed profile: corners (time, rate) of a move's progress from 0 to 1."""
    if not (length or turn):
        return []
    rate = min(_ratio(pace.speed, length), _ratio(pace.yaw_rate, turn))
    ramp = min(_ratio(pace.acceleration, length), _ratio(pace.yaw_acceleration, turn))
    rate = min(rate, ramp**0.5)  # a short move does not reach full speed
    rise = rate / ramp
    cruise = 1.0 / rate - rise
    return [(0.0, 0.0), (rise, rate), (rise + cruise, rate), (2 * rise + cruise, 0.0)]


def _ratio(limit: float, amount: float) -> float:
    return limit / abs(amount) if amount else float("inf")


def square(
    side: float = 2.0, sense: str = "ccw", *, laps: int = 1, pace: MoveLimits | None = None
) -> Manoeuvre:
    """`laps` squares of `side` [m] with turns on the spot, to the left (`ccw`) or right (`cw`).

    The last corner is turned too, so an ideal robot ends at its start pose (UMBmark).
    """
    corner = {"ccw": math.pi / 2, "cw": -math.pi / 2}[sense]
    return moves(f"square_{sense}", [(side, 0.0), (0.0, corner)] * (4 * laps), pace)


def out_and_back(
    distance: float = 10.0,
    *,
    turn_round: bool = False,
    laps: int = 1,
    pace: MoveLimits | None = None,
) -> Manoeuvre:
    """Forwards by `distance` [m] and backwards again (Chong and Kleeman 1997, section 5.2).

    With `turn_round`, half a turn at each end instead of driving backwards.
    """
    if turn_round:
        lap = [(distance, 0.0), (0.0, math.pi), (distance, 0.0), (0.0, -math.pi)]
    else:
        lap = [(distance, 0.0), (-distance, 0.0)]
    return moves("out_and_back", lap * laps, pace)


def spin(turns: float = 5.0, *, pace: MoveLimits | None = None) -> Manoeuvre:
    """`turns` full turns on the spot without a stop, anticlockwise if positive."""
    return moves("spin", [(0.0, 2 * math.pi * turns)], pace)


def spins(turns: float = 2.0, *, pairs: int = 2, pace: MoveLimits | None = None) -> Manoeuvre:
    """Alternate spins to the left and to the right, `pairs` of each."""
    angle = 2 * math.pi * turns
    return moves("spins", [(0.0, angle), (0.0, -angle)] * pairs, pace)


def figure_eight(
    radius: float = 1.0, *, laps: int = 1, pace: MoveLimits | None = None
) -> Manoeuvre:
    """Circles of `radius` [m], one to the left and one to the right in each lap."""
    around = 2 * math.pi * radius
    lap = [(around, 2 * math.pi), (around, -2 * math.pi)]
    return moves("figure_eight", lap * laps, pace)


def arcs(
    radii: tuple[float, ...] = (0.3, 0.6, 1.2, 2.4),
    *,
    angle: float = math.pi,
    pace: MoveLimits | None = None,
) -> Manoeuvre:
    """Arcs of several radii [m]: left and right, each forwards and backwards."""
    steps = [
        (direction * radius * angle, direction * sense * angle)
        for radius in radii
        for sense in (1.0, -1.0)
        for direction in (1.0, -1.0)
    ]
    return moves("arcs", steps, pace)


def pivots() -> Manoeuvre:
    """Half turns about one wheel at rest, both wheels, both directions, on a base of 0.35 m."""
    ways = ((1.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0))
    return moves("pivots", [(along * 0.175 * math.pi, turn * math.pi) for along, turn in ways])


def start_stop(
    hops: int = 6,
    *,
    length: float = 0.5,
    acceleration: float = 2.5,
    speed: float = 0.8,
    laps: int = 2,
) -> Manoeuvre:
    """Hard starts and stops: `hops` of `length` [m] forwards and as many back, `laps` times."""
    pace = MoveLimits(speed=speed, acceleration=acceleration, pause=0.25)
    lap = [(length, 0.0)] * hops + [(-length, 0.0)] * hops
    return moves("start_stop", lap * laps, pace)


def free(
    duration: float = 60.0,
    *,
    seed: int = 0,
    speed: float = 0.5,
    yaw_rate: float = 1.5,
    acceleration: float = 0.6,
    backwards: float = 0.2,
) -> Manoeuvre:
    """Random driving as with a joystick: new speed and yaw rate every second or two.

    It ends at rest slightly after `duration` [s]. Speed [m/s] and yaw rate [rad/s] are the largest
    values. The yaw acceleration has four times the value of the typical acceleration [m/s^2].
    `backwards` is the share of the time spent driving backwards.
    """
    rng = np.random.default_rng(seed)
    knots: list[Knot] = [(0.0, 0.0, 0.0)]
    while knots[-1][0] < duration:
        v = speed * rng.uniform(0.15, 1.0) * (-1.0 if rng.uniform() < backwards else 1.0)
        w = yaw_rate * rng.uniform(-1.0, 1.0)
        kind = rng.choice(["curve", "line", "spin", "rest"], p=[0.6, 0.25, 0.1, 0.05])
        v, w = {"curve": (v, w), "line": (v, 0.0), "spin": (0.0, w), "rest": (0.0, 0.0)}[str(kind)]
        _ramp(knots, v, w, acceleration)
        knots.append((knots[-1][0] + rng.uniform(0.4, 2.5), v, w))
    _ramp(knots, 0.0, 0.0, acceleration)
    return Manoeuvre("free", tuple(knots))


def _ramp(knots: list[Knot], speed: float, yaw_rate: float, acceleration: float) -> None:
    """Append the knot at which the new speed and yaw rate are reached."""
    t, v, w = knots[-1]
    takes = max(abs(speed - v) / acceleration, abs(yaw_rate - w) / (4 * acceleration), 0.05)
    knots.append((t + takes, speed, yaw_rate))


def chain(name: str, *parts: Manoeuvre) -> Manoeuvre:
    """Concatenate manoeuvres."""
    knots: list[Knot] = []
    for part in parts:
        start = knots[-1][0] if knots else 0.0
        knots += [(start + t, v, w) for t, v, w in part.knots]
    return Manoeuvre(name, tuple(knots))
