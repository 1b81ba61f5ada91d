# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Drivers that publish both wheels' counters in a message of their own, and message types.

Each driver is one entry: bags are read by it, and `info` writes a first robot file by it. Older
bags do not contain message definitions, so those are included here.
"""

from __future__ import annotations

from contextlib import suppress
from typing import Any, NamedTuple

from werrimbi_odom.files.bags.standard_forms import FORMS, as_read


class CounterMessage(NamedTuple):
    """Content of a driver's message, equal for all robots that send it."""

    left: str
    """Field with the left counter."""
    right: str
    bits: int
    """Width at which the counters wrap."""
    ticks: float
    """Counts per turn of a wheel."""
    definition: str
    """Message definition, from its package."""

    @property
    def narrow(self) -> int:
        """Wrap width that a robot file must state, if counters wrap during a drive; else 0."""
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
"""Definition of WheelEncoderStamped, one per wheel; `resolution` is counts per turn."""

DRIVERS = {
    "turtlebot3_msgs/msg/SensorState": _TURTLEBOT3,
    "kobuki_msgs/msg/SensorState": _KOBUKI,
    "kobuki_ros_interfaces/msg/SensorState": _KOBUKI,
    "irobot_create_msgs/msg/WheelTicks": _CREATE,
}
"""By message type."""


DEFINITIONS = {
    **{kind: driver.definition for kind, driver in DRIVERS.items()},
    **{kind: form.definition for kind, form in FORMS.items()},
    "duckietown_msgs/msg/WheelEncoderStamped": DUCKIETOWN,
    "tf/msg/tfMessage": "geometry_msgs/TransformStamped[] transforms\n",
}
"""Definitions from the packages; sqlite3 bags before ROS 2 Iron contain none."""


class Types:
    """Deserialises messages of one bag."""

    def __init__(self, ros1: bool, definitions: dict[str, str]) -> None:
        """Use the standard types of ROS 2 Jazzy, or of ROS 1 Noetic.

        The types needed for odometry are the same in every distribution. Definitions in the bag,
        which may be broken, are used only for other types.
        """
        from rosbags.typesys import Stores, get_typestore

        self._store = get_typestore(Stores.ROS1_NOETIC if ros1 else Stores.ROS2_JAZZY)
        self._ros1 = ros1
        self._definitions = definitions

    def read(self, data: Any, kind: str) -> Any:
        """Deserialise a message; raises the exception of rosbags if it is unreadable."""
        if kind not in self._store.types:
            self._register(kind)
        deserialised = self._store.deserialize_ros1 if self._ros1 else self._store.deserialize_cdr
        return as_read(deserialised(data, kind), kind)

    def _register(self, kind: str) -> None:
        from rosbags.typesys import get_types_from_idl, get_types_from_msg

        texts = (self._definitions.get(kind), DEFINITIONS.get(kind))
        for text in filter(None, texts):
            with suppress(Exception):  # a broken definition may raise anything
                parse = get_types_from_idl if "module " in text else get_types_from_msg
                found = parse(text) if parse is get_types_from_idl else parse(text, kind)
                new = {name: each for name, each in found.items() if name not in self._store.types}
                if kind in new:
                    self._store.register(new)
                    return
        raise KeyError(f"the message type {kind} is not known, and the bag does not describe it")
