# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What a bag holds: wheels, references, and which of them come from the wheels."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from werrimbi_odom.files.bags.bag import opened_bag
from werrimbi_odom.files.bags.bag_contents import Contents, contents_of
from werrimbi_odom.files.bags.measured_topic import preference
from werrimbi_odom.files.bags.own_odometry import is_asked_for, why_from_wheels
from werrimbi_odom.files.bags.reference_choice import other_scans
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.simulation.lidar import Lidar

MS = 10**6
WHEELS = ["left_wheel_joint", "right_wheel_joint"]
ODOMETRY = "nav_msgs/msg/Odometry"


def localised(ros: Any, corrections: tuple[float, ...]) -> list[Any]:
    """Wheels, a gyro, odometry, and a localiser that shifts map -> odom so often."""
    entries = [
        ("/joint_states", 1, ros.joints(1 * MS, WHEELS, [0.0, 0.0])),
        ("/imu", 2, ros.imu(2 * MS, 0.1)),
        ("/odom", 3, ros.odometry(3 * MS, 0.0, 0.0, 0.0)),
        ("/initialpose", 4, ros.pose_with_covariance(4 * MS, 0.0, 0.0, 0.0, (1, 1, 1))),
        ("/tf_static", 5, ros.transforms(ros.transform(0, ("base_link", "laser"), 0.1, 0, 0))),
    ]
    for n, x in enumerate(corrections, start=6):
        entries.append(("/tf", n, ros.transforms(ros.transform(n * MS, ("map", "odom"), x, 0, 0))))
        moved = ros.transform(n * MS, ("odom", "base_link"), 0.1 * n, 0.0, 0.0)
        entries.append(("/tf", n, ros.transforms(moved)))
    return entries


def contents(path: Path) -> Contents:
    with opened_bag(path) as bag:
        return contents_of(bag)


def test_what_measures_and_what_comes_from_the_wheels(tmp_path: Path, ros: Any) -> None:
    held = contents(ros.write(tmp_path / "bag", localised(ros, (0.0, 0.01, 0.03))))
    assert [(each.name, each.gives, each.joints) for each in held.wheels] == [
        ("/joint_states", "positions", tuple(WHEELS)),
        ("/odom", "odometry", ()),
    ]
    assert [(each.name, each.measures) for each in held.independent] == [
        ("/tf:map:base_link", "poses"),
        ("/imu", "yaw"),
    ]
    others = [each for each in held.references if not each.independent]
    assert [each.name for each in others] == ["/tf:odom:base_link", "/odom"]
    assert all("odom -> base_link is the robot's own odometry" in each.why for each in others)


def test_a_localisers_own_poses_come_before_its_transforms(tmp_path: Path, ros: Any) -> None:
    """AMCL stamps map -> odom a second ahead: a second of odometry is in what that makes."""
    entries = localised(ros, (0.0, 0.01, 0.03))
    entries.append(("/amcl_pose", 9, ros.pose_with_covariance(9 * MS, 0.0, 0.0, 0.0, (1, 1, 1))))
    found = contents(ros.write(tmp_path / "bag", entries)).independent
    first, second, *_ = sorted(found, key=preference)
    assert (first.name, second.name) == ("/amcl_pose", "/tf:map:base_link")
    assert second.through_wheels
    assert not first.through_wheels


def test_a_trackers_poses_come_before_a_localisers_which_wander(tmp_path: Path, ros: Any) -> None:
    """AMCL at 1.6 Hz, which wandered by 20 mm, was taken before motion capture of 2 mm at 5 Hz."""
    entries = localised(ros, (0.0, 0.01, 0.03))
    entries.append(("/amcl_pose", 9, ros.pose_with_covariance(9 * MS, 0.0, 0.0, 0.0, (1, 1, 1))))
    kind, seen = ros.pose(9 * MS, 0.0, 0.0, 0.0)
    for topic, frame in (("/vrpn/robot/pose", "world"), ("/slam/pose", "map")):
        held = replace(seen, header=replace(seen.header, frame_id=frame))
        entries.append((topic, 9, (kind, held)))
    found = contents(ros.write(tmp_path / "bag", entries)).independent
    first, second, *_ = sorted(found, key=preference)
    assert (first.name, second.name) == ("/vrpn/robot/pose", "/amcl_pose")


