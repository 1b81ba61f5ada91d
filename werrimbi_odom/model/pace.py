# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Usual message interval and recent wheel speeds, estimated from stamps that may be wrong.

A driver that blocks for a moment and then sends several messages at once does not make the wheels
faster, although its stamps suggest it. So a message that arrives much too early is checked over the
usual interval: the mean over a thousand messages, in which late and early arrivals cancel.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass, field

import numpy as np

from werrimbi_odom.model.pose import Floats

REMEMBERED = 1000
"""Number of messages that define the usual interval. Speeds are forgotten after at most twice
that."""
USUAL_AT_FIRST = 0.1
"""Assumed interval before the first message [s]."""
PAUSE = 1.0
"""A longer interval [s] restarts the estimate of the usual one, with this as its first value."""
CLOSE = 0.4
"""A message is too early after less than this share of the usual interval."""


def lasted_over(duration: float, usual: float) -> float:
    """Interval [s] over which to check what happened in `duration`."""
    return duration if duration >= CLOSE * usual else usual


def seen(rate: float, fastest: float, newer: float, room: int) -> tuple[float, float, int]:
    """Update the fastest recent speeds, of all and of the newer messages, with one more [turns/s].

    `room` is the number of messages until only the newer ones are remembered.
    """
    if rate > newer:
        newer = rate
        if rate > fastest:
            fastest = rate
    if room == 1:
        return newer, 0.0, REMEMBERED
    return fastest, newer, room - 1


@dataclass(slots=True)
class Pace:
    """Recent intervals and speeds, one message at a time, in constant time and memory."""

    usual: float = USUAL_AT_FIRST
    """The usual interval [s]."""
    _stamps: deque[float] = field(default_factory=lambda: deque(maxlen=REMEMBERED + 1))
    fastest: float = 0.0
    """Fastest recent turn rate of a wheel [turns/s]."""
    _newer: float = 0.0
    _before: float = math.inf
    """The shortest usual interval before a pause [s]."""
    _room: int = REMEMBERED
    """Number of speeds until only the `_newer` ones are remembered."""

    def begin(self, time: float) -> None:
        """Restart the intervals at a message, with one usual interval before it."""
        self._stamps.clear()
        self._stamps.extend((time - self.usual, time))

    def hear(self, time: float, duration: float) -> None:
        """Add the stamp of a message and the time since the last one [s]."""
        stamps = self._stamps
        if duration > PAUSE:
            self._before = min(self._before, self.usual)
            self.usual = PAUSE
            self.begin(time)
        else:
            stamps.append(time)
            self.usual = (time - stamps[0]) / (len(stamps) - 1)

    @property
    def in_motion(self) -> float:
        """The usual interval of messages that come again after a pause as they did before it [s].

        The checks take a pause for usual at first, as a reset must not be missed. For a speed this
        would be too long: of each message after a pause it would be the mean over the pause.
        """
        return min(self.usual, self._before)

    def see(self, rate: float) -> None:
        """Add the speed of the faster wheel [turns/s]."""
        self.fastest, self._newer, self._room = seen(rate, self.fastest, self._newer, self._room)

    def stamps(self) -> Floats:
        """Remembered stamps, oldest first [s]."""
        return np.fromiter(self._stamps, dtype=np.float64, count=len(self._stamps))

    def speeds(self) -> tuple[float, float, int]:
        """State of `seen`."""
        return self.fastest, self._newer, self._room

    def have_seen(
        self, time: Floats, usual: float, fastest: float, newer: float, room: int
    ) -> None:
        """Update the state after n messages processed elsewhere, with their stamps, shape (n,)."""
        self._stamps.extend(time[-REMEMBERED - 1 :].tolist())
        self.usual, self.fastest, self._newer, self._room = usual, fastest, newer, room

    def usual_at(self, time: Floats) -> Floats:
        """Usual interval [s] now and after each of n messages without a pause; shape (n + 1,)."""
        stamps = np.concatenate([self.stamps(), time])
        last = np.arange(stamps.size - time.size, stamps.size)
        first = np.maximum(last - REMEMBERED, 0)
        return np.concatenate([[self.usual], (time - stamps[first]) / (last - first)])

    def have_heard(self, time: Floats, usual: float, rates: Floats) -> None:
        """Add n messages: stamps and speeds, shape (n,), and the usual interval after them."""
        fastest, newer, room = self.speeds()
        while rates.size >= room:
            some, rates = rates[:room], rates[room:]
            fastest, newer, room = max(newer, float(some.max())), 0.0, REMEMBERED
        newer = max(newer, float(rates.max(initial=0.0)))
        self.have_seen(time, float(usual), max(fastest, newer), newer, room - rates.size)
