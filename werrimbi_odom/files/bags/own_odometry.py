# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Recognises by name and frames what is the robot's own odometry, and so no measurement of it.

Names are not sufficient evidence; how closely such poses follow the wheels is tested in addition
(inference.comparison.made_from_wheels).
"""

from __future__ import annotations

import re
from collections.abc import Collection

_SENSORS = """
aruco apriltag amcl camera cartographer dlio dlo fastlio fiducial fix gazebo gnss gps gt icp kiss
laser lidar lio liosam loam localiser localizer mocap motion motive ndt optitrack orb orbslam
qualisys realsense rf2o rgbd rtabmap rtk slam stereo svo t265 tag tracker tracking true truth uwb
vicon vins vio vision visual vo vslam zed rovio okvis openvins scan reference qtm ground
"""
SENSORS = frozenset(_SENSORS.split())
"""Words in the names of poses from a sensor that observes the surroundings."""

FILTERS = (
    *("filtered", "ekf", "ukf", "kalman", "_kf", "/kf"),
    *("combined", "fused", "robot_localization"),
)
"""Words in the names of filter outputs, which fuse the wheels."""
FUSED = "a filter's output, which fuses the wheels"

UNFILTERED = ("unfiltered", "raw", "wheel")
"""Words in the names of odometry beside a filter's output under a plain name, as linorobot's."""

_NO_MEASUREMENT = """
goal goals subgoal subgoals target targets setpoint setpoints initialpose clicked plan plans planned
planner planning cmd command commands commanded error errors
"""
NO_MEASUREMENT = frozenset(_NO_MEASUREMENT.split())
"""Words in topics of commanded or requested poses, from RViz or a program, and of how far the
robot is from them."""

ODOMETRY = "nav_msgs/msg/Odometry"


def why_from_wheels(
    topic: str, kind: str, parent: str, child: str, robots: Collection[str] = ()
) -> str:
    """Reason why poses are probably computed from the wheels; "" if names do not suggest it.

    `topic`, `kind`: topic and message type; "" for a transform. `parent`, `child`: their frames, as
    far as known. `robots`: namespaces that are known to be a robot's.
    """
    if _words(*(_without_robot(name, robots) for name in (topic, parent, child))) & SENSORS:
        return ""
    if is_filtered(topic):
        return FUSED
    frames = f"{parent} -> {child}" if parent and child else (parent or child)
    if is_odometry_frame(parent) and (is_base(child) or not child):
        return f"{frames} is the robot's own odometry, made from its wheels"
    if kind == ODOMETRY and not parent:
        return "odometry of no sensor that is named, made from the wheels"
    return ""


def is_filtered(topic: str) -> bool:
    """Whether a topic's name says that its odometry is a filter's, which fuses other sensors."""
    return any(word in topic.lower().replace("unfiltered", "") for word in FILTERS)


def is_unfiltered(topic: str) -> bool:
    """Whether a topic's name says that its odometry is of the wheels alone."""
    return any(word in topic.lower() for word in UNFILTERED)


def names_a_sensor(topic: str) -> bool:
    """Whether a topic's name contains that of a sensor; a simulator's name does not count."""
    return bool(_words(topic) & (SENSORS - {"gazebo"}))


def names_a_measurement(topic: str) -> bool:
    """Whether a topic's name contains that of a sensor, or says that it is a pose."""
    return not is_asked_for(topic) and bool(_words(topic) & (SENSORS | {"pose", "imu", "gyro"}))


def is_asked_for(topic: str) -> bool:
    """Whether poses of a topic are requested, or relative to such, and not measured."""
    words = _words(re.sub(r"([a-z0-9])([A-Z])", r"\1_\2", topic))
    words |= {word.removesuffix("pose").removesuffix("point") for word in words}  # goalpose
    return bool(words & NO_MEASUREMENT)


def is_base(frame: str) -> bool:
    """Whether a frame is a robot's base, by its name."""
    tail = frame.rpartition("/")[2].lower()
    return tail in ("base", "footprint", "chassis") or any(
        word in tail for word in ("base_link", "base_footprint", "baselink", "base_frame")
    )


def is_odometry_frame(frame: str) -> bool:
    """Whether a frame is the origin of odometry, by its name."""
    return "odom" in frame.rpartition("/")[2].lower()


def is_map(frame: str) -> bool:
    """Whether a frame is a localiser's map, perhaps of one of several robots, by its name."""
    return frame.rpartition("/")[2] == "map"


def _without_robot(name: str, robots: Collection[str]) -> str:
    """A topic or a frame without a first part that names the robot, as in `/slam_bot/odom`."""
    first, _, rest = name.strip("/").partition("/")
    return rest if rest and (first in robots or _words(first) & {"robot", "bot"}) else name


def _words(*names: str) -> set[str]:
    found = {word for name in names for word in re.findall(r"[a-z0-9]+", name.lower())}
    return found | {word.rstrip("0123456789") for word in found}
