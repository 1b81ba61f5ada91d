# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Drivers that publish both wheels' counters in a message of their own: a line for each is all.

A bag is read by it, `info` writes a first robot file by it.
"""

from __future__ import annotations

from typing import NamedTuple


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
