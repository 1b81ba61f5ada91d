# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Recording of the drives of drive_node, and the messages about it."""

from __future__ import annotations

import itertools
import math
import shlex
import time
from collections.abc import Mapping, Sequence
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Any

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

from werrimbi_odom.files.bags.bag_writing import BagWriter, known_types
from werrimbi_odom.files.robot_files.node_parameter import Value
from werrimbi_odom.ros.topics import full_topic


class Bagging:
    """A bag being recorded from topics, by their full names.

    Those whose type is unknown, or not installed here, are skipped. InputError if rosbags is not
    installed, or the folder cannot be written; it must not exist.
    """

    def __init__(self, node: Node, folder: Path, topics: Sequence[str]) -> None:
        self.folder = folder
        self.topics: list[str] = []
        self._node = node
        self._writer = BagWriter(folder)
        kinds = dict(node.get_topic_names_and_types())
        self._subscriptions = []
        for topic in topics:
            named = kinds.get(topic, [])
            kind = _class_of(named[0]) if len(named) == 1 else None
            connection = None if kind is None else self._writer.topic(topic, named[0])
            if connection is None:
                continue
            self.topics.append(topic)
            latched = any(
                info.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL
                for info in node.get_publishers_info_by_topic(topic)
            )
            self._subscriptions.append(
                node.create_subscription(
                    kind,
                    topic,
                    partial(self._keep, connection),
                    _qos(latched),
                    raw=True,
                )
            )

    def _keep(self, connection: Any, message: bytes) -> None:
        self._writer.write(connection, time.time_ns(), message)

    def close(self) -> None:
        """Write pending messages and unsubscribe."""
        for subscription in self._subscriptions:
            self._node.destroy_subscription(subscription)
        self._subscriptions = []
        self._writer.close()


def _class_of(kind: str) -> Any:
    """Class of a message type; None if its package is not installed here."""
    package, _, name = kind.partition("/msg/")
    try:
        return getattr(import_module(f"{package}.msg"), name, None)
    except ModuleNotFoundError:
        return None


def _qos(latched: bool) -> QoSProfile:
    """Best effort matches every publisher; transient local also delivers latched messages."""
    if latched:
        return QoSProfile(
            depth=100,
            reliability=ReliabilityPolicy.RELIABLE,
            durability=DurabilityPolicy.TRANSIENT_LOCAL,
        )
    return QoSProfile(depth=1000, reliability=ReliabilityPolicy.BEST_EFFORT)


LINGER = 0.5
"""Time for which recording continues after a drive [s]."""


class Records:
    """Records a bag for each drive, if requested.

    InputError if a topic's name is none, or rosbags is needed and not installed.
    """

    def __init__(self, node: Node, values: Mapping[str, Value]) -> None:
        self._node = node
        self._folder = str(values["record"])
        self._robot = str(values["robot_file"]) or "ROBOT.yaml"
        names = values["record_topics"]
        assert isinstance(names, tuple)
        self._topics = [full_topic(node, name) for name in names]
        self._bag: Bagging | None = None
        self._ends = math.inf
        if self._folder:
            known_types()  # load it now, so that no start has to wait for it

    def begin(self, name: str) -> None:
        """Start recording a drive, if requested; InputError if the bag cannot be written."""
        self.close()
        if self._folder:
            first = Path(self._folder) / f"{name}_{time.strftime('%Y%m%d_%H%M%S')}"
            bags = (first.with_name(f"{first.name}_{number}") for number in itertools.count(2))
            bag = next(bag for bag in itertools.chain([first], bags) if not bag.exists())
            self._bag = Bagging(self._node, bag, self._topics)

    def ending(self) -> None:
        """Continue recording for `LINGER`."""
        self._ends = time.monotonic() + LINGER

    def look(self) -> None:
        """Close the bag once that time is over."""
        if time.monotonic() > self._ends:
            self.close()

    def close(self) -> None:
        """Stop recording now."""
        if self._bag is not None:
            self._bag.close()
        self._bag, self._ends = None, math.inf

    def words(self) -> str:
        """Where the drive is recorded, or how to record it."""
        if self._bag is not None:
            return f"recorded in {self._bag.folder}: {' '.join(self._bag.topics)}"
        if self._folder:
            return f"it will be recorded in {self._folder}"
        there = {name for name, _ in self._node.get_topic_names_and_types()}
        topics = " ".join(each for each in self._topics if each in there)
        return f"to record it: ros2 bag record -s mcap -o BAG {topics}"

    def next_command(self) -> str:
        """The command that diagnoses the recording."""
        bag, topics = "BAG", self._topics
        if self._bag is not None:
            bag, topics = str(self._bag.folder), self._bag.topics
        words = ["werrimbi", "diagnose", "--robot", self._robot]
        for option, name in (("ticks", "/joint_states"), ("reference", "/reference")):
            there = [each for each in topics if each.endswith(name)]
            words += [f"--{option}-topic", there[0]] if there else []
        return shlex.join([*words, bag])