@pytest.mark.parametrize("raw", ["/odom/unfiltered", "/raw_odom", "/wheel/odometry"])
def test_odometry_of_the_wheels_alone_comes_before_what_a_filter_makes_of_it(
    tmp_path: Path, ros: Any, raw: str
) -> None:
    """The filter of linorobot has the plain name."""
    assert "filter" not in why_from_wheels(raw, "nav_msgs/msg/Odometry", "odom", "base_link")
    for first in (True, False):
        topics = sorted(("/odom", raw), reverse=first)
        entries = [
            (topic, 2 * n + number, ros.odometry(n * MS, 0.1 * n, 0.0, 0.0))
            for n in range(1, 9)
            for number, topic in enumerate(topics)
        ]
        held = contents(ros.write(tmp_path / f"bag{first}", entries))
        assert [each.name for each in held.wheels] == [raw, "/odom"]


def test_what_the_odometry_carries_on_comes_after_what_was_seen(tmp_path: Path, ros: Any) -> None:
    """A marker's pose, and the same carried on by the wheels: a message for each of /odom."""
    entries = []
    for n in range(1, 60):
        entries.append(("/odom", n, ros.odometry(n * MS, 0.1 * n, 0.0, 0.0)))
        seen = 0.1 * n, 0.001 * n * n, 0.0
        entries.append(("/marker_pose_continuous", n, ros.pose(n * MS, *seen)))
        entries.append(("/marker_pose", n, ros.pose(n * MS + 7, *seen)))
    held = contents(ros.write(tmp_path / "bag", entries))
    assert [each.name for each in held.independent] == ["/marker_pose", "/marker_pose_continuous"]
    seen, carried_on = held.independent
    assert "the wheels carry it on" in carried_on.why
    assert "the wheels carry it on" not in seen.why


def test_a_scan_that_was_moved_is_no_reference(tmp_path: Path, ros: Any) -> None:
    lidar = Lidar()
    topics = ("/stable_scan", "/scan", "/scan_filtered")
    entries = [(topic, 1, ros.scan(MS, lidar, np.ones(lidar.beams))) for topic in topics]
    held = contents(ros.write(tmp_path / "bag", entries))
    assert [each.name for each in held.independent] == ["/scan", "/scan_filtered"]
    moved = next(each for each in held.references if each.name == "/stable_scan")
    assert moved.why == "made of /scan by its name, and perhaps moved by the odometry"


def test_points_in_a_frame_of_the_room_were_moved_there(tmp_path: Path, ros: Any) -> None:
    lidar, kind = Lidar(), "sensor_msgs/msg/PointCloud2"
    _, scan = ros.scan(MS, lidar, np.ones(lidar.beams))
    scan.header.frame_id = "odom"
    none = np.zeros(0, dtype=np.uint8)
    clouds = [
        (f"/{where}_cloud", 2, (kind, ros.make(kind, header, 1, 0, [], False, 16, 0, none, True)))
        for where in ("map", "velodyne")
        if (header := ros.header(1, where))
    ]
    entries = [("/projected", 1, ("sensor_msgs/msg/LaserScan", scan)), *clouds]
    held = contents(ros.write(tmp_path / "bag", entries))
    assert held.independent == ()
    moved = "its points are given in odom, where the odometry has moved them"
    assert held.references[0].why == moved
    of_map, of_lidar = (words for _, words in other_scans(held))
    assert of_map.startswith("its points are given in map, where a localiser")
    assert "pointcloud_to_laserscan makes them of it" in of_lidar


