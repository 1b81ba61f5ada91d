# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Message types: the standard ones, and those of drivers that older bags do not describe."""

from __future__ import annotations

from contextlib import suppress
from typing import Any

from werrimbi_odom.files.drivers import DRIVERS, DUCKIETOWN

DEFINITIONS = {
    **{kind: driver.definition for kind, driver in DRIVERS.items()},
    "duckietown_msgs/msg/WheelEncoderStamped": DUCKIETOWN,
    "tf/msg/tfMessage": "geometry_msgs/TransformStamped[] transforms\n",
}
"""As their packages have them; a sqlite3 bag before ROS 2 Iron holds no definitions."""


class Types:
    """Reads messages of one bag."""

    def __init__(self, ros1: bool, definitions: dict[str, str]) -> None:
        """Standard types are those of ROS 2 Jazzy, or of ROS 1 Noetic.

        Those that odometry needs have been the same in every distribution, so definitions in the
        bag, which may be broken, are looked at for no others.
        """
        from rosbags.typesys import Stores, get_typestore

        self._store = get_typestore(Stores.ROS1_NOETIC if ros1 else Stores.ROS2_JAZZY)
        self._ros1 = ros1
        self._definitions = definitions

    def read(self, data: Any, kind: str) -> Any:
        """A message; raises what rosbags raises where it cannot be read."""
        if kind not in self._store.types:
            self._register(kind)
        if self._ros1:
            return self._store.deserialize_ros1(data, kind)
        return self._store.deserialize_cdr(data, kind)

    def _register(self, kind: str) -> None:
        from rosbags.typesys import get_types_from_idl, get_types_from_msg

        texts = (self._definitions.get(kind), DEFINITIONS.get(kind))
        for text in filter(None, texts):
            with suppress(Exception):  # a definition that is broken raises anything
                parse = get_types_from_idl if "module " in text else get_types_from_msg
                found = parse(text) if parse is get_types_from_idl else parse(text, kind)
                new = {name: each for name, each in found.items() if name not in self._store.types}
                if kind in new:
                    self._store.register(new)
                    return
        raise KeyError(f"the message type {kind} is not known, and the bag does not describe it")
