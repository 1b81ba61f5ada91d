# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Wheel slip detected with a gyro, and the variance that it adds to the pose.

The paper's wheel noise is that of rolling and does not cover slip. A slipping wheel biases the
heading: the wheels turn and the body does not. Where gyro and wheels disagree by more than the
errors of both, the difference accumulated since then is taken as one standard deviation of the
heading. If one wheel slipped, the axle's midpoint missed half of its lost travel; this is the
standard deviation along the path.

`Turns` compares both on one clock, over part of a second.
"""

from __future__ import annotations

import math
from collections import deque
from typing import NamedTuple

Series = deque[tuple[float, float]]

KEPT = 1.0
"""Duration that is kept of both [s]: the windows of 0.2 s, and how late either may arrive."""


class Turns:
    """Headings of the wheels and of a gyro; both may arrive late.

    `window`: duration over which they are compared [s].
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
    """Append a value; a stamp that goes back restarts the series, one that stands adds nothing."""
    if series and stamp == series[-1][0]:
        return
    if series and stamp < series[-1][0]:
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


WINDOW = 0.2
"""Window over which wheels and gyro are compared [s]. In a shorter one, noise and quantisation hide
slip. A longer one delays detection: a filter is wrong by the turn of a fifth of a second."""
GYRO_BIAS = 0.01
"""Bias of a gyro [rad/s] that is not taken as slip: that of a cheap one after its driver has
subtracted the mean at standstill."""
GYRO_SCALE = 0.03
"""Relative error of a turn from the gyro's scale or a slightly wrong base: data sheets of cheap
gyros state 2 to 3 %. A base that is worse is found by `diagnose`, not here."""
GYRO_NOISE = 0.005
"""Standard deviation of one reading [rad/s]: of cheap gyros at 100 Hz, 0.5 mrad/s per root
hertz."""
SURE = 4.0
"""Threshold in standard deviations of that noise: 6 of 100,000 windows exceed four, and the
allowances for bias and scale, which are seldom used up, come on top."""
CLOCKS = 0.02
"""Clock offset between gyro and counters [s]: a period of counters at 50 Hz, for drivers that stamp
on arrival. It matters where the rate changes."""


class Missed(NamedTuple):
    """Variances to add now: of the distance along the path [m^2], and of the heading [rad^2]."""

    along: float
    heading: float


NOTHING = Missed(0.0, 0.0)


class SlipGuard:
    """Detects slip from wheels and gyro.

    `track`: distance between the wheels [m]. `tick`: travel per count of the coarser wheel [m].
    """

    def __init__(self, track: float, tick: float) -> None:
        self.track, self.tick = track, tick
        self.times = 0
        """Number of slips so far."""
        self.missed = 0.0
        """Total turn of the wheels that the body did not make, in absolute values [rad]."""
        self._turns = Turns(WINDOW)
        self._gap = 0.02
        self._gyro_at: float | None = None
        self._parted: float | None = None  # their difference at the start of the slip
        self._counted = 0.0  # part of the present slip already reported [rad]
        self._seen = -1.0

    def gyro(self, time: float, rate: float) -> None:
        """Add a yaw rate [rad/s]."""
        if self._gyro_at is not None and time > self._gyro_at:
            self._gap = min(time - self._gyro_at, WINDOW)
        self._gyro_at = time
        self._turns.gyro(time, rate)

    def wheels(self, time: float, yaw: float) -> Missed:
        """Add a heading by the wheels [rad]; return what to add to the pose's covariance."""
        self._turns.wheels(time, yaw)
        span = self._turns.span
        if span is None:  # at first, and where a clock was set: what was apart before is not known
            self._parted = None
            return NOTHING
        if span[1] == self._seen:
            return NOTHING
        begin, self._seen = span
        apart = self._turns.apart(self._seen)
        if abs(self._turns.difference()) <= self._allowed(begin, self._seen):
            self._parted = None
            return NOTHING
        if self._parted is None:
            self._parted, self._counted = self._turns.apart(begin), 0.0
            self.times += 1
        size = abs(apart - self._parted)
        if size <= self._counted:
            return NOTHING
        more = size * size - self._counted * self._counted
        self.missed += size - self._counted
        self._counted = size
        return Missed(more * (0.5 * self.track) ** 2, more)

    def _allowed(self, begin: float, end: float) -> float:
        """Largest difference of the turns over a window that is not slip [rad]."""
        middle = 0.5 * (begin + end)
        first, second = self._turns.turn(begin, middle), self._turns.turn(middle, end)
        change = abs(second - first) / (middle - begin)
        noise = SURE * GYRO_NOISE * math.sqrt(self._gap * WINDOW)
        counts = 2.0 * self.tick / self.track
        return (
            GYRO_BIAS * WINDOW + GYRO_SCALE * abs(first + second) + CLOCKS * change + noise + counts
        )
