# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Message types: the standard ones, and those of drivers that older bags do not describe."""

from __future__ import annotations

from contextlib import suppress
from typing import Any

ROS2_DEFINITIONS = {
    "turtlebot3_msgs/msg/SensorState": """\
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
    "kobuki_ros_interfaces/msg/SensorState": """\
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
    "irobot_create_msgs/msg/WheelTicks": """\
std_msgs/Header header
int32 ticks_left
int32 ticks_right
""",
    "tf/msg/tfMessage": "geometry_msgs/TransformStamped[] transforms\n",
}
"""As their packages have them; a sqlite3 bag before ROS 2 Iron holds no definitions."""
ROS2_DEFINITIONS["kobuki_msgs/msg/SensorState"] = ROS2_DEFINITIONS[
    "kobuki_ros_interfaces/msg/SensorState"
]


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

        texts = (self._definitions.get(kind), ROS2_DEFINITIONS.get(kind))
        for text in filter(None, texts):
            with suppress(Exception):  # a definition that is broken raises anything
                parse = get_types_from_idl if "module " in text else get_types_from_msg
                found = parse(text) if parse is get_types_from_idl else parse(text, kind)
                new = {name: each for name, each in found.items() if name not in self._store.types}
                if kind in new:
                    self._store.register(new)
                    return
        raise KeyError(f"the message type {kind} is not known, and the bag does not describe it")
