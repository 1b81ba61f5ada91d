# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Sizes and counts of a first robot file: of a URDF, of a controller, of the angles' own steps."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import werrimbi_odom as wo
from test.files.unseen import JOINTS, urdf
from test.model.drives import ROBOT
from werrimbi_odom.files.robot_descriptions.controller_wheels import of_controller
from werrimbi_odom.files.robot_descriptions.first_robot import with_steps
from werrimbi_odom.files.robot_descriptions.urdf_wheels import of_urdf


@pytest.mark.parametrize("yaw", [0.0, 0.3])
def test_sizes_of_a_urdf(yaw: float) -> None:
    found = of_urdf(urdf(yaw), JOINTS)
    if yaw:  # a chassis that is mounted askew: its wheels do not roll along the robot's axis
        assert found.separation == pytest.approx(ROBOT.wheel_separation * math.cos(yaw), rel=1e-3)
        return
    assert (found.separation, found.radius) == (ROBOT.wheel_separation, ROBOT.wheel_radius)
    assert (found.left, found.right) == ((JOINTS[0],), (JOINTS[1],))
    assert not of_urdf(urdf(), ["arm_joint"]).has_sizes


@pytest.mark.parametrize(
    "text", ["", "<robot", "<robot/>", "<!DOCTYPE x [<!ENTITY a 'b'>]><robot/>"]
)
def test_what_is_no_urdf_says_nothing(text: str) -> None:
    assert not of_urdf(text).has_sizes


def test_a_negative_multiplier_of_a_controller_is_a_reversed_wheel(tmp_path: Path) -> None:
    """So diff_drive_controller takes it; a robot file says it with an effect."""
    parameters = tmp_path / "controllers.yaml"
    parameters.write_text(
        "diff_drive_controller:\n  ros__parameters:\n    wheel_separation: 1.9\n"
        "    wheel_radius: 0.3\n    left_wheel_radius_multiplier: 1.01\n"
        "    right_wheel_radius_multiplier: -1.0\n"
    )
    out = tmp_path / "robot.yaml"
    out.write_text(of_controller(parameters).text("first"))
    robot = wo.read_robot(out).robot
    assert [each.name for each in robot.effects] == ["right_wheel_reversed"]
    assert robot.left_wheel_radius_multiplier == 1.01
    assert robot.right_wheel_radius_multiplier == 1.0


OF_ROS_1 = """jackal_velocity_controller:
  type: "diff_drive_controller/DiffDriveController"
  left_wheel: [motor_1, motor_3]
  right_wheel: motor_2
  wheel_separation: 0.4
  wheel_radius: 0.098
  wheel_separation_multiplier: 1.5
  wheel_radius_multiplier: 0.98
"""


def test_a_controllers_file_of_ros_1_is_read_by_its_names(tmp_path: Path) -> None:
    """Its multiplier was dropped without a word, and its joints were not looked at."""
    path = tmp_path / "jackal.yaml"
    path.write_text(OF_ROS_1)
    found = of_controller(path)
    assert (found.left, found.right) == (("motor_1", "motor_3"), ("motor_2",))
    assert found.more == {
        "wheel_separation_multiplier": 1.5,
        "left_wheel_radius_multiplier": 0.98,
        "right_wheel_radius_multiplier": 0.98,
    }


@pytest.mark.parametrize("value", ["true", ".inf", ".nan", "-0.1", "1 cm"])
def test_a_size_of_a_controller_is_a_number(tmp_path: Path, value: str) -> None:
    path = tmp_path / "jackal.yaml"
    path.write_text(OF_ROS_1.replace("0.098", value))
    with pytest.raises(wo.InputError, match=r"jackal\.yaml: wheel_radius must be a number greater"):
        of_controller(path)
    path.write_text(OF_ROS_1.replace("0.98", value))
    if value == "-0.1":
        assert of_controller(path).reversed == ("left", "right")
        return
    with pytest.raises(wo.InputError, match=r"jackal\.yaml: wheel_radius_multiplier must be a num"):
        of_controller(path)


def test_names_that_the_bag_told_are_not_said_to_be_of_the_file(tmp_path: Path, ros: Any) -> None:
    path, joints = tmp_path / "sizes.yaml", ["left_wheel", "right_wheel"]
    entries = [
        ("/joint_states", n * 10**8, ros.joints(n * 10**8, joints, [0.1 * n, 0.2 * n]))
        for n in range(1, 100)
    ]
    bag = ros.write(tmp_path / "bag", entries)
    for names, told in (
        ("[a, b]", "the bag's joints, by their names"),
        (str(joints[:1]), "of sizes"),
    ):
        path.write_text(
            f"c:\n  wheel_separation: 0.4\n  wheel_radius: 0.1\n  left_wheel_names: {names}\n"
            "  right_wheel_names: [right_wheel]\n"
        )
        out = tmp_path / "robot.yaml"
        wo.info(bag, robot=path, out=out, force=True)
        line = next(each for each in out.read_text().splitlines() if "left_wheel_names" in each)
        assert line.split("#")[0].split() == ["left_wheel_names:", '["left_wheel"]']
        assert told in line


def test_a_date_that_is_none_is_told_with_the_file(tmp_path: Path) -> None:
    path = tmp_path / "controllers.yaml"
    path.write_text("diff_drive_controller:\n  ros__parameters:\n    built: 2024-13-45\n")
    with pytest.raises(wo.InputError, match=r"controllers\.yaml cannot be read: month must be in"):
        of_controller(path)


def test_a_file_without_wheels_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "other.yaml"
    path.write_text("amcl:\n  ros__parameters:\n    max_particles: 2000\n")
    with pytest.raises(wo.InputError, match="wheel_separation and wheel_radius"):
        of_controller(path)


@pytest.mark.parametrize("ticks", [512, 4096, 20000])
def test_steps_of_the_angles_tell_the_counts_of_a_turn(ticks: int) -> None:
    counts = np.cumsum(np.random.default_rng(1).integers(3, 60, 400))
    first = of_urdf(urdf())
    found = with_steps(first, [2.0 * math.pi * counts / ticks] * 2)
    assert found.ticks == ticks
    smooth = np.cumsum(np.random.default_rng(1).uniform(0.01, 0.1, 400))
    assert with_steps(first, [smooth, smooth]).ticks is None


def test_the_speeds_of_a_simulator_are_no_counts() -> None:
    """Without inertia a robot holds three speeds, and turns the same in each message."""
    steps = np.repeat([0.0, 0.135191, 0.0, 0.045064, 0.228225, 0.0], [80, 90, 30, 20, 60, 70])
    angles = np.cumsum(steps)
    assert with_steps(of_urdf(urdf()), [angles, angles]).ticks is None


def test_coarse_counts_at_one_speed_are_counts() -> None:
    """Twenty counts a turn: none or one in a message, as it comes."""
    counts = np.floor(np.arange(0.0, 100.0, 0.3))
    found = with_steps(of_urdf(urdf()), [2.0 * math.pi * counts / 20.0] * 2)
    assert found.ticks == 20.0
