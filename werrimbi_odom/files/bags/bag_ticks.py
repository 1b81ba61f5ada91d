# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Ticks from the messages of a bag, read as the node reads them live; counters among them."""

from __future__ import annotations

from array import array
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.bags.bag import BagMessage, left_out_words, stamp_of, topic_in_words
from werrimbi_odom.files.bags.bag_contents import Contents
from werrimbi_odom.files.bags.bag_joints import JointsCollector, wheel_names
from werrimbi_odom.files.bags.bag_odometry import OdometryTurnedBack
from werrimbi_odom.files.bags.bag_wheels import (
    ARRAYS,
    FLOATS,
    INT32,
    INT64,
    JOINT_STATE,
    MULTI_ARRAY,
    PAIRS,
    Wheels,
)
from werrimbi_odom.files.bags.counter_pairs import Pairing, apart_words, at_the_same_instants
from werrimbi_odom.files.bags.driver_messages import DRIVERS
from werrimbi_odom.files.bags.own_odometry import ODOMETRY
from werrimbi_odom.files.robot_files.robot_file import RobotFile
from werrimbi_odom.files.run import Ticks
from werrimbi_odom.model.counter_wraps import running_on

KINDS = {
    "joint_state": JOINT_STATE,
    "int32_pair": INT32,
    "int64_pair": INT64,
    "int64_multi_array": MULTI_ARRAY,
}
"""Message type of each `input_type`."""


def choose_ticks(held: Contents, wish: str | None, robot_file: RobotFile) -> Wheels:
    """Choose the requested source, or the only one; the firmware's odometry as a last resort.

    `wish`: a topic, or LEFT,RIGHT for two. InputError if there is none, or several; the message
    lists them.
    """
    if wish is not None:
        return wished_ticks(held, wish)
    counted = [each for each in held.wheels if each.gives != "odometry"]
    counted = [each for each in counted if not each.places] or counted
    kind = KINDS[str(robot_file.values["input_type"])]
    chosen = [each for each in counted if each.kind == kind] or counted
    joints = {name for side in ("left", "right") for name in wheel_names(robot_file, side)}
    ours = [each for each in chosen if joints <= set(each.joints)]
    if len(ours) == 1 and all(each.kind == JOINT_STATE for each in chosen):
        chosen = ours
    chosen = chosen or list(held.wheels)
    if len(chosen) == 1:
        return chosen[0]
    if chosen:
        raise InputError(f"{held.path}: choose with --ticks-topic; {_listed(chosen)}")
    told = ", ".join(map(topic_in_words, held.topics)) or "nothing"
    raise InputError(
        f"{held.path}: no topic holds ticks (JointState, SensorState, WheelTicks, "
        "Int64MultiArray, or Int32 or Int64 twice; --ticks-topic LEFT,RIGHT where their names do "
        f"not say so; the firmware's /odom where it has nothing else); it has {told}"
    )


def wished_ticks(held: Contents, wish: str) -> Wheels:
    """Find the requested source: a topic, LEFT,RIGHT for two, or TOPIC:LEFT:RIGHT within an array.

    InputError if it contains no ticks; the message lists the sources.
    """
    wished = tuple("/" + name.strip().strip("/") for name in wish.split(","))
    found = [topic for name in wished for topic in held.topics if topic.name == name]
    single = len(wished) == len(found) == 1
    for each in held.wheels:
        if each.name == ",".join(wished):
            return each
    if len(found) == len(wished) == 2 and found[0].kind == found[1].kind in PAIRS:
        messages = min(topic.messages for topic in found)
        return Wheels(",".join(wished), found[0].kind, messages, "counts")
    if single and found[0].kind in PAIRS:
        raise InputError(f"{held.path}: {wish} is one wheel; --ticks-topic LEFT,RIGHT names both")
    if single and found[0].kind in (*ARRAYS, *FLOATS):
        return Wheels(wished[0], found[0].kind, found[0].messages, "counts")
    name, *places = wished[0].split(":")
    for topic in held.topics:
        if topic.name == name and topic.kind in (*ARRAYS, *FLOATS) and len(wished) == 1:
            if len(places) == 2 and all(map(str.isdecimal, places)) and places[0] != places[1]:
                return Wheels(wished[0], topic.kind, topic.messages, "counts")
            raise InputError(
                f"{held.path}: --ticks-topic {name}:LEFT:RIGHT takes two places of its values, "
                f"counted from 0, as in {name}:0:1; not {wish}"
            )
    if single and found[0].kind == ODOMETRY:
        return Wheels(wished[0], ODOMETRY, found[0].messages, "odometry")
    raise InputError(f"{held.path}: there are no ticks in {wish}; {_listed(held.wheels)}")


