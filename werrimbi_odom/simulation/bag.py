# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Write a recording as a ROS 2 bag (rosbag2 with MCAP), as `ros2 bag record` would."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

from .recording import Recording
from .robot import TrueRobot

EPOCH = 1_767_225_600
"""Unix time of the start of the simulation's clock: 2026-01-01 00:00 UTC [s]."""

TOPICS = {
    "/joint_states": "sensor_msgs/msg/JointState",
    "/reference": "geometry_msgs/msg/PoseStamped",
}


class Messages:
    """Messages of ROS 2 Jazzy, with times [s] in the simulation's clock."""

    def __init__(self) -> None:
        self._store = get_typestore(Stores.ROS2_JAZZY)

    def made(self, kind: str, *values: object) -> Any:
        """A message of any type."""
        return self._store.types[kind](*values)

    def header(self, time: float, frame: str) -> object:
        """A header."""
        stamp = self.made("builtin_interfaces/msg/Time", *divmod(_nanoseconds(time), 10**9))
        return self.made("std_msgs/msg/Header", stamp, frame)

    def facing(self, yaw: float) -> object:
        """A quaternion."""
        half = 0.5 * yaw
        return self.made("geometry_msgs/msg/Quaternion", 0.0, 0.0, math.sin(half), math.cos(half))

    def pose(self, x: float, y: float, yaw: float) -> object:
        """A pose on the floor."""
        point = self.made("geometry_msgs/msg/Point", x, y, 0.0)
        return self.made("geometry_msgs/msg/Pose", point, self.facing(yaw))

    def joints(self, time: float, names: Sequence[str], angles: Iterable[float]) -> object:
        """Angles of wheels [rad]."""
        nothing, header = np.zeros(0), self.header(time, "")
        return self.made(TOPICS["/joint_states"], header, names, np.array(angles), *[nothing] * 2)

    def write(
        self, folder: Path, topics: Mapping[str, str], messages: list[tuple[float, str, object]]
    ) -> None:
        """Write a bag of topics with their types; messages are (time of receipt, topic, message).

        The folder must not exist.
        """
        messages.sort(key=lambda message: message[0])
        with Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
            connections = {
                topic: writer.add_connection(topic, kind, typestore=self._store)
                for topic, kind in topics.items()
            }
            for received, topic, message in messages:
                data = self._store.serialize_cdr(message, topics[topic])
                writer.write(connections[topic], _nanoseconds(received), data)


def _nanoseconds(time: float) -> int:
    return EPOCH * 10**9 + round(float(time) * 1e9)


def write_bag(recording: Recording, robot: TrueRobot, folder: str | Path) -> Path:
    """Write /joint_states (wheel angles from the counters) and /reference (measured poses).

    The robot gives its wheels and the counts per revolution; returns the folder, which must not
    exist.
    """
    ros, names = Messages(), [name for side in robot.joints for name in side]
    left = recording.left_ticks * (2 * math.pi / robot.left_ticks_per_revolution)
    right = recording.right_ticks * (2 * math.pi / robot.right_ticks_per_revolution)
    messages = [
        (float(t), "/joint_states", ros.joints(t, names, np.repeat([a, b], robot.wheels_a_side)))
        for t, a, b in zip(recording.t_s, left, right, strict=True)
    ]
    for t, *pose in recording.poses:
        placed = ros.pose(*map(float, pose))
        seen = ros.made(TOPICS["/reference"], ros.header(t, "motion_capture"), placed)
        messages.append((float(t), "/reference", seen))
    ros.write(Path(folder), TOPICS, messages)
    return Path(folder)
