# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Wheels are told from the joints of an arm that the same topic holds."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import werrimbi_odom as wo
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.bags.bag import BagMessage, opened_bag
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.robot_descriptions.urdf_wheels import of_urdf
from werrimbi_odom.files.robot_descriptions.wheel_joints import joints_told_apart, turned_joints

MS = 10**6
WHEELS = ("wheel_left_front", "wheel_left_back", "wheel_right_front", "wheel_right_back")
ARM = ("arm_1_link_joint", "gripper_left_link_joint", "gripper_right_link_joint", "rh_p12_rn")


def told(turned: Mapping[str, float]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    found = joints_told_apart(tuple(turned), turned)
    return found.left, found.right


def test_joints_of_an_arm_are_no_wheels() -> None:
    turned = dict.fromkeys(ARM, 0.5) | dict.fromkeys(WHEELS, 40.0)
    assert told(turned) == (WHEELS[:2], WHEELS[2:])


def test_fingers_are_no_wheels_where_wheels_are_called_otherwise() -> None:
    turned = {"gripper_left": 0.4, "gripper_right": 0.4, "drive_left": 30.0, "drive_right": 28.0}
    assert told(turned) == (("drive_left",), ("drive_right",))


def test_what_stays_within_a_turn_is_none_of_the_wheels_that_roll() -> None:
    """A joint of a name that says nothing: it stands while the wheels drive."""
    turned = {"left_a": 0.4, "right_a": 0.4, "left_b": 30.0, "right_b": 28.0}
    assert told(turned) == (("left_b",), ("right_b",))


def test_names_are_all_there_is_where_the_robot_hardly_moved() -> None:
    assert told({"left_wheel": 0.5, "right_wheel": 0.0}) == (("left_wheel",), ("right_wheel",))


@pytest.mark.parametrize("name", ["front_left_steering_wheel", "left_caster_wheel"])
def test_castors_and_steering_are_not_driven(name: str) -> None:
    turned = {name: 20.0, "left_wheel": 30.0, "right_wheel": 30.0}
    assert told(turned) == (("left_wheel",), ("right_wheel",))


@pytest.mark.parametrize(
    ("left", "right"),
    [
        (("wheel_f_l_joint", "wheel_r_l_joint"), ("wheel_f_r_joint", "wheel_r_r_joint")),
        (("wheel_l_f", "wheel_l_r"), ("wheel_r_f", "wheel_r_r")),
        (("left_wheel_f", "left_wheel_r"), ("right_wheel_f", "right_wheel_r")),
        (("fl_wheel", "rl_wheel"), ("fr_wheel", "rr_wheel")),
        (("l_wheel",), ("r_wheel",)),
        (("wheel_r_l",), ("wheel_r_r",)),
    ],
)
def test_r_may_be_rear_or_right(left: tuple[str, ...], right: tuple[str, ...]) -> None:
    """A rear left wheel is on one side alone."""
    assert told(dict.fromkeys((*left, *right), 40.0)) == (left, right)


def test_wheels_that_a_urdf_names_are_believed() -> None:
    turned = {"axis_1": 30.0, "axis_2": 30.0, "axis_3": 0.1}
    found = joints_told_apart(tuple(turned), turned, (("axis_2",), ("axis_1",)))
    assert (found.left, found.right, found.others) == (("axis_2",), ("axis_1",), ("axis_3",))


def test_without_names_those_that_roll_are_told() -> None:
    turned = {"axis_1": 30.0, "axis_2": 30.0, "axis_3": 0.1}
    assert joints_told_apart(tuple(turned), turned).rolled == ("axis_1", "axis_2")


def sent(ros: Any, n: int) -> list[tuple[str, int, Any]]:
    """An arm and wheels by nodes of their own, to one topic: the arm is the first to speak."""
    angle = 0.02 * n
    wrapped = math.remainder(2.0 * angle, 2.0 * math.pi)
    arm = ros.joints(n * MS, ARM, [0.1 * math.sin(0.01 * n)] * 4)
    wheels = ros.joints(n * MS + 5, WHEELS[1:3], [angle, wrapped])
    return [("/joint_states", n * MS, arm), ("/joint_states", n * MS + 5, wheels)]


def test_how_far_joints_turn_is_read_from_all_messages(tmp_path: Path, ros: Any) -> None:
    entries = [each for n in range(1, 1000) for each in sent(ros, n)]
    with opened_bag(ros.write(tmp_path / "bag", entries)) as bag:
        turned = turned_joints(bag, "/joint_states")
    assert list(turned) == [*ARM, *WHEELS[1:3]]
    assert turned[ARM[0]] == pytest.approx(0.2, rel=0.01)
    assert turned[WHEELS[1]] == pytest.approx(998 * 0.02)
    assert turned[WHEELS[2]] == pytest.approx(998 * 0.04)  # it begins anew at each turn


def test_speeds_alone_are_integrated(tmp_path: Path, ros: Any) -> None:
    entries = []
    for n in range(200):
        kind, message = ros.joints((1000 + 100 * n) * MS, WHEELS[1:3], [0.0, 0.0])
        message.velocity, message.position = np.array([1.0, 0.0]), np.zeros(0)
        entries.append(("/joint_states", n + 1, (kind, message)))
    with opened_bag(ros.write(tmp_path / "bag", entries)) as bag:
        assert turned_joints(bag, "/joint_states") == pytest.approx(
            {WHEELS[1]: 19.9, WHEELS[2]: 0.0}
        )


def test_info_says_that_speeds_are_integrated_where_angles_stay_at_zero(
    tmp_path: Path, ros: Any
) -> None:
    entries = []
    for n in range(400):
        kind, message = ros.joints((1000 + 50 * n) * MS, WHEELS[1:3], [0.0, 0.0])
        message.velocity = np.array([3.0, 4.0])
        entries.append(("/joint_states", n + 1, (kind, message)))
    said = " ".join(wo.info(ros.write(tmp_path / "bag", entries)).summary().split())
    assert "Wheels: /joint_states, speeds of the wheels, which are integrated" in said


def test_a_message_that_cannot_be_read_ends_the_look_and_raises_nothing() -> None:
    """Who reads the wheels afterwards tells of it, with topic and type."""

    class Spoilt:
        def messages(self, topics: list[str]) -> Iterator[Any]:
            stamp = SimpleNamespace(sec=1, nanosec=0)
            header = SimpleNamespace(stamp=stamp)
            for angle in (0.0, 9.0):
                content = SimpleNamespace(header=header, name=["a"], position=[angle], velocity=[])
                yield BagMessage("/joint_states", 1, content)
            raise InputError(f"a message of {topics[0]} cannot be read")

    assert turned_joints(Spoilt(), "/joint_states") == {"a": 9.0}  # type: ignore[arg-type]


def test_info_lists_wheels_and_says_what_is_none(tmp_path: Path, ros: Any) -> None:
    entries = [each for n in range(1, 1000) for each in sent(ros, n)]
    said = " ".join(wo.info(ros.write(tmp_path / "bag", entries)).summary().split())
    assert f"on the left {WHEELS[1]}, on the right {WHEELS[2]}." in said
    assert f"No wheels by their names: {', '.join(ARM[:2])} and {ARM[2]}." in said
    assert f"Not taken for wheels, as nothing says that they are: {ARM[3]}." in said


def test_a_topic_of_landmarks_is_not_taken_for_wheels(tmp_path: Path, ros: Any) -> None:
    """Some put other things into a JointState, and that topic comes first."""
    entries = []
    for n in range(1, 500):
        entries.append(("/a_landmark", n, ros.joints(n * MS, ["l1", "l2"], [1.0, 2.0])))
        entries.append(("/joints", n, ros.joints(n * MS, ["left_wheel", "right_wheel"], [n, n])))
    said = " ".join(wo.info(ros.write(tmp_path / "bag", entries)).summary().split())
    assert "Wheels: /joints, angles of the wheels" in said


@pytest.mark.parametrize(("speed", "told"), [(0.01, "/odom, the robot's own"), (0.0, "/joint_sta")])
def test_joints_that_never_turn_are_not_the_wheels_of_odometry_that_moves(
    tmp_path: Path, ros: Any, robot: Any, speed: float, told: str
) -> None:
    """A joint_state_publisher beside Gazebo's driver: all was "carried or turned by hand"."""
    names = ["left_wheel_joint", "right_wheel_joint"]
    entries = []
    for n in range(1, 100):
        entries.append(("/joint_states", 10 * n * MS, ros.joints(10 * n * MS, names, [0.0, 0.0])))
        entries.append(("/odom", 10 * n * MS, ros.odometry(10 * n * MS, speed * n, 0.0, 0.0)))
    bag = ros.write(tmp_path / "bag", entries)
    assert f"Wheels: {told}" in " ".join(wo.info(bag).summary().split())
    said = "the wheels never turn in it, as where a joint_state_publisher alone sends them"
    assert any(
        said in words and "--ticks-topic /odom" in words for words in read_run(bag, robot()).damage
    )
    assert not read_run(bag, robot(), ticks_topic="/odom").damage


ARM_JOINT = """<joint name="{name}" type="revolute">
<parent link="base_link"/><child link="{name}_l"/>
<origin xyz="0.1 {y} 0.2"/><axis xyz="0 1 0"/><limit lower="-1.5" upper="1.5"/></joint>
<link name="{name}_l"><collision><geometry>
<cylinder radius="0.5" length="1"/></geometry></collision></link>"""
WHEEL = """<joint name="{name}" type="continuous">
<parent link="base_link"/><child link="{name}_l"/>
<origin xyz="0 {y} 0"/><axis xyz="0 1 0"/></joint><link name="{name}_l"><collision><geometry>
<cylinder radius="0.1" length="0.1"/></geometry></collision></link>"""


def test_an_arm_in_a_urdf_moves_neither_base_nor_radius() -> None:
    """Its joints turn about the same axis as the wheels, but have stops."""
    parts = [ARM_JOINT.format(name=name, y=y) for name, y in (("a", 0.3), ("b", -0.2))]
    parts += [WHEEL.format(name=name, y=y) for name, y in (("left", 0.2), ("right", -0.2))]
    robot = of_urdf(f'<robot name="r"><link name="base_link"/>{"".join(parts)}</robot>')
    assert (robot.left, robot.right) == (("left",), ("right",))
    assert (robot.separation, robot.radius) == (0.4, 0.1)


@pytest.mark.parametrize("off", [0.0, 0.001, -0.02])
def test_a_wheel_in_the_middle_of_a_urdf_drives_neither_side(off: float) -> None:
    """A passive wheel that a drawing puts 1 mm off made a base of 0.3005 m of 0.4 m."""
    sides = (("left", 0.2), ("right", -0.2), ("rear_wheel", off))
    parts = [WHEEL.format(name=name, y=y) for name, y in sides]
    robot = of_urdf(f'<robot name="r"><link name="base_link"/>{"".join(parts)}</robot>')
    assert (robot.left, robot.right, robot.separation) == (("left",), ("right",), 0.4)


def test_an_array_of_more_than_two_values_is_not_called_an_unread_type(
    tmp_path: Path, ros: Any
) -> None:
    """The type is read, where two of its values are counters: it says so."""
    array = ros.counts(0, 0, 50, 52, bits=32)
    entries = [("/encoder_status", n, array) for n in range(1, 60)]
    said = " ".join(wo.info(ros.write(tmp_path / "bag", entries)).summary().split())
    assert "if two of its values count the wheels, --ticks-topic /encoder_status:0:1" in said
    assert "no type that is read" not in said


def test_two_counters_of_other_names_are_offered_as_the_wheels(tmp_path: Path, ros: Any) -> None:
    """As differential_drive calls them; they were told to be read where each wheel has a topic."""
    entries = [("/imu", n, ros.imu(10 * n * MS, 0.1)) for n in range(1, 60)]
    for n in range(1, 60):
        entries += [(f"/{side}wheel", n * MS, ros.count(n, 16)) for side in "lr"]
    bag = ros.write(tmp_path / "bag", entries)
    result = wo.info(bag)
    said = " ".join(result.summary().split())
    assert "--ticks-topic /lwheel,/rwheel reads them" in said
    assert "Record how the wheels turned" not in said
    assert result.to_dict()["next"] == f"werrimbi info {bag} --ticks-topic /lwheel,/rwheel"


def test_odometry_in_another_frame_is_offered_as_the_wheels(tmp_path: Path, ros: Any) -> None:
    """In the frame world it may be a sensor's; it was told to record at least the /odom."""
    entries = []
    for n in range(1, 800):
        kind, sent = ros.odometry(20 * n * MS, math.sin(0.01 * n), 1 - math.cos(0.01 * n), 0.01 * n)
        sent.header.frame_id = "world"
        entries.append(("/odom", 20 * n * MS, (kind, sent)))
        entries.append(("/imu", 20 * n * MS + 1, ros.imu(20 * n * MS, 0.5)))
    bag = ros.write(tmp_path / "bag", entries)
    result = wo.info(bag)
    assert result.to_dict()["next"] == f"werrimbi info {bag} --ticks-topic /odom"
    assert "Record how the wheels turned" not in result.summary()
    found = wo.info(bag, ticks_topic="/odom")
    said = " ".join(found.summary().split())
    assert "its yaw rate is integrated). It is taken." in said
    assert "Reference /odom" not in said


def test_without_wheels_it_says_what_lacks_and_what_is_not_read(tmp_path: Path, ros: Any) -> None:
    """Another reference would not help: no command is printed."""
    mode = ("std_msgs/msg/Bool", ros.make("std_msgs/msg/Bool", True))
    entries = []
    for n in range(1, 60):
        entries.append(("/ticks", n, ros.count(n)))
        entries.append(("/wheel_mode", n, mode))
        entries.append(("/imu", n, ros.imu(10 * n * MS, 0.1)))
        entries.append(("/mocap", n, ros.pose(10 * n * MS, 0.01 * n, 0.0, 0.0)))
    result = wo.info(ros.write(tmp_path / "bag", entries))
    said = " ".join(result.summary().split())
    assert "By name /ticks (std_msgs/msg/Int32) may, but such a type is read only where" in said
    assert "By name /wheel_mode (std_msgs/msg/Bool) may, but is of no type that is read." in said
    assert "Record how the wheels turned as well" in said
    assert result.to_dict()["next"] is None


@pytest.mark.parametrize(
    ("wheels", "further", "taken"),
    [
        ("/joint_states", "/base/odom", "/base/imu"),
        ("/joint_states", "/other/joint_states", None),
        ("/robot/joint_states", "/base/odom", None),
    ],
)
def test_a_driver_in_a_namespace_is_of_the_robot_whose_wheels_have_none(
    tmp_path: Path, ros: Any, wheels: str, further: str, taken: str | None
) -> None:
    """The driver's odometry and gyro were another robot's; asked for, any reference is taken."""
    space, entries = further.rpartition("/")[0], []
    for n in range(1, 250):
        stamp, angles = 20 * n * MS, (0.1 * n, 0.1 * n + 0.3 * math.sin(0.02 * n))
        moving = ros.joints(stamp, WHEELS[1:3], angles)
        other = ros.odometry(stamp, 0.1 * n, 0.0, 0.0) if "odom" in further else moving
        gyro = ros.imu(stamp, math.cos(0.02 * n))
        entries += [(wheels, stamp, moving), (further, stamp, other)]
        entries.append((f"{space}/imu", stamp, gyro))
    bag = ros.write(tmp_path / "bag", entries)
    for wish in (None, f"{space}/imu"):
        (run,) = wo.info(bag, reference_topic=wish, ticks_topic=wheels).to_dict()["runs"]
        found = [each["topic"] for each in run["references"] if each["taken"]]
        assert found == ([] if taken is None and wish is None else [f"{space}/imu"])