def _listed(sources: Sequence[Wheels]) -> str:
    listed = "; ".join(f"{each.name} ({each.kind})" for each in sources)
    return f"candidates are {listed}" if sources else "nor anywhere else in the bag"


class TicksCollector(Protocol):
    """Collects messages, and computes the ticks at the end."""

    def take(self, message: BagMessage) -> None:
        """Add a message of one of the source's topics."""

    def ticks(self) -> tuple[Ticks, list[str]]:
        """All ticks, and the skipped messages in words; InputError if no message was usable."""


def ticks_collector(path: Path, source: Wheels, robot_file: RobotFile) -> TicksCollector:
    """Create the collector for a kind of source."""
    if source.kind == JOINT_STATE:
        return JointsCollector(path, source.name, robot_file)
    if source.gives == "odometry":
        return OdometryTurnedBack(path, source, robot_file)
    robot_file.refuse_counts(f"{path}, {source.name}")
    if source.kind in (*ARRAYS, *FLOATS):
        return MultiArrays(path, source, robot_file)
    if source.kind in DRIVERS:
        return CountersCollector(path, source, robot_file)
    return Pairs(path, source, robot_file)


class _TwoCounts:
    """Stamps, and the readings of both counters."""

    def __init__(self, place: str, bits: int = 0) -> None:
        self._place, self._bits = place, bits
        self._time = array("d")
        self._counts = array("q")

    def _add(self, time: float, left: int, right: int) -> None:
        self._time.append(time)
        self._counts.extend((left, right))

    def _ticks(self, why_none: str) -> Ticks:
        if not self._time:
            raise InputError(f"{self._place}: {why_none}")
        left, right = np.array(self._counts, dtype=np.int64).reshape(-1, 2).T.copy()
        sides = (_unwrapped(left, self._bits), _unwrapped(right, self._bits))
        return Ticks(np.array(self._time), *sides)


class CountersCollector(_TwoCounts):
    """Both counters of a driver, in one stamped message."""

    def __init__(self, path: Path, source: Wheels, robot_file: RobotFile) -> None:
        self._driver = DRIVERS[source.kind]
        super().__init__(f"{path}: {source.name}", _width(robot_file, self._driver.bits))

    def take(self, message: BagMessage) -> None:
        """Add a message."""
        sides = (self._driver.left, self._driver.right)
        self._add(stamp_of(message), *(int(getattr(message.content, name)) for name in sides))

    def ticks(self) -> tuple[Ticks, list[str]]:
        """All ticks, and a remark on their scale."""
        told = "counts as the driver gives them: so many a turn as the robot file says"
        return self._ticks("it has no messages"), [told]


class MultiArrays(_TwoCounts):
    """Two counters in one message without a stamp: its two values, or two places of more."""

    def __init__(self, path: Path, source: Wheels, robot_file: RobotFile) -> None:
        bits = _width(robot_file, ARRAYS.get(source.kind, 0))
        super().__init__(f"{path}: {source.name}", bits)
        self._places = source.places
        self._left_out: Counter[str] = Counter()

    def take(self, message: BagMessage) -> None:
        """Add a message."""
        data = message.content.data
        if len(data) <= max(self._places, default=1) or not (self._places or len(data) == 2):
            self._left_out[f"not of {self._wanted}"] += 1
            return
        both = [data[place] for place in self._places or (0, 1)]
        if not _whole(self._place, both):
            self._left_out[_NO_NUMBER] += 1
            return
        self._add(message.received / 1e9, *map(int, both))

    @property
    def _wanted(self) -> str:
        if not self._places:
            return "two values, left and right"
        return f"values {self._places[0]} and {self._places[1]}, counted from 0"

    def ticks(self) -> tuple[Ticks, list[str]]:
        """All ticks, and the skipped messages in words."""
        ticks = self._ticks(
            f"no message has {self._wanted}"
            + ("" if self._places else "; --ticks-topic TOPIC:LEFT:RIGHT says which two of more")
        )
        return ticks, left_out_words(self._left_out)


