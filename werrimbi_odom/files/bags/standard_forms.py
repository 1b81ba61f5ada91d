# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Drivers' messages that say what a standard one says: they are read as that one.

Each is one entry of `FORMS`. Where a bag holds the standard message too, a node made it of the
driver's, and the driver's is left alone: it says nothing more.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np

LEO_WHEELS = ("wheel_FL_joint", "wheel_RL_joint", "wheel_FR_joint", "wheel_RR_joint")
"""Joints of the Leo Rover's URDF, in the order in which its firmware sends the wheels."""


class StandardForm(NamedTuple):
    """How a driver's message is read."""

    kind: str
    """The standard message type."""
    definition: str
    """Message definition, from its package."""
    read: Callable[[Any], Any]
    """The fields of the standard message that are read here, of the driver's message."""


def as_read(content: Any, kind: str) -> Any:
    """Content of a message in its standard form, or as it is."""
    form = FORMS.get(kind)
    return content if form is None else form.read(content)


def kinds_as_read(kinds: Sequence[str]) -> dict[str, str]:
    """The types by which the topics of a bag are known; `kinds`: of all its topics."""
    forms = {kind: FORMS[kind].kind for kind in kinds if kind in FORMS}
    return {kind: form for kind, form in forms.items() if form not in kinds}


def _of_interfaces(content: Any) -> Any:
    """Joints of ros2_control; NaN where a joint has no such interface."""
    found = [
        dict(zip(each.interface_names, each.values, strict=False))
        for each in content.interface_values
    ]
    position, velocity = (
        np.array([each.get(name, np.nan) for each in found]) for name in ("position", "velocity")
    )
    return SimpleNamespace(
        header=content.header, name=content.joint_names, position=position, velocity=velocity
    )


def _of_leo_wheels(content: Any) -> Any:
    return SimpleNamespace(
        header=SimpleNamespace(stamp=content.stamp, frame_id=""),
        name=list(LEO_WHEELS),
        position=content.position,
        velocity=content.velocity,
    )


def _of_leo_imu(content: Any) -> Any:
    """Covariances of zero: unknown."""

    def vector(name: str) -> Any:
        return SimpleNamespace(**{axis: getattr(content, f"{name}_{axis}") for axis in "xyz"})

    return SimpleNamespace(
        header=SimpleNamespace(stamp=content.stamp, frame_id="imu_frame"),
        angular_velocity=vector("gyro"),
        angular_velocity_covariance=(0.0,),
        linear_acceleration=vector("accel"),
        linear_acceleration_covariance=(0.0,),
    )


FORMS = {
    "control_msgs/msg/DynamicJointState": StandardForm(
        "sensor_msgs/msg/JointState",
        """\
std_msgs/Header header
string[] joint_names
control_msgs/InterfaceValue[] interface_values
================================================================================
MSG: control_msgs/InterfaceValue
string[] interface_names
float64[] values
""",
        _of_interfaces,
    ),
    "leo_msgs/msg/WheelStates": StandardForm(
        "sensor_msgs/msg/JointState",
        """\
builtin_interfaces/Time stamp
float32[4] position
float32[4] velocity
float32[4] torque
float32[4] pwm_duty_cycle
""",
        _of_leo_wheels,
    ),
    "leo_msgs/msg/Imu": StandardForm(
        "sensor_msgs/msg/Imu",
        """\
builtin_interfaces/Time stamp
float32 temperature
float32 gyro_x
float32 gyro_y
float32 gyro_z
float32 accel_x
float32 accel_y
float32 accel_z
""",
        _of_leo_imu,
    ),
}
"""By message type."""