def test_a_map_that_never_corrects_leaves_the_odometry(tmp_path: Path, ros: Any) -> None:
    held = contents(ros.write(tmp_path / "bag", localised(ros, (0.5, 0.5, 0.5))))
    assert [each.name for each in held.independent] == ["/imu"]
    on_map = next(each for each in held.references if each.name == "/tf:map:base_link")
    assert on_map.why.endswith("and map -> odom never changes")


def test_a_filter_is_not_what_the_wheels_did(tmp_path: Path, ros: Any) -> None:
    entries = [(topic, 1, ros.odometry(MS, 0.0, 0.0, 0.0)) for topic in ("/odom_kf", "/odom")]
    held = contents(ros.write(tmp_path / "bag", entries))
    assert [each.name for each in held.wheels] == ["/odom"]


def test_speeds_alone_are_told_from_angles(tmp_path: Path, ros: Any) -> None:
    kind, message = ros.joints(1 * MS, WHEELS, [0.0, 0.0])
    message.velocity, message.position = message.position, message.velocity
    held = contents(ros.write(tmp_path / "bag", [("/joint_states", 1, (kind, message))]))
    assert held.wheels[0].gives == "velocities"


@pytest.mark.parametrize(
    ("topic", "kind", "parent", "child", "from_wheels"),
    [
        ("/odom", ODOMETRY, "odom", "base_link", True),
        ("/robot_3/odom", ODOMETRY, "robot_3/odom", "robot_3/base_footprint", True),
        ("/odometry/filtered", ODOMETRY, "map", "base_link", True),
        ("/robot_pose_ekf/odom_combined", "", "odom_combined", "", True),
        ("/wheel_odom", ODOMETRY, "", "", True),
        ("/slam_bot/odom", ODOMETRY, "odom", "base_link", True),
        ("/odom", ODOMETRY, "ground_robot/odom", "ground_robot/base_link", True),
        ("/robot/dlio/odom_node/odom", ODOMETRY, "odom", "base_link", False),
        ("/stereo_odometry/odom", ODOMETRY, "odom", "base_link", False),
        ("/rgbd_odometry/odom", ODOMETRY, "odom", "base_link", False),
        ("/fastlio2/odom", ODOMETRY, "odom", "base_link", False),
        ("/rtabmap/odom", ODOMETRY, "odom", "base_link", False),
        ("/zed2/zed_node/odom", ODOMETRY, "odom", "base_link", False),
        ("/Odometry", ODOMETRY, "camera_init", "body", False),
        ("/ground_truth/odom", ODOMETRY, "world", "base_link", False),
        ("/odometry/gps", ODOMETRY, "odom", "", False),
        ("/amcl_pose", "geometry_msgs/msg/PoseWithCovarianceStamped", "map", "", False),
        ("/vrpn/robot/pose", "geometry_msgs/msg/PoseStamped", "world", "", False),
    ],
)
def test_names(topic: str, kind: str, parent: str, child: str, from_wheels: bool) -> None:
    assert bool(why_from_wheels(topic, kind, parent, child)) is from_wheels


def test_a_namespace_that_holds_wheels_is_the_robots_name(tmp_path: Path, ros: Any) -> None:
    """/vision/odom may be a camera's; beside /vision/joint_states it is that robot's own."""
    for joints, independent in ((WHEELS, []), (["pan", "tilt"], ["/vision/odom"])):
        entries = [
            ("/vision/joint_states", 1, ros.joints(1 * MS, joints, [0.0, 0.0])),
            ("/vision/odom", 2, ros.odometry(2 * MS, 0.0, 0.0, 0.0)),
        ]
        held = contents(ros.write(tmp_path / joints[0], entries))
        assert [each.name for each in held.independent] == independent


