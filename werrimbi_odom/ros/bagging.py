# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Records what is on some topics as a rosbag2 (MCAP), as it comes, without `ros2 bag`."""

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
    """A bag that is being written.

    Parameters
    ----------
    node : Node
        That listens.
    folder : Path
        Of the bag; must not exist.
    topics : sequence of str
        Full names; those of which nobody says what they are, are left out.

    Raises
    ------
    InputError
        When rosbags is not installed, or the folder cannot be written.
    """

    def __init__(self, node: Node, folder: Path, topics: Sequence[str]) -> None:
        self.folder = folder
        self.topics: list[str] = []
        self._node = node
        self._writer = BagWriter(folder)
        kinds = dict(node.get_topic_names_and_types())
        self._subscriptions = []
        for topic in topics:
            kind = _only(kinds.get(topic, []))
            connection = None if kind is None else self._writer.topic(topic, kind)
            if kind is None or connection is None:
                continue
            self.topics.append(topic)
            latched = any(
                info.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL
                for info in node.get_publishers_info_by_topic(topic)
            )
            self._subscriptions.append(
                node.create_subscription(
                    _class_of(kind), topic, self._keeper(connection), _qos(latched), raw=True
                )
            )

    def _keeper(self, connection: Any) -> Callable[[bytes], None]:
        def keep(message: bytes) -> None:
            self._writer.write(connection, time.time_ns(), message)

        return keep

    def close(self) -> None:
        """Write what is still to be written, and listen no more."""
        for subscription in self._subscriptions:
            self._node.destroy_subscription(subscription)
        self._subscriptions = []
        self._writer.close()


def _only(kinds: Sequence[str]) -> str | None:
    return kinds[0] if len(kinds) == 1 else None


def _class_of(kind: str) -> Any:
    package, _, name = kind.partition("/msg/")
    return getattr(import_module(f"{package}.msg"), name)


def _qos(latched: bool) -> QoSProfile:
    """Best effort takes from every publisher; what is latched comes also if it was sent before."""
    if latched:
        return QoSProfile(
            depth=100,
            reliability=ReliabilityPolicy.RELIABLE,
            durability=DurabilityPolicy.TRANSIENT_LOCAL,
        )
    return QoSProfile(depth=1000, reliability=ReliabilityPolicy.BEST_EFFORT)
