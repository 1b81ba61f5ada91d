# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""How often messages come and how fast wheels turn, learnt from stamps that may lie; and forgotten.

A driver that hangs for a moment and then sends several messages at once has not made the wheels any
faster, though its stamps say so. So a message that comes much sooner than usual is judged over the
usual interval: the mean one over a thousand messages, in which what came late and what came soon
after it make up for each other.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field

import numpy as np

from werrimbi_odom.model.pose import Floats

REMEMBERED = 1000
"""Messages whose intervals are the usual ones. What is twice as old is forgotten altogether."""
USUAL_AT_FIRST = 0.1
"""Taken for the interval before the first message [s]."""
PAUSE = 1.0
"""After a longer interval [s] what is usual is learnt anew, with this for the first interval."""
CLOSE = 0.4
"""A message comes too soon when it comes after less than this share of the usual interval."""


def lasted_over(duration: float, usual: float) -> float:
    """Seconds over which to judge what happened in an interval."""
    return duration if duration >= CLOSE * usual else usual


def seen(rate: float, fastest: float, newer: float, room: int) -> tuple[float, float, int]:
    """The fastest speeds of late, in all and of the newer messages, after one more [turns/s].

    `room` is how many messages may come before only the newer ones are remembered.
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
    """Intervals and speeds of late, a message at a time, in constant time and memory."""

    usual: float = USUAL_AT_FIRST
    """The usual interval [s]."""
    _stamps: deque[float] = field(default_factory=lambda: deque(maxlen=REMEMBERED + 1))
    fastest: float = 0.0
    """Fastest that a wheel has turned of late [turns/s]."""
    _newer: float = 0.0
    _room: int = REMEMBERED
    """Speeds to come before only the `_newer` ones are remembered."""

    def begin(self, time: float) -> None:
        """Learn intervals anew from a message on, with the usual one before it."""
        self._stamps.clear()
        self._stamps.extend((time - self.usual, time))

    def hear(self, time: float, duration: float) -> None:
        """Take the stamp of a message and the seconds since the last one."""
        stamps = self._stamps
        if duration > PAUSE:
            self.usual = PAUSE
            self.begin(time)
        else:
            stamps.append(time)
            self.usual = (time - stamps[0]) / (len(stamps) - 1)

    def see(self, rate: float) -> None:
        """Take the speed of the faster wheel [turns/s]."""
        self.fastest, self._newer, self._room = seen(rate, self.fastest, self._newer, self._room)

    def stamps(self) -> Floats:
        """Those that are remembered, the oldest first [s]."""
        return np.fromiter(self._stamps, dtype=np.float64, count=len(self._stamps))

    def speeds(self) -> tuple[float, float, int]:
        """What `seen` goes on with."""
        return self.fastest, self._newer, self._room

    def have_seen(
        self, time: Floats, usual: float, fastest: float, newer: float, room: int
    ) -> None:
        """Go on behind n messages that were taken elsewhere, with their stamps, shape (n,)."""
        self._stamps.extend(time[-REMEMBERED - 1 :].tolist())
        self.usual, self.fastest, self._newer, self._room = usual, fastest, newer, room

    def usual_at(self, time: Floats) -> Floats:
        """The usual interval [s] now and after each of n messages without a pause; (n + 1,)."""
        stamps = np.concatenate([self.stamps(), time])
        last = np.arange(stamps.size - time.size, stamps.size)
        first = np.maximum(last - REMEMBERED, 0)
        return np.concatenate([[self.usual], (time - stamps[first]) / (last - first)])

    def have_heard(self, time: Floats, usual: float, rates: Floats) -> None:
        """Take n messages at once: stamps and speeds, shape (n,); and what is usual after them."""
        fastest, newer, room = self.speeds()
        while rates.size >= room:
            some, rates = rates[:room], rates[room:]
            fastest, newer, room = max(newer, float(some.max())), 0.0, REMEMBERED
        newer = max(newer, float(rates.max(initial=0.0)))
        self.have_seen(time, float(usual), max(fastest, newer), newer, room - rates.size)