def turning(ros: Any, other: str, apart: float, drift: float) -> list[Any]:
    """Odometry of a curved way, and of the same under another name, laid elsewhere and turned."""
    entries = []
    for n in range(1, 200):
        time, heading = 20 * n * MS, 0.02 * n
        pose = 2.0 * np.sin(heading), 2.0 - 2.0 * np.cos(heading), heading
        entries.append(("/odom", time, ros.odometry(time, *pose)))
        seen = complex(*pose[:2]) * np.exp(1j * (0.7 + drift * n)) + (3.0 - 1.0j)
        stamp = time + round(apart * MS)
        entries.append((other, time + 1, ros.pose(stamp, seen.real, seen.imag, heading)))
    return entries


@pytest.mark.parametrize("apart", [0.0, 7.0])
def test_odometry_under_another_name_is_no_reference(
    tmp_path: Path, ros: Any, apart: float
) -> None:
    """A simulator's plugin sends the wheels' odometry once more; its name tells nothing."""
    entries = turning(ros, "/gazebo_odom", 0.0, 0.0)
    if apart:  # sent between the others: as far on as it was then
        entries = [
            each if each[0] == "/odom" else (*each[:2], between(ros, each[2], apart))
            for each in entries
        ]
    held = contents(ros.write(tmp_path / "bag", entries))
    assert held.independent == ()
    copied = next(each for each in held.references if each.name == "/gazebo_odom")
    assert copied.why.startswith("the same poses as /odom, and odom -> base_link is the robot's")


def between(ros: Any, sent: tuple[str, Any], apart: float) -> tuple[str, Any]:
    """The same path, so many milliseconds later."""
    stamp = sent[1].header.stamp.sec * 10**9 + sent[1].header.stamp.nanosec + round(apart * MS)
    heading = 0.001 * stamp / MS
    place = complex(2.0 * np.sin(heading), 2.0 - 2.0 * np.cos(heading)) * np.exp(0.7j)
    return ros.pose(stamp, place.real + 3.0, place.imag - 1.0, heading)


@pytest.mark.parametrize("name", ["/gazebo_odom", "/robot_pose"])
def test_what_drifts_from_the_odometry_is_a_reference(tmp_path: Path, ros: Any, name: str) -> None:
    """By a hundredth of a degree in each message."""
    held = contents(ros.write(tmp_path / "bag", turning(ros, name, 0.0, 0.0002)))
    assert [each.name for each in held.independent] == [name]


def test_a_sensors_poses_that_are_sent_on_as_odometry_too_are_its_own(
    tmp_path: Path, ros: Any
) -> None:
    """A scan matcher's: what is on /odom is not made from wheels then."""
    held = contents(ros.write(tmp_path / "bag", turning(ros, "/odom_rf2o", 0.0, 0.0)))
    assert [each.name for each in held.independent] == ["/odom_rf2o"]


def test_the_joints_of_the_robot_are_no_references(tmp_path: Path, ros: Any) -> None:
    """A robot_state_publisher tells where wheels and arm are on the robot; no odometry is sent."""
    joints = (("base_link", "left_wheel"), ("base_link", "lift"), ("upper_arm", "forearm"))
    entries = []
    for n in range(1, 50):
        turned = [
            ros.transform(n * MS, joints[0], 0.0, 0.3, 0.01 * n),
            ros.transform(n * MS, joints[1], 0.001 * n, 0.0, 0.0),
            ros.transform(n * MS, joints[2], 0.2, 0.0, 0.01 * n),
        ]
        entries.append(("/tf", n, ros.transforms(*turned)))
    assert contents(ros.write(tmp_path / "bag", entries)).references == ()


def test_a_tracker_without_a_base_is_still_a_reference(tmp_path: Path, ros: Any) -> None:
    entries = [
        ("/tf", n, ros.transforms(ros.transform(n * MS, ("world", "rigid_body_1"), 0.1 * n, 0, 0)))
        for n in range(1, 50)
    ]
    held = contents(ros.write(tmp_path / "bag", entries))
    assert [each.name for each in held.independent] == ["/tf:world:rigid_body_1"]


