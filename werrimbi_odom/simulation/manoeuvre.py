# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Commands to a robot: speed and yaw rate, piecewise linear in time."""

from __future__ import annotations

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
        """Mean speed and yaw rate over each interval between `times`.

        Exact means, not samples, so that a commanded path closes on any time grid.

        Parameters
        ----------
        times : ndarray, shape (n + 1,)
            Increasing [s]. Commands are zero before the first and after the last knot.

        Returns
        -------
        speed, yaw_rate : ndarray, shape (n,)
            [m/s], [rad/s].
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

    Parameters
    ----------
    name : str
    steps : sequence of (length, turn)
        Signed length [m] and turn [rad] of each move; both together make an arc.
    pace : MoveLimits, optional
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
    rate = min(_ratio(pace.speed, length), _ratio(pace.yaw_rate, turn))
    ramp = min(_ratio(pace.acceleration, length), _ratio(pace.yaw_acceleration, turn))
    rate = min(rate, ramp**0.5)  # a short move does not reach full speed
    rise = rate / ramp
    cruise = 1.0 / rate - rise
    return [(0.0, 0.0), (rise, rate), (rise + cruise, rate), (2 * rise + cruise, 0.0)]


def _ratio(limit: float, amount: float) -> float:
    return limit / abs(amount) if amount else float("inf")
