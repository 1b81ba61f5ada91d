# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Records topics as a rosbag2 (MCAP) as messages arrive, without `ros2 bag`."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

from werrimbi_odom.files.bag_writing import BagWriter


class Bagging:
    """A bag being recorded.

    Parameters
    ----------
    node : Node
        Node that subscribes.
    folder : Path
        Folder of the bag; must not exist.
    topics : sequence of str
        Full topic names; topics of unknown type are skipped.

    Raises
    ------
    InputError
        If rosbags is not installed, or the folder cannot be written.
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
            connection = self._writer.topic(topic, named[0]) if len(named) == 1 else None
            if connection is None:
                continue
            self.topics.append(topic)
            latched = any(
                info.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL
                for info in node.get_publishers_info_by_topic(topic)
            )
            self._subscriptions.append(
                node.create_subscription(
                    _class_of(named[0]), topic, self._keeper(connection), _qos(latched), raw=True
                )
            )

    def _keeper(self, connection: Any) -> Callable[[bytes], None]:
        def keep(message: bytes) -> None:
            self._writer.write(connection, time.time_ns(), message)

        return keep

    def close(self) -> None:
        """Write pending messages and unsubscribe."""
        for subscription in self._subscriptions:
            self._node.destroy_subscription(subscription)
        self._subscriptions = []
        self._writer.close()


def _class_of(kind: str) -> Any:
    package, _, name = kind.partition("/msg/")
    return getattr(import_module(f"{package}.msg"), name)


def _qos(latched: bool) -> QoSProfile:
    """Best effort matches every publisher; transient local also delivers latched messages."""
    if latched:
        return QoSProfile(
            depth=100,
            reliability=ReliabilityPolicy.RELIABLE,
            durability=DurabilityPolicy.TRANSIENT_LOCAL,
        )
    return QoSProfile(depth=1000, reliability=ReliabilityPolicy.BEST_EFFORT)