def test_what_moves_within_the_robot_is_no_measurement(tmp_path: Path, ros: Any) -> None:
    """Map and odom stand for nothing, and the pose is sent between two frames of the base."""
    entries = []
    for n in range(1, 50):
        sent = [
            ros.transform(n * MS, ("map", "odom"), 0.0, 0.0, 0.0),
            ros.transform(n * MS, ("odom", "base_footprint"), 0.0, 0.0, 0.0),
            ros.transform(n * MS, ("base_footprint", "base_link"), 0.1 * n, 0.0, 0.0),
        ]
        entries.append(("/tf", n, ros.transforms(*sent)))
    assert contents(ros.write(tmp_path / "bag", entries)).independent == ()


def test_of_several_poses_one_may_have_no_stamps(tmp_path: Path, ros: Any) -> None:
    """A scan matcher's Pose2D beside poses of a tracker and odometry."""
    entries: list[Any] = [("/joint_states", 1, ros.joints(1 * MS, WHEELS, [0.0, 0.0]))]
    for n in range(2, 40):
        entries.append(("/odom", n * MS, ros.odometry(n * MS, 0.1 * n, 0.0, 0.0)))
        entries.append(("/vicon/pose", n * MS + 1, ros.pose(n * MS + 7, 0.09 * n, 0.0, 0.0)))
        entries.append(("/pose2D", n * MS + 2, ros.plane_pose(0.095 * n, 0.0, 0.0)))
    held = contents(ros.write(tmp_path / "bag", entries))
    assert {each.name for each in held.independent} == {"/vicon/pose", "/pose2D"}


def test_fixes_that_a_filter_fused_are_no_satellites(tmp_path: Path, ros: Any) -> None:
    """navsat_transform gives the filter's positions back as a NavSatFix: the wheels are in them."""
    entries = [(name, 2, ros.fix(2 * MS, (60.0, 25.0))) for name in ("/gps/filtered", "/gps/fix")]
    held = contents(ros.write(tmp_path / "bag", entries))
    assert [each.name for each in held.independent] == ["/gps/fix"]
    assert held.references[-1].why == "a filter's output, which fuses the wheels"


def test_points_in_no_frame_come_after_satellites(tmp_path: Path, ros: Any) -> None:
    """A car's speed and steering, sent as a point."""
    kind = "geometry_msgs/msg/PointStamped"
    entries = []
    for name, frame in (("/a_speed", ""), ("/place", "map")):
        point = ros.make("geometry_msgs/msg/Point", 1.0, 2.0, 0.0)
        entries.append((name, 1, (kind, ros.make(kind, ros.header(MS, frame), point))))
    entries.append(("/fix", 2, ros.fix(2 * MS, (60.0, 25.0))))
    held = contents(ros.write(tmp_path / "bag", entries))
    assert [each.name for each in held.references][-1] == "/a_speed"
    assert "may be no positions" in held.references[-1].why


@pytest.mark.parametrize(
    ("topic", "asked_for"),
    [
        *((name, False) for name in ("/planar_pose", "/floorplan_pose", "/goalie/pose")),
        *((name, True) for name in ("/goal_pose", "/move_base_simple/goal", "/targetPose")),
        *((name, True) for name in ("/initialpose", "/clicked_point", "/goalpose", "/plan1")),
        *((name, True) for name in ("/pose_error", "/cmd_pose", "/mavros/setpoint_position/local")),
    ],
)
def test_goals_and_commands_are_told_by_whole_words(topic: str, asked_for: bool) -> None:
    assert is_asked_for(topic) is asked_for


def test_a_body_that_is_called_target_is_a_reference_if_it_is_asked_for(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    topic = "/vrpn_client_node/target/pose"
    entries = [("/joint_states", 1, ros.joints(1 * MS, WHEELS, [0.0, 0.0]))]
    entries += [(topic, n, ros.pose(n * MS, 0.1 * n, 0.0, 0.0)) for n in range(1, 9)]
    bag = ros.write(tmp_path / "bag", entries)
    assert contents(bag).references == ()
    run = read_run(bag, robot(), reference_topic=topic)
    assert run.reference is not None
    assert not run.circle
