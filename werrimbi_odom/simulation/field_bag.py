# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Write a drive with ordinary sensors as the rosbag2 that its user would have recorded."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .bag import Messages
from .field_drive import FieldDrive
from .robot import TrueRobot

TOPICS = {
    "/robot_description": "std_msgs/msg/String",
    "/joint_states": "sensor_msgs/msg/JointState",
    "/imu": "sensor_msgs/msg/Imu",
    "/odom": "nav_msgs/msg/Odometry",
    "/scan": "sensor_msgs/msg/LaserScan",
    "/tf": "tf2_msgs/msg/TFMessage",
    "/tf_static": "tf2_msgs/msg/TFMessage",
}
LIDAR_FRAME = "base_scan"


def urdf(robot: TrueRobot) -> str:
    """URDF of the manufacturer, with wheel joints at their nominal places."""
    half, radius = robot.nominal.wheel_separation / 2, robot.nominal.wheel_radius
    parts = ['<?xml version="1.0"?>', '<robot name="simulated">', '  <link name="base_link"/>']
    for names, y in zip(robot.joints, (half, -half), strict=True):
        for number, name in enumerate(names):
            x = 0.0 if len(names) == 1 else half * (1 - 2 * number)
            link = name.removesuffix("_joint")
            parts.append(
                f'  <link name="{link}"><collision><geometry><cylinder radius="{radius}" '
                f'length="0.02"/></geometry></collision></link>\n'
                f'  <joint name="{name}" type="continuous"><parent link="base_link"/>'
                f'<child link="{link}"/><origin xyz="{x} {y} 0"/><axis xyz="0 1 0"/></joint>'
            )
    return "\n".join([*parts, "</robot>"])


def write_field_bag(
    drive: FieldDrive, robot: TrueRobot, folder: str | Path, mounting: bool = True
) -> Path:
    """Write wheels, gyro, scans, the robot's odometry, transforms of a localiser, and the URDF.

    The folder must not exist. `mounting`: whether to write the transform of the lidar's mount.
    """
    folder = Path(folder)
    folder.parent.mkdir(parents=True, exist_ok=True)
    ros = Messages()
    made, header, facing = ros.made, ros.header, ros.facing

    def vector(x: float, y: float, z: float) -> object:
        return made("geometry_msgs/msg/Vector3", x, y, z)

    def transform(stamp: float, parent: str, child: str, pose: np.ndarray) -> object:
        x, y, yaw = map(float, pose)
        moved = made("geometry_msgs/msg/Transform", vector(x, y, 0.0), facing(yaw))
        one = made("geometry_msgs/msg/TransformStamped", header(stamp, parent), child, moved)
        return made("tf2_msgs/msg/TFMessage", [one])

    def odometry(stamp: float, pose: np.ndarray) -> object:
        unknown, still = np.zeros(36), vector(0.0, 0.0, 0.0)
        place = made("geometry_msgs/msg/PoseWithCovariance", ros.pose(*map(float, pose)), unknown)
        twist = made("geometry_msgs/msg/Twist", still, still)
        moves = made("geometry_msgs/msg/TwistWithCovariance", twist, unknown)
        return made(TOPICS["/odom"], header(stamp, "odom"), "base_link", place, moves)

    def imu(stamp: float, rate: float) -> object:
        head, none, unknown = header(stamp, "imu_link"), np.zeros(9), np.array([-1.0, *np.zeros(8)])
        turns, weighs = vector(0.0, 0.0, rate), vector(0.0, 0.0, 9.81)
        return made(TOPICS["/imu"], head, facing(0.0), unknown, turns, none, weighs, none)

    lidar = drive.lidar

    def scan(stamp: float, ranges: np.ndarray) -> object:
        angles = 0.0, lidar.increment * (lidar.beams - 1), lidar.increment
        times = lidar.beam_interval, 1.0 / lidar.rate_hz
        limits = lidar.nearest, lidar.farthest
        seen = ranges.astype(np.float32), np.zeros(0, dtype=np.float32)
        kind = TOPICS["/scan"]
        return made(kind, header(stamp, LIDAR_FRAME), *angles, *times, *limits, *seen)

    names = [name for side in robot.joints for name in side]
    first = float(min(drive.wheels[0, 1], drive.imu[0, 1], drive.localiser[0, 1]))
    messages = [(first, "/robot_description", made("std_msgs/msg/String", urdf(robot)))]
    if mounting:
        sits = transform(first, "base_link", LIDAR_FRAME, np.array(lidar.mount))
        messages.append((first, "/tf_static", sits))
    scans = drive.scans
    for stamp, received, ranges in zip(scans.time, drive.scans_received, scans.ranges, strict=True):
        messages.append((received, "/scan", scan(stamp, ranges)))
    for (stamp, received, left, right), pose in zip(drive.wheels, drive.odometry, strict=True):
        angles = np.repeat([left, right], robot.wheels_a_side)
        messages.append((received, "/joint_states", ros.joints(stamp, names, angles)))
        messages.append((received, "/odom", odometry(stamp, pose)))
        messages.append((received, "/tf", transform(stamp, "odom", "base_link", pose)))
    for stamp, received, rate in drive.imu:
        messages.append((received, "/imu", imu(stamp, float(rate))))
    for stamp, received, *pose in drive.localiser:
        between = _map_to_odom(drive, float(stamp), np.array(pose))
        messages.append((received, "/tf", transform(stamp, "map", "odom", between)))
    ros.write(
        folder,
        {topic: kind for topic, kind in TOPICS.items() if mounting or topic != "/tf_static"},
        messages,
    )
    return folder


def _map_to_odom(drive: FieldDrive, stamp: float, pose: np.ndarray) -> np.ndarray:
    """The localiser's transform from map to odom, by its pose of base_link and the odometry."""
    own = [np.interp(stamp, drive.wheels[:, 0], drive.odometry[:, column]) for column in range(3)]
    turn = pose[2] - own[2]
    place = complex(pose[0], pose[1]) - complex(own[0], own[1]) * np.exp(1j * turn)
    return np.array([place.real, place.imag, turn])
