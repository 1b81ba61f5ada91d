# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The last minutes of driving as messages, in bounded memory; of standing hardly anything."""

from __future__ import annotations

import math
import pickle
from collections import deque
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

MOST_BYTES = 50_000_000
"""That are kept at the most: ten minutes at 50 Hz take 12 MB."""
OVERHEAD = 200
"""Bytes that Python takes for a message beside its own: a tuple, two numbers, and two heads."""
MOVES, MOVES_TURN = 1e-3, 2e-3
"""Speeds above these [m/s, rad/s] are driving: a standing robot of fine counts shows none."""
LINGER = 1.0
"""Seconds after driving in which all is still kept: the end of the motion, as it was seen."""
RESTING = 0.5
"""Seconds between two messages of a topic that are kept while the robot stands: of a night, few."""
PAUSE = 1.0
"""Of two messages that are farther apart [s] nobody knows whether it drove in between."""


class ReceivedMessage(NamedTuple):
    """A message as it came."""

    driven: float
    """Seconds of driving before it."""
    received: int
    """By the node's clock [ns]."""
    topic: int
    data: bytes


class Kept:
    """What was last said on some topics.

    Parameters
    ----------
    topics : sequence of (str, str)
        Full names, and types of messages.
    seconds : float
        Of driving that are kept [s].
    """

    def __init__(self, topics: Sequence[tuple[str, str]], seconds: float) -> None:
        self.driven = 0.0
        """Seconds of driving so far, by the stamps of the odometry."""
        self._topics = list(topics)
        self._seconds = seconds
        self._messages: deque[ReceivedMessage] = deque()
        self._bytes = 0
        self._last = [-math.inf] * len(self._topics)
        self._stamp = self._moved = -math.inf

    def motion(self, stamp: float, speed: float, yaw_rate: float) -> None:
        """Note a twist of the odometry [s, m/s, rad/s]."""
        step, self._stamp = stamp - self._stamp, stamp
        if abs(speed) > MOVES or abs(yaw_rate) > MOVES_TURN:
            self._moved = stamp
            if 0.0 < step < PAUSE:
                self.driven += step

    def take(self, topic: int, received: int, data: bytes) -> None:
        """Keep a message, and let go what is too old."""
        stands = self._stamp - self._moved > LINGER
        if stands and 0.0 <= 1e-9 * received - self._last[topic] < RESTING:
            return
        self._last[topic] = 1e-9 * received
        self._messages.append(ReceivedMessage(self.driven, received, topic, data))
        self._bytes += len(data) + OVERHEAD
        oldest = self.driven - self._seconds
        while self._messages[0].driven < oldest or self._bytes > MOST_BYTES:
            self._bytes -= len(self._messages.popleft().data) + OVERHEAD

    def write(self, file: Path) -> None:
        """All that is kept: topics, and messages with when they came and their topic's number."""
        messages = [each[1:] for each in self._messages]
        with file.open("wb") as out:
            pickle.dump((self._topics, messages), out)
