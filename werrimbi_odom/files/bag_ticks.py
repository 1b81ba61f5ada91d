# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Ticks from the messages of a bag, read as the node reads them live."""

from __future__ import annotations

import difflib
import math
from array import array
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.bag import Message, Topic, topic_in_words
from werrimbi_odom.files.pairing import Pairing
from werrimbi_odom.files.robot_file import RobotFile
from werrimbi_odom.files.run import Ticks, counts_of
from werrimbi_odom.files.wheel_sides import side_counts
from werrimbi_odom.model.encoder import Counts

JOINT_STATE = "sensor_msgs/msg/JointState"
INT32, INT64 = "std_msgs/msg/Int32", "std_msgs/msg/Int64"
MULTI_ARRAY = "std_msgs/msg/Int64MultiArray"
KINDS = {
    "joint_state": JOINT_STATE,
    "int32_pair": INT32,
    "int64_pair": INT64,
    "int64_multi_array": MULTI_ARRAY,
}
"""Message type of each `input_type`."""


class TicksSource(NamedTuple):
    """The topics that hold a run's ticks: one, or left and right."""

    topics: tuple[str, ...]
    kind: str


def choose_ticks(
    path: Path, topics: Sequence[Topic], wish: str | None, robot_file: RobotFile
) -> TicksSource:
    """The source that is wished for, or the only one there is.

    Parameters
    ----------
    wish : str, optional
        A topic, or LEFT,RIGHT for two.

    Raises
    ------
    InputError
        When there is none, or several; the message lists them.
    """
    sources = _candidates(topics)
    if wish is not None:
        wished = tuple("/" + name.strip().strip("/") for name in wish.split(","))
        kinds = [topic.kind for name in wished for topic in topics if topic.name == name]
        source = TicksSource(wished, kinds[0] if kinds else "")
        wheels = 2 if source.kind in (INT32, INT64) else 1
        if [source.kind] * wheels == kinds and source.kind in KINDS.values():
            return source
        if len(kinds) == 1 and wheels == 2:
            raise InputError(f"{path}: {wish} is one wheel; --ticks-topic LEFT,RIGHT names both")
        raise InputError(f"{path}: there are no ticks in {wish}; {_listed(sources)}")
    of_file = [each for each in sources if each.kind == KINDS[str(robot_file.values["input_type"])]]
    chosen = of_file or sources
    if len(chosen) == 1:
        return chosen[0]
    if chosen:
        raise InputError(f"{path}: choose with --ticks-topic; {_listed(chosen)}")
    held = ", ".join(map(topic_in_words, topics)) or "nothing"
    raise InputError(
        f"{path}: no topic holds ticks (JointState, Int64MultiArray, or Int32 or Int64 twice; "
        f"--ticks-topic LEFT,RIGHT where their names do not say so); it has {held}"
    )


def _candidates(topics: Sequence[Topic]) -> list[TicksSource]:
    single = [TicksSource((each.name,), each.kind) for each in topics]
    found = [each for each in single if each.kind in (JOINT_STATE, MULTI_ARRAY)]
    for topic in topics:
        mirrored = topic.name.replace("left", "right")
        if topic.kind in (INT32, INT64) and mirrored != topic.name:
            partners = [each for each in topics if each[:2] == (mirrored, topic.kind)]
            found += [TicksSource((topic.name, each.name), each.kind) for each in partners]
    return found


def _listed(sources: Sequence[TicksSource]) -> str:
    listed = "; ".join(f"{','.join(each.topics)} ({each.kind})" for each in sources)
    return f"candidates are {listed}" if sources else "nor anywhere else in the bag"


class TicksCollector(Protocol):
    """Takes messages, one at a time, and gives the ticks at the end."""

    def take(self, message: Message) -> None:
        """Take a message of one of the source's topics."""

    def ticks(self) -> tuple[Ticks, list[str]]:
        """All ticks, and in words what was left out.

        Raises
        ------
        InputError
            When no message could be used.
        """


def ticks_collector(path: Path, source: TicksSource, robot_file: RobotFile) -> TicksCollector:
    """The collector for a kind of source."""
    if source.kind == JOINT_STATE:
        return _JointStates(path, source.topics[0], robot_file)
    if source.kind == MULTI_ARRAY:
        return _MultiArrays(path, source.topics[0])
    return _Pairs(path, source, robot_file)


