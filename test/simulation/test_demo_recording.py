# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The shipped recording is what its command makes, and bag and folder tell the same drive."""

from __future__ import annotations

import math
from pathlib import Path
from runpy import run_path

import numpy as np
import pytest
from rosbags.highlevel import AnyReader
from ruamel.yaml import YAML

import werrimbi_odom
from werrimbi_odom.simulation import Nominal, TrueRobot, record, spin, write_robot_file
from werrimbi_odom.simulation.bag import EPOCH, write_bag

SHIPPED = Path(werrimbi_odom.__file__).parent / "recordings"
MADE = run_path(str(Path(__file__).parents[2] / "docs" / "make_demo_recording.py"))
ROBOT, demo_recording = MADE["ROBOT"], MADE["demo_recording"]


def table(path: Path) -> np.ndarray:
    return np.loadtxt(path, delimiter=",", skiprows=1)


def test_the_shipped_run_is_what_its_command_makes() -> None:
    """To a tick and a hundredth of a millimetre: other processors round otherwise."""
    made = demo_recording()
    ticks = table(SHIPPED / "square" / "ticks.csv")
    np.testing.assert_allclose(ticks[:, 0], made.t_s, atol=1e-6)
    assert np.abs(ticks[:, 1] - made.left_ticks).max() <= 1
    assert np.abs(ticks[:, 2] - made.right_ticks).max() <= 1
    reference = table(SHIPPED / "square" / "reference.csv")
    np.testing.assert_allclose(reference[:, 0], made.reference_t_s, atol=1e-6)
    np.testing.assert_allclose(reference[:, 1], made.reference_x_m, atol=1e-5)
    np.testing.assert_allclose(reference[:, 2], made.reference_y_m, atol=1e-5)
    turned = np.exp(1j * (reference[:, 3] - made.reference_yaw_rad))
    np.testing.assert_allclose(turned, 1.0, atol=1e-5)


def test_bag_and_folder_tell_the_same_drive() -> None:
    wheels: list[tuple[float, ...]] = []
    poses: list[tuple[float, ...]] = []
    with AnyReader([SHIPPED / "square_bag"]) as reader:
        for connection, _, data in reader.messages():
            message = reader.deserialize(data, connection.msgtype)
            t = message.header.stamp.sec - EPOCH + message.header.stamp.nanosec * 1e-9
            if connection.topic == "/joint_states":
                assert message.name == ["left_wheel_joint", "right_wheel_joint"]
                wheels.append((t, *message.position))
            else:
                assert connection.topic == "/reference"
                turn = message.pose.orientation
                yaw = 2 * math.atan2(turn.z, turn.w)
                poses.append((t, message.pose.position.x, message.pose.position.y, yaw))
    ticks = table(SHIPPED / "square" / "ticks.csv")
    per_radian = 2000.0 / (2 * math.pi)
    np.testing.assert_allclose(np.array(wheels)[:, 0], ticks[:, 0], atol=1e-6)
    np.testing.assert_allclose(np.array(wheels)[:, 1:] * per_radian, ticks[:, 1:], atol=1e-6)
    reference = table(SHIPPED / "square" / "reference.csv")
    np.testing.assert_allclose(np.array(poses)[:, :3], reference[:, :3], atol=2e-6)
    assert np.abs(np.exp(1j * (np.array(poses)[:, 3] - reference[:, 3])) - 1).max() < 2e-6


def test_the_shipped_files_are_small() -> None:
    assert sum(f.stat().st_size for f in SHIPPED.rglob("*") if f.is_file()) < 1_500_000


def test_a_bag_is_not_written_over(tmp_path: Path) -> None:
    recording = record(TrueRobot(), spin(0.1), seed=1)
    write_bag(recording, TrueRobot(), tmp_path / "bag")
    with pytest.raises(Exception, match="exists"):
        write_bag(recording, TrueRobot(), tmp_path / "bag")


def test_the_robot_file_says_what_is_believed_and_hides_what_is_true(tmp_path: Path) -> None:
    robot = TrueRobot(
        wheel_separation=0.36,
        left_wheel_radius=0.051,
        left_ticks_per_revolution=500.0,
        left_wheel_noise=1e-5,
        nominal=Nominal(wheel_separation=1.0, wheel_radius=0.05),
    )
    text = write_robot_file(robot, tmp_path / "robot.yaml").read_text(encoding="utf-8")
    says = YAML(typ="safe").load(text)["odom_node"]["ros__parameters"]
    assert says["wheel_separation"] == 1.0
    assert isinstance(says["wheel_separation"], float), "ROS refuses an integer here"
    assert says["wheel_radius"] == 0.05
    assert says["left_wheel_radius_multiplier"] == 1.0
    assert says["left_ticks_per_revolution"] == 500.0
    assert says["left_wheel_noise"] == 1e-5
    assert "1.0e-05" in text, "without its point, older YAML readers take 1e-05 for a word"


def test_the_shipped_robot_file_belongs_to_the_shipped_run() -> None:
    text = (SHIPPED / "square" / "robot.yaml").read_text(encoding="utf-8")
    says = YAML(typ="safe").load(text)["odom_node"]["ros__parameters"]
    assert says["wheel_separation"] == ROBOT.wheel_separation
    assert says["right_wheel_noise"] == ROBOT.right_wheel_noise
