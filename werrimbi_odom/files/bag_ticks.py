# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Ticks from the messages of a bag, read as the node reads them live."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Protocol

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.bag import Message, topic_in_words
from werrimbi_odom.files.bag_contents import (
    ARRAYS,
    FLOATS,
    INT32,
    INT64,
    JOINT_STATE,
    MULTI_ARRAY,
    PAIRS,
    Contents,
    Wheels,
)
from werrimbi_odom.files.bag_counters import CountersCollector, MultiArrays, Pairs
from werrimbi_odom.files.bag_joints import JointsCollector, wheel_names
from werrimbi_odom.files.bag_odometry import OdometryTurnedBack
from werrimbi_odom.files.drivers import DRIVERS
from werrimbi_odom.files.made_from_wheels import ODOMETRY
from werrimbi_odom.files.robot_file import RobotFile
from werrimbi_odom.files.run import Ticks

KINDS = {
    "joint_state": JOINT_STATE,
    "int32_pair": INT32,
    "int64_pair": INT64,
    "int64_multi_array": MULTI_ARRAY,
}
"""Message type of each `input_type`."""


def choose_ticks(held: Contents, wish: str | None, robot_file: RobotFile) -> Wheels:
    """What is wished for, or the only one there is; the firmware's odometry where nothing else is.

    Parameters
    ----------
    wish : str, optional
        A topic, or LEFT,RIGHT for two.

    Raises
    ------
    InputError
        When there is none, or several; the message lists them.
    """
    if wish is not None:
        return wished_ticks(held, wish)
    counted = [each for each in held.wheels if each.gives != "odometry"]
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
    """What is wished for: a topic, or LEFT,RIGHT for two.

    Raises
    ------
    InputError
        When it holds no ticks; the message lists what does.
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
    if single and found[0].kind in FLOATS:
        return Wheels(wished[0], found[0].kind, found[0].messages, "counts")
    if single and found[0].kind == ODOMETRY:
        return Wheels(wished[0], ODOMETRY, found[0].messages, "odometry")
    raise InputError(f"{held.path}: there are no ticks in {wish}; {_listed(held.wheels)}")


def _listed(sources: Sequence[Wheels]) -> str:
    listed = "; ".join(f"{each.name} ({each.kind})" for each in sources)
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


def ticks_collector(path: Path, source: Wheels, robot_file: RobotFile) -> TicksCollector:
    """The collector for a kind of source."""
    if source.kind == JOINT_STATE:
        return JointsCollector(path, source.name, robot_file)
    if source.kind == ODOMETRY:
        return OdometryTurnedBack(path, source.name, robot_file)
    robot_file.refuse_counts(f"{path}, {source.name}")
    if source.kind in (*ARRAYS, *FLOATS):
        return MultiArrays(path, source, robot_file)
    if source.kind in DRIVERS:
        return CountersCollector(path, source, robot_file)
    return Pairs(path, source, robot_file)