class Pairs(_TwoCounts):
    """One topic per wheel, paired as in the node; see `Pairing`.

    Stamped messages are paired by stamp, since one topic may be delivered long after the other.
    """

    def __init__(self, path: Path, source: Wheels, robot_file: RobotFile) -> None:
        bits = _width(robot_file, PAIRS[source.kind])
        super().__init__(f"{path}: {source.name}", bits)
        self._left = source.name.split(",")[0]
        self._wraps = int(robot_file.values["encoder_bits"]) or bits  # type: ignore[arg-type]
        self._window = float(robot_file.values["pairing_window"])  # type: ignore[arg-type]
        self._read_at, self._side, self._count = array("d"), array("b"), array("q")
        self._no_numbers = 0

    def take(self, message: BagMessage) -> None:
        """Add a message."""
        if not _whole(self._place, [message.content.data]):
            self._no_numbers += 1
            return
        stamped = hasattr(message.content, "header")
        self._read_at.append(stamp_of(message) if stamped else message.received / 1e9)
        self._side.append(message.topic != self._left)
        self._count.append(int(message.content.data))

    def ticks(self) -> tuple[Ticks, list[str]]:
        """All ticks, and the skipped messages in words."""
        if (found := self._of_two_rates()) is not None:
            return found
        pairing = Pairing(int(1e9 * self._window))
        for row in np.argsort(self._read_at, kind="stable").tolist():
            read_at, side = self._read_at[row], self._side[row]
            pair = pairing.take(side, self._count[row], round(1e9 * read_at))
            if pair is not None:
                self._add(read_at, *pair)
        apart = apart_words(np.array(self._read_at), np.array(self._side, dtype=bool), self._window)
        ticks = self._ticks(f"no two counts within the pairing_window of the robot file{apart}")
        left_out = Counter(
            {"without a partner in time": pairing.unpaired, _NO_NUMBER: self._no_numbers}
        )
        return ticks, left_out_words(left_out)

    def _of_two_rates(self) -> tuple[Ticks, list[str]] | None:
        """Ticks of topics of different rates, which the node pairs but roughly; else None."""
        order = np.argsort(self._read_at, kind="stable")
        time, count = np.array(self._read_at)[order], np.array(self._count, dtype=np.int64)[order]
        right = np.array(self._side, dtype=bool)[order]
        left, other = (_unwrapped(count[side], self._wraps) for side in (~right, right))
        found = at_the_same_instants((time[~right], time[right]), (left, other))
        if found is None:
            return None
        told = (
            "the wheels' topics are of different rates: those of the faster one are taken when "
            "those of the slower were read, on the line between its own. The node pairs the nearest"
        )
        return Ticks(*found), [told, *left_out_words(Counter({_NO_NUMBER: self._no_numbers}))]


_NO_NUMBER = "with a value that is no number"


def _whole(place: str, values: Sequence[float]) -> bool:
    """Whether values are within 64 bits; InputError if one is no whole number, so no counter."""
    if not all(-(2.0**63) <= value < 2.0**63 for value in values):  # nor NaN
        return False
    if not all(float(value).is_integer() for value in values):
        verb = (
            "is no whole number, and so no counter"
            if len(values) == 1
            else ("are no whole numbers, and so no counters")
        )
        raise InputError(
            f"{place}: {' and '.join(f'{value:.6g}' for value in values)} {verb}; angles and "
            "speeds of wheels are read from a JointState"
        )
    return True


def _width(robot_file: RobotFile, bits: int) -> int:
    """Wrap width to unwrap here; 0 if the robot file states one."""
    return 0 if robot_file.values["encoder_bits"] else bits


def _unwrapped(counts: NDArray[np.int64], bits: int) -> NDArray[np.int64]:
    if not bits:
        return counts
    return running_on(counts, bits).astype(np.int64)
