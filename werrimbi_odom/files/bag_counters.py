# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Counters of wheels from messages: two in one message, or a topic for each wheel."""

from __future__ import annotations

from array import array
from collections import Counter
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.bag import Message, left_out_words, stamp_of
from werrimbi_odom.files.bag_contents import INT32, Wheels
from werrimbi_odom.files.counter_pairs import Pairing
from werrimbi_odom.files.robot_file import RobotFile
from werrimbi_odom.files.run import Ticks


class Fields(NamedTuple):
    """Where a message has its counters, and the width at which they wrap."""

    left: str
    right: str
    bits: int


COUNTERS = {
    "turtlebot3_msgs/msg/SensorState": Fields("left_encoder", "right_encoder", 32),
    "kobuki_msgs/msg/SensorState": Fields("left_encoder", "right_encoder", 16),
    "kobuki_ros_interfaces/msg/SensorState": Fields("left_encoder", "right_encoder", 16),
    "irobot_create_msgs/msg/WheelTicks": Fields("ticks_left", "ticks_right", 32),
}
"""By message type."""


class Counters:
    """Both counters of a driver, in a message with a stamp."""

    def __init__(self, path: Path, source: Wheels, robot_file: RobotFile) -> None:
        self._place = f"{path}: {source.name}"
        self._fields = COUNTERS[source.kind]
        self._bits = _width(robot_file, self._fields.bits)
        self._time = array("d")
        self._counts = array("q")

    def take(self, message: Message) -> None:
        """Take a message."""
        self._time.append(stamp_of(message))
        for name in self._fields[:2]:
            self._counts.append(int(getattr(message.content, name)))

    def ticks(self) -> tuple[Ticks, list[str]]:
        """All of them."""
        if not self._time:
            raise InputError(f"{self._place}: it has no messages")
        left, right = np.array(self._counts, dtype=np.int64).reshape(-1, 2).T.copy()
        sides = (_unwrapped(left, self._bits), _unwrapped(right, self._bits))
        told = "counts as the driver gives them: so many a turn as the robot file says"
        return Ticks(np.array(self._time), *sides), [told]


class MultiArrays:
    """Two counters in one message without a stamp."""

    def __init__(self, path: Path, topic: str) -> None:
        self._place = f"{path}: {topic}"
        self._time = array("d")
        self._counts = array("q")
        self._left_out: Counter[str] = Counter()

    def take(self, message: Message) -> None:
        """Take a message."""
        if len(message.content.data) != 2:
            self._left_out["not of two values, left and right"] += 1
            return
        self._time.append(message.received / 1e9)
        self._counts.extend(int(count) for count in message.content.data)

    def ticks(self) -> tuple[Ticks, list[str]]:
        """All of them, and in words what was left out."""
        if not self._time:
            raise InputError(f"{self._place}: no message has two values, left and right")
        left, right = np.array(self._counts, dtype=np.int64).reshape(-1, 2).T.copy()
        return Ticks(np.array(self._time), left, right), left_out_words(self._left_out)


class Pairs:
    """A topic for each wheel, paired as the node does it; see `Pairing`."""

    def __init__(self, path: Path, source: Wheels, robot_file: RobotFile) -> None:
        self._place = f"{path}: {source.name}"
        self._left = source.name.split(",")[0]
        window = float(robot_file.values["pairing_window"])  # type: ignore[arg-type]
        self._pairing = Pairing(int(1e9 * window))
        self._bits = _width(robot_file, 32 if source.kind == INT32 else 0)
        self._time = array("d")
        self._counts = array("q")

    def take(self, message: Message) -> None:
        """Take a message."""
        side, count = int(message.topic != self._left), int(message.content.data)
        pair = self._pairing.take(side, count, message.received)
        if pair is not None:
            self._time.append(message.received / 1e9)
            self._counts.extend(pair)

    def ticks(self) -> tuple[Ticks, list[str]]:
        """All of them, and in words what was left out."""
        if not self._time:
            raise InputError(
                f"{self._place}: no two counts within the pairing_window of the robot file"
            )
        left, right = np.array(self._counts, dtype=np.int64).reshape(-1, 2).T.copy()
        sides = (_unwrapped(left, self._bits), _unwrapped(right, self._bits))
        left_out = Counter({"without a partner in time": self._pairing.unpaired})
        return Ticks(np.array(self._time), *sides), left_out_words(left_out)


def _width(robot_file: RobotFile, bits: int) -> int:
    """Width at which to unwrap what cannot but wrap there; 0 where the robot file says one."""
    return 0 if robot_file.values["encoder_bits"] else bits


def _unwrapped(counts: NDArray[np.int64], bits: int) -> NDArray[np.int64]:
    if not bits:
        return counts
    half = 1 << (bits - 1)
    steps = (np.diff(counts) + half) % (2 * half) - half
    return np.concatenate([counts[:1], counts[0] + np.cumsum(steps)])
