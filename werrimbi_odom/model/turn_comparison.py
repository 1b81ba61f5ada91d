# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Compares the turn by the wheels with that by a gyro, on one clock, over part of a second."""

from __future__ import annotations

import math
from collections import deque

Series = deque[tuple[float, float]]

KEPT = 1.0
"""Duration that is kept of both [s]."""


class Turns:
    """Headings of the wheels and of a gyro; both may arrive late.

    Parameters
    ----------
    window : float
        Duration over which they are compared [s].
    """

    def __init__(self, window: float) -> None:
        self._window = window
        self._wheels: Series = deque(maxlen=2000)
        self._gyro: Series = deque(maxlen=2000)

    def wheels(self, stamp: float, yaw: float) -> None:
        """Add a heading of the odometry [rad]."""
        before = self._wheels[-1][1] if self._wheels else yaw
        _add(self._wheels, stamp, before + math.remainder(yaw - before, 2.0 * math.pi))

    def gyro(self, stamp: float, rate: float) -> None:
        """Add a yaw rate [rad/s]; it holds since the previous reading."""
        before = self._gyro[-1] if self._gyro else (stamp, 0.0)
        _add(self._gyro, stamp, before[1] + rate * (stamp - before[0]))

    @property
    def span(self) -> tuple[float, float] | None:
        """Start and end of the last window that both cover; None if there is none."""
        if not self._wheels or not self._gyro:
            return None
        end = min(self._wheels[-1][0], self._gyro[-1][0])
        begin = end - self._window
        return None if begin < max(self._wheels[0][0], self._gyro[0][0]) else (begin, end)

    def apart(self, time: float) -> float:
        """Heading by the wheels minus heading by the gyro [rad], up to a constant."""
        return _at(self._wheels, time) - _at(self._gyro, time)

    def difference(self) -> float:
        """Turn by the wheels minus turn by the gyro over the last window [rad]; 0 if none."""
        span = self.span
        return 0.0 if span is None else self.apart(span[1]) - self.apart(span[0])

    def turn(self, begin: float, end: float) -> float:
        """Turn by the wheels between two times [rad]."""
        return _at(self._wheels, end) - _at(self._wheels, begin)


def _add(series: Series, stamp: float, value: float) -> None:
    """Append a value; a stamp that goes back restarts the series."""
    if series and stamp <= series[-1][0]:
        series.clear()
    series.append((stamp, value))
    while stamp - series[0][0] > KEPT:
        series.popleft()


def _at(series: Series, time: float) -> float:
    """Value at a time within the series, by linear interpolation."""
    after = series[-1]
    for before in reversed(series):
        if before[0] <= time:
            span = after[0] - before[0]
            share = (time - before[0]) / span if span > 0.0 else 0.0
            return before[1] + share * (after[1] - before[1])
        after = before
    return series[0][1]
