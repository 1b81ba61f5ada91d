# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Writes raw messages to a bag: rosbag2, MCAP, without `ros2 bag`."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

from werrimbi_odom.errors import InputError


@cache
def known_types() -> Any:
    """Type store of rosbags; the first call takes a second.

    InputError if rosbags is not installed.
    """
    try:
        from rosbags.typesys import Stores, get_typestore
    except ModuleNotFoundError as missing:
        raise InputError("to record needs rosbags: pip install rosbags") from missing
    return get_typestore(Stores.ROS2_JAZZY)


class BagWriter:
    """A bag being written.

    `folder`: folder of the bag; must not exist. InputError if rosbags is not installed, or the
    folder cannot be written.
    """

    def __init__(self, folder: Path) -> None:
        self._store = known_types()
        from rosbags.rosbag2 import StoragePlugin, Writer, WriterError

        try:
            folder.parent.mkdir(parents=True, exist_ok=True)
            self._writer = Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP)
            self._writer.open()
        except (OSError, WriterError) as error:
            raise InputError(f"record: {folder} cannot be written: {error}") from error

    def topic(self, name: str, kind: str) -> Any:
        """Handle of a topic for `write`; None if its message type is unknown."""
        if kind not in self._store.types:
            return None
        return self._writer.add_connection(name, kind, typestore=self._store)

    def write(self, topic: Any, received: int, message: bytes) -> None:
        """Add a serialised message and its time of reception [ns]."""
        self._writer.write(topic, received, message)

    def close(self) -> None:
        """Write pending messages."""
        self._writer.close()
