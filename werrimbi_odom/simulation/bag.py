# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Write a recording as a ROS 2 bag (rosbag2 with MCAP), as `ros2 bag record` would."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

from .recording import Recording
from .robot import TrueRobot

EPOCH = 1_767_225_600
"""Unix time of the start of the simulation's clock: 2026-01-01 00:00 UTC [s]."""


def write_bag(recording: Recording, robot: TrueRobot, folder: str | Path) -> Path:
    """Write /joint_states (wheel angles from the counters) and /reference (measured poses).

    Parameters
    ----------
    recording : Recording
    robot : TrueRobot
        Gives the counts per revolution.
    folder : path
        Folder of the bag; must not exist.

    Returns
    -------
    Path
        The folder.
    """
    folder = Path(folder)
    store = get_typestore(Stores.ROS2_JAZZY)
    types = store.types
    joint_state = types["sensor_msgs/msg/JointState"]
    pose_stamped = types["geometry_msgs/msg/PoseStamped"]
    nothing = np.zeros(0)

    def header(t: float, frame: str) -> object:
        nanoseconds = EPOCH * 10**9 + round(t * 1e9)
        stamp = types["builtin_interfaces/msg/Time"](*divmod(nanoseconds, 10**9))
        return types["std_msgs/msg/Header"](stamp, frame)

    def wheels(t: float, angles: tuple[float, float]) -> object:
        names = ["left_wheel_joint", "right_wheel_joint"]
        return joint_state(header(t, ""), names, np.array(angles), nothing, nothing)

    def pose(t: float, x: float, y: float, yaw: float) -> object:
        point = types["geometry_msgs/msg/Point"](x, y, 0.0)
        turned = types["geometry_msgs/msg/Quaternion"](
            0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2)
        )
        return pose_stamped(
            header(t, "motion_capture"), types["geometry_msgs/msg/Pose"](point, turned)
        )

    left = recording.left_ticks * (2 * math.pi / robot.left_ticks_per_revolution)
    right = recording.right_ticks * (2 * math.pi / robot.right_ticks_per_revolution)
    messages = [
        (float(t), 0, wheels(float(t), (float(a), float(b))))
        for t, a, b in zip(recording.t_s, left, right, strict=True)
    ]
    messages += [(float(t), 1, pose(float(t), *map(float, xyyaw))) for t, *xyyaw in recording.poses]
    messages.sort(key=lambda message: message[0])
    with Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        connections = [
            writer.add_connection(topic, kind, typestore=store)
            for topic, kind in (
                ("/joint_states", "sensor_msgs/msg/JointState"),
                ("/reference", "geometry_msgs/msg/PoseStamped"),
            )
        ]
        for t, which, message in messages:
            connection = connections[which]
            data = store.serialize_cdr(message, connection.msgtype)
            writer.write(connection, EPOCH * 10**9 + round(t * 1e9), data)
    return folder
