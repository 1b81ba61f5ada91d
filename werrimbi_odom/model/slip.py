# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What a gyro says that the wheels missed: by how much less sure of its pose a robot should be.

The wheels' noise of the paper is that of rolling. A wheel that slips is not in it: the heading goes
astray by what the wheels turned and the body did not, all to one side. Where a gyro contradicts the
wheels by more than both can err, the difference, added up since they parted, is taken for one
standard deviation of the heading; and of the way along, what one wheel must have missed for it.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from werrimbi_odom.model.turns import Turns

WINDOW = 0.2
"""Over which wheels and gyro are compared [s]. Shorter, noise and counts hide slip; longer, it
comes late: a filter goes wrong by a fifth of a second's turn before it is told."""
GYRO_BIAS = 0.01
"""Bias of a gyro [rad/s] that is no slip: that of a cheap one after its driver took the mean of a
standstill."""
GYRO_SCALE = 0.03
"""Share of a turn that the gyro's scale, or a base that is a little wrong, may make: data sheets of
cheap gyros state 2 to 3 %, and a base that is worse is found by `diagnose`, not here."""
GYRO_NOISE = 0.005
"""Standard deviation of one reading [rad/s]: of cheap gyros at 100 Hz, 0.5 mrad/s in the root of a
hertz."""
SURE = 4.0
"""Standard deviations of that noise that are no slip yet: beyond four are 6 of 100,000 windows, and
the bias and the scale, which are seldom all used up, come on top."""
CLOCKS = 0.02
"""By which stamps of gyro and counters may be apart [s]: a period of counters at 50 Hz, for drivers
that stamp on arrival. It matters where the rate changes."""


class Missed(NamedTuple):
    """Variances to be added now: of the way along [m^2], and of the heading [rad^2]."""

    along: float
    heading: float


NOTHING = Missed(0.0, 0.0)


class SlipGuard:
    """Watches wheels and gyro.

    Parameters
    ----------
    track : float
        Distance between the wheels [m].
    tick : float
        Travel of the coarser wheel for a count [m].
    """

    def __init__(self, track: float, tick: float) -> None:
        self.track, self.tick = track, tick
        self.times = 0
        """How often the wheels have slipped."""
        self.missed = 0.0
        """Turn that they made and the body did not, in all [rad], as sizes."""
        self._turns = Turns(WINDOW)
        self._gap = 0.02
        self._gyro_at: float | None = None
        self._parted: float | None = None  # their difference when they parted
        self._counted = 0.0  # of the present slip [rad]
        self._seen = -1.0

    def gyro(self, time: float, rate: float) -> None:
        """Take a yaw rate [rad/s]."""
        if self._gyro_at is not None and time > self._gyro_at:
            self._gap = min(time - self._gyro_at, WINDOW)
        self._gyro_at = time
        self._turns.gyro(time, rate)

    def wheels(self, time: float, yaw: float) -> Missed:
        """Take a heading by the wheels [rad]; what is to be added to the pose's covariance."""
        self._turns.wheels(time, yaw)
        span = self._turns.span
        if span is None or span[1] == self._seen:
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
        """Difference of the turns over a window that is no slip [rad]."""
        middle = 0.5 * (begin + end)
        first, second = self._turns.turn(begin, middle), self._turns.turn(middle, end)
        change = abs(second - first) / (middle - begin)
        noise = SURE * GYRO_NOISE * math.sqrt(self._gap * WINDOW)
        counts = 2.0 * self.tick / self.track
        return (
            GYRO_BIAS * WINDOW + GYRO_SCALE * abs(first + second) + CLOCKS * change + noise + counts
        )