class _JointStates:
    def __init__(self, path: Path, topic: str, robot_file: RobotFile) -> None:
        self._place = f"{path}: {topic}"
        self._file = robot_file
        self._sides = [_names(robot_file, side) for side in ("left", "right")]
        self._wheels = [name for side in self._sides for name in side]
        self._time = array("d")
        self._positions = array("d")
        self._names: list[str] = []
        self._places: list[int] = []
        self._left_out: Counter[str] = Counter()

    def take(self, message: Message) -> None:
        content = message.content
        if content.name != self._names or not self._places:
            self._names = list(content.name)
            known = all(name in self._names for name in self._wheels)
            self._places = [self._names.index(name) for name in self._wheels] if known else []
        if not self._places:
            self._left_out["without our joints"] += 1
        elif len(content.position) != len(self._names):
            self._left_out["without a position for each joint"] += 1
        else:
            self._time.append(stamp_of(message))
            self._positions.extend(float(content.position[place]) for place in self._places)

    def ticks(self) -> tuple[Ticks, list[str]]:
        if not self._time:
            raise InputError(f"{self._place}: {self._why_none()}")
        positions = np.array(self._positions).reshape(-1, len(self._wheels))
        left = self._side(positions[:, : len(self._sides[0])], "left")
        right = self._side(positions[:, len(self._sides[0]) :], "right")
        return Ticks(np.array(self._time), left, right), _told(self._left_out)

    def _side(self, positions: NDArray[np.float64], side: str) -> Counts:
        values = self._file.values
        per_turn = float(values[f"{side}_ticks_per_revolution"])  # type: ignore[arg-type]
        in_radians = values["position_unit"] == "radians"
        counts = positions * (per_turn / (2.0 * math.pi)) if in_radians else positions
        return counts_of(side_counts(counts, per_turn, int(values["encoder_bits"])))  # type: ignore[arg-type]

    def _why_none(self) -> str:
        absent = [name for name in self._wheels if name not in self._names]
        if not absent:
            return "no message gives a position for each joint"
        near = difflib.get_close_matches(absent[0], self._names, n=1, cutoff=0.0)
        nearest = f", the nearest is {near[0]}" if near else ""
        return (
            f"no joint {absent[0]}{nearest}; it has {', '.join(self._names) or 'none'}; "
            "set left_wheel_names and right_wheel_names in the robot file"
        )


class _MultiArrays:
    def __init__(self, path: Path, topic: str) -> None:
        self._place = f"{path}: {topic}"
        self._time = array("d")
        self._counts = array("q")
        self._left_out: Counter[str] = Counter()

    def take(self, message: Message) -> None:
        if len(message.content.data) != 2:
            self._left_out["not of two values, left and right"] += 1
            return
        self._time.append(message.received / 1e9)
        self._counts.extend(int(count) for count in message.content.data)

    def ticks(self) -> tuple[Ticks, list[str]]:
        if not self._time:
            raise InputError(f"{self._place}: no message has two values, left and right")
        left, right = np.array(self._counts, dtype=np.int64).reshape(-1, 2).T.copy()
        return Ticks(np.array(self._time), left, right), _told(self._left_out)


class _Pairs:
    """A topic for each wheel, paired as the node does it; see `Pairing`."""

    def __init__(self, path: Path, source: TicksSource, robot_file: RobotFile) -> None:
        self._place = f"{path}: {','.join(source.topics)}"
        self._left = source.topics[0]
        window = float(robot_file.values["pairing_window"])  # type: ignore[arg-type]
        self._pairing = Pairing(int(1e9 * window))
        wraps_unsaid = source.kind == INT32 and not robot_file.values["encoder_bits"]
        self._bits = 32 if wraps_unsaid else 0  # an Int32 cannot but wrap there
        self._time = array("d")
        self._counts = array("q")

    def take(self, message: Message) -> None:
        side, count = int(message.topic != self._left), int(message.content.data)
        pair = self._pairing.take(side, count, message.received)
        if pair is not None:
            self._time.append(message.received / 1e9)
            self._counts.extend(pair)

    def ticks(self) -> tuple[Ticks, list[str]]:
        if not self._time:
            raise InputError(
                f"{self._place}: no two counts within the pairing_window of the robot file"
            )
        left, right = np.array(self._counts, dtype=np.int64).reshape(-1, 2).T.copy()
        sides = (_unwrapped(left, self._bits), _unwrapped(right, self._bits))
        left_out = Counter({"without a partner in time": self._pairing.unpaired})
        return Ticks(np.array(self._time), *sides), _told(left_out)


def stamp_of(message: Message, header: Any = None) -> float:
    """Stamp of the header [s]; where that is zero, when the message was received."""
    stamp = (message.content if header is None else header).header.stamp
    nanoseconds = stamp.sec * 10**9 + stamp.nanosec
    return float((nanoseconds or message.received) / 1e9)


def _unwrapped(counts: NDArray[np.int64], bits: int) -> NDArray[np.int64]:
    if not bits:
        return counts
    half = 1 << (bits - 1)
    steps = (np.diff(counts) + half) % (2 * half) - half
    return np.concatenate([counts[:1], counts[0] + np.cumsum(steps)])


def _names(robot_file: RobotFile, side: str) -> tuple[str, ...]:
    return tuple(robot_file.values[f"{side}_wheel_names"])  # type: ignore[arg-type]


def _told(left_out: Counter[str]) -> list[str]:
    return [f"left out: {count} messages {why}" for why, count in left_out.items() if count]
