# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Bags and robot files made on the spot."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from werrimbi_odom.files.robot_files.robot_file import RobotFile, read_robot_file

BARE = """\
odom_node:
  ros__parameters:
    wheel_separation: 0.4
    wheel_radius: 0.1
    left_ticks_per_revolution: 1000.0
    right_ticks_per_revolution: 2000.0
"""
MakeRobot = Callable[..., RobotFile]


@pytest.fixture
def robot(tmp_path: Path) -> MakeRobot:
    """A robot file with some lines more."""

    def make(*lines: str) -> RobotFile:
        path = tmp_path / "robot.yaml"
        path.write_text(BARE + "".join(f"    {line}\n" for line in lines))
        return read_robot_file(path)

    return make


class Messages:
    """Messages of ROS 2 Jazzy, as rosbags makes them."""

    def __init__(self) -> None:
        from rosbags.typesys import Stores, get_types_from_msg, get_typestore

        from werrimbi_odom.files.bags.driver_messages import DEFINITIONS

        self.store = get_typestore(Stores.ROS2_JAZZY)
        self.noetic = get_typestore(Stores.ROS1_NOETIC)
        for kind, text in DEFINITIONS.items():
            for store in (self.store, self.noetic):
                store.register(get_types_from_msg(text, kind))

    def make(self, kind: str, *fields: Any) -> Any:
        return self.store.types[kind](*fields)

    def header(self, nanoseconds: int, frame: str = "") -> Any:
        stamp = self.make("builtin_interfaces/msg/Time", *divmod(nanoseconds, 10**9))
        return self.make("std_msgs/msg/Header", stamp, frame)

    def joints(
        self, nanoseconds: int, names: Sequence[str], positions: Sequence[float]
    ) -> tuple[str, Any]:
        kind, none = "sensor_msgs/msg/JointState", np.zeros(0)
        where = np.array(positions, dtype=np.float64)
        return kind, self.make(kind, self.header(nanoseconds), list(names), where, none, none)

    def count(self, value: float, bits: int = 32, of: str = "Int") -> tuple[str, Any]:
        kind = f"std_msgs/msg/{of}{bits}"
        return kind, self.make(kind, value)

    def counts(self, *values: int, bits: int = 64, of: str = "Int") -> tuple[str, Any]:
        kind = f"std_msgs/msg/{of}{bits}MultiArray"
        layout = self.make("std_msgs/msg/MultiArrayLayout", [], 0)
        return kind, self.make(kind, layout, np.array(values, dtype=f"{of.lower()}{bits}"))

    def floats(self, *values: float) -> tuple[str, Any]:
        kind = "std_msgs/msg/Float64MultiArray"
        layout = self.make("std_msgs/msg/MultiArrayLayout", [], 0)
        return kind, self.make(kind, layout, np.array(values, dtype=np.float64))

    def encoder(self, nanoseconds: int, count: int) -> tuple[str, Any]:
        kind = "duckietown_msgs/msg/WheelEncoderStamped"
        return kind, self.make(kind, self.header(nanoseconds), count, 135, 1)

    def _point(self, x: float, y: float, kind: str = "Point") -> Any:
        return self.make(f"geometry_msgs/msg/{kind}", x, y, 0.0)

    def _turn(self, yaw: float) -> Any:
        kind = "geometry_msgs/msg/Quaternion"
        if np.isnan(yaw):
            return self.make(kind, 0.0, 0.0, 0.0, 0.0)
        return self.make(kind, 0.0, 0.0, np.sin(yaw / 2), np.cos(yaw / 2))

    def _pose(self, x: float, y: float, yaw: float) -> Any:
        return self.make("geometry_msgs/msg/Pose", self._point(x, y), self._turn(yaw))

    def pose(self, nanoseconds: int, x: float, y: float, yaw: float) -> tuple[str, Any]:
        kind = "geometry_msgs/msg/PoseStamped"
        return kind, self.make(kind, self.header(nanoseconds, "map"), self._pose(x, y, yaw))

    def plane_pose(self, x: float, y: float, yaw: float) -> tuple[str, Any]:
        kind = "geometry_msgs/msg/Pose2D"
        return kind, self.make(kind, x, y, yaw)

    def pose_with_covariance(
        self, nanoseconds: int, x: float, y: float, yaw: float, variances: Sequence[float]
    ) -> tuple[str, Any]:
        kind, covariance = "geometry_msgs/msg/PoseWithCovarianceStamped", np.zeros(36)
        covariance[[0, 7, 35]] = variances
        pose = self.make("geometry_msgs/msg/PoseWithCovariance", self._pose(x, y, yaw), covariance)
        return kind, self.make(kind, self.header(nanoseconds, "map"), pose)

    def odometry(self, nanoseconds: int, x: float, y: float, yaw: float) -> tuple[str, Any]:
        kind, covariance = "nav_msgs/msg/Odometry", np.ones(36)
        pose = self.make("geometry_msgs/msg/PoseWithCovariance", self._pose(x, y, yaw), covariance)
        none = self._point(0.0, 0.0, "Vector3")
        twist = self.make("geometry_msgs/msg/Twist", none, none)
        twist = self.make("geometry_msgs/msg/TwistWithCovariance", twist, covariance)
        header = self.header(nanoseconds, "odom")
        return kind, self.make(kind, header, "base_link", pose, twist)

    def transform(
        self, nanoseconds: int, frames: tuple[str, str], x: float, y: float, yaw: float
    ) -> tuple[str, Any]:
        kind, where = "geometry_msgs/msg/TransformStamped", self._point(x, y, "Vector3")
        transform = self.make("geometry_msgs/msg/Transform", where, self._turn(yaw))
        return kind, self.make(kind, self.header(nanoseconds, frames[0]), frames[1], transform)

    def transforms(self, *transforms: tuple[str, Any]) -> tuple[str, Any]:
        kind = "tf2_msgs/msg/TFMessage"
        return kind, self.make(kind, [message for _, message in transforms])

    def imu(self, nanoseconds: int, rate: float, known: bool = True) -> tuple[str, Any]:
        kind, covariance = "sensor_msgs/msg/Imu", np.zeros(9)
        of_rate = covariance if known else np.array([-1.0] + [0.0] * 8)
        turning = self.make("geometry_msgs/msg/Vector3", 0.0, 0.0, rate)
        none = self._point(0.0, 0.0, "Vector3")
        header = self.header(nanoseconds, "imu_link")
        fields = (header, self._turn(np.nan), covariance, turning, of_rate, none, covariance)
        return kind, self.make(kind, *fields)

    def scan(self, nanoseconds: int, lidar: Any, ranges: Any) -> tuple[str, Any]:
        """A turn of a simulated lidar."""
        kind = "sensor_msgs/msg/LaserScan"
        angles = 0.0, lidar.increment * (lidar.beams - 1), lidar.increment
        times = lidar.beam_interval, 1.0 / lidar.rate_hz
        limits = lidar.nearest, lidar.farthest
        seen = np.asarray(ranges, dtype=np.float32), np.zeros(0, dtype=np.float32)
        return kind, self.make(
            kind, self.header(nanoseconds, "laser"), *angles, *times, *limits, *seen
        )

    def fix(self, nanoseconds: int, degrees: tuple[float, float], fixed: bool = True) -> Any:
        """A fix of satellites, with a standard deviation of 0.2 m."""
        kind, covariance = "sensor_msgs/msg/NavSatFix", np.diag([0.04, 0.04, 1.0]).ravel()
        status = self.make("sensor_msgs/msg/NavSatStatus", 0 if fixed else -1, 1)
        header = self.header(nanoseconds, "gps")
        return kind, self.make(kind, header, status, *degrees, 50.0, covariance, 2)

    def of_driver(self, kind: str, nanoseconds: int, **fields: Any) -> tuple[str, Any]:
        """A driver's message with counters; what is not named is zero, or empty."""
        filled = []
        for name, (form, of) in self.store.fielddefs[kind][1]:
            if name == "header":
                filled.append(self.header(nanoseconds))
            else:
                empty = np.zeros(0, dtype=of[0][1][0]) if form.name == "SEQUENCE" else 0
                filled.append(fields.get(name, empty))
        return kind, self.make(kind, *filled)

    def write_ros1(self, path: Path, entries: Sequence[tuple[str, int, tuple[str, Any]]]) -> Path:
        """A ROS 1 bag of (topic, received [ns], (type, message)), uncompressed, three chunks."""
        from rosbags.rosbag1 import Writer

        writer = Writer(path)
        writer.chunk_threshold = 1 + sum(100 for _ in entries) // 2
        with writer:
            connections: dict[str, Any] = {}
            for topic, received, (kind, message) in entries:
                if topic not in connections:
                    connections[topic] = writer.add_connection(topic, kind, typestore=self.noetic)
                data = self.noetic.serialize_ros1(self._of_noetic(message), kind)
                writer.write(connections[topic], received, data)
        return path

    def _of_noetic(self, message: Any) -> Any:
        """The same message in ROS 1, whose headers have a number too."""
        if isinstance(message, list):
            return [self._of_noetic(each) for each in message]
        kind = getattr(message, "__msgtype__", None)
        if kind is None:
            return message
        names = [name for name, _ in self.noetic.fielddefs[kind][1]]
        return self.noetic.types[kind](
            *(0 if name == "seq" else self._of_noetic(getattr(message, name)) for name in names)
        )

    def write(
        self,
        folder: Path,
        entries: Sequence[tuple[str, int, tuple[str, Any]]],
        plugin: str = "mcap",
        compressed: str = "",
    ) -> Path:
        """A bag of (topic, received [ns], (type, message)); `compressed`: FILE or MESSAGE."""
        from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer

        storage = {"mcap": StoragePlugin.MCAP, "sqlite3": StoragePlugin.SQLITE3}[plugin]
        opened = Writer(folder, version=9, storage_plugin=storage)
        if compressed:
            opened.set_compression(CompressionMode[compressed], CompressionFormat.ZSTD)
        with opened as writer:
            connections: dict[tuple[str, str], Any] = {}
            for topic, received, (kind, message) in entries:
                of = (topic, kind)
                if of not in connections:
                    connections[of] = writer.add_connection(topic, kind, typestore=self.store)
                data = self.store.serialize_cdr(message, kind)
                writer.write(connections[of], received, data)
        return folder


@pytest.fixture(scope="session")
def ros() -> Messages:
    """Messages and bags without ROS."""
    pytest.importorskip("rosbags", reason="rosbags is not installed")
    return Messages()
