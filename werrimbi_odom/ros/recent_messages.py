# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The last minutes of driving as messages, in bounded memory; messages at rest are thinned out."""

from __future__ import annotations

import math
import pickle
from collections import deque
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

MOST_BYTES = 50_000_000
"""Largest size kept: ten minutes at 50 Hz take 12 MB."""
OVERHEAD = 200
"""Memory that Python uses per message besides the data: a tuple, two numbers, two headers."""
MOVES, MOVES_TURN = 1e-3, 2e-3
"""Speeds above these [m/s, rad/s] count as driving; a robot at rest with fine encoders shows
none."""
LINGER = 3.0
"""Time after driving for which all messages are kept [s], to include the end of the motion. By
reception, as the wheels' messages are ahead of the odometry, and far ahead in a bag that is played
fast."""
RESTING = 0.5
"""Interval between the messages of a topic that are kept at rest [s]."""
PAUSE = 1.0
"""A longer interval between two messages [s] does not count as driving."""


class ReceivedMessage(NamedTuple):
    """A message as received."""

    driven: float
    """Driving time before it [s]."""
    received: int
    """Reception time by the node's clock [ns]."""
    topic: int
    data: bytes


class Kept:
    """Messages of some topics (full names with types) from the last `seconds` of driving."""

    def __init__(self, topics: Sequence[tuple[str, str]], seconds: float) -> None:
        self.driven = 0.0
        """Driving time so far [s], by the stamps of the odometry."""
        self._topics = list(topics)
        self._seconds = seconds
        self._messages: deque[ReceivedMessage] = deque()
        self._bytes = 0
        self._last = [-math.inf] * len(self._topics)
        self._stamp = -math.inf
        self._at_rest_since = math.inf
        """Reception of the first twist at rest [s]; infinite while it drives."""

    def motion(self, received: int, stamp: float, speed: float, yaw_rate: float) -> None:
        """Add a twist of the odometry [ns, s, m/s, rad/s]."""
        step, self._stamp = stamp - self._stamp, stamp
        if abs(speed) > MOVES or abs(yaw_rate) > MOVES_TURN:
            self._at_rest_since = math.inf
            if 0.0 < step < PAUSE:
                self.driven += step
        else:
            self._at_rest_since = min(self._at_rest_since, 1e-9 * received)

    def take(self, topic: int, received: int, data: bytes) -> None:
        """Add a message, and delete those that are too old."""
        now = 1e-9 * received
        if now - self._at_rest_since > LINGER and 0.0 <= now - self._last[topic] < RESTING:
            return
        self._last[topic] = now
        self._messages.append(ReceivedMessage(self.driven, received, topic, data))
        self._bytes += len(data) + OVERHEAD
        oldest = self.driven - self._seconds
        while self._bytes > MOST_BYTES or (self._bytes and self._messages[0].driven < oldest):
            self._bytes -= len(self._messages.popleft().data) + OVERHEAD

    def write(self, file: Path) -> None:
        """Write the topics, and all messages with their reception time and topic index."""
        messages = [each[1:] for each in self._messages]
        with file.open("wb") as out:
            pickle.dump((self._topics, messages), out)
