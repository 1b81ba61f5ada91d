# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Drivers that publish both wheels' counters in a message of their own, and message types.

A line for each driver is all: a bag is read by it, `info` writes a first robot file by it. Older
bags do not describe their messages, so that theirs are described here.
"""

from __future__ import annotations

from contextlib import suppress
from typing import Any, NamedTuple


class CounterMessage(NamedTuple):
    """What a message of a driver holds, of every robot that sends it."""

    left: str
    """Field with the left counter."""
    right: str
    bits: int
    """Width at which the counters wrap."""
    ticks: float
    """Counts in a turn of a wheel."""
    definition: str
    """Of the message, as its package has it."""

    @property
    def narrow(self) -> int:
        """Width that a robot file must say, of counters that wrap as a robot drives; else 0."""
        return self.bits if self.bits < 32 else 0


_TURTLEBOT3 = CounterMessage(
    "left_encoder",
    "right_encoder",
    32,
    4096.0,
    """\
std_msgs/Header header
uint8 bumper
float32 cliff
float32 sonar
float32 illumination
uint8 led
uint8 button
bool torque
int32 left_encoder
int32 right_encoder
float32 battery
""",
)
_KOBUKI = CounterMessage(
    "left_encoder",
    "right_encoder",
    16,
    2578.33,
    """\
std_msgs/Header header
uint16 time_stamp
uint8 bumper
uint8 wheel_drop
uint8 cliff
uint16 left_encoder
uint16 right_encoder
int8 left_pwm
int8 right_pwm
uint8 buttons
uint8 charger
uint8 battery
uint16[] bottom
uint8[] current
uint8 over_current
uint16 digital_input
uint16[] analog_input
""",
)
_CREATE = CounterMessage(
    "ticks_left",
    "ticks_right",
    32,
    508.8,
    "std_msgs/Header header\nint32 ticks_left\nint32 ticks_right\n",
)

DUCKIETOWN = "std_msgs/Header header\nint32 data\nuint16 resolution\nuint8 type\n"
"""Definition of its WheelEncoderStamped, one for each wheel; `resolution` is counts a turn."""

DRIVERS = {
    "turtlebot3_msgs/msg/SensorState": _TURTLEBOT3,
    "kobuki_msgs/msg/SensorState": _KOBUKI,
    "kobuki_ros_interfaces/msg/SensorState": _KOBUKI,
    "irobot_create_msgs/msg/WheelTicks": _CREATE,
}
"""By message type."""


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
