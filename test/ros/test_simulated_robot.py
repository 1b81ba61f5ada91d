# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The engine's robot, odom_node and drive_node over DDS: round a square, recorded, and back."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("rclpy")
pytest.importorskip("mujoco", reason="needs mujoco (pip install werrimbi_odom[all])")

from geometry_msgs.msg import PoseStamped, Twist
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Imu
from std_srvs.srv import Trigger

from test.ros.beside import beside
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.robot_file import read_robot_file
from werrimbi_odom.ros.simulated_parameters import PARAMETERS
from werrimbi_odom.ros.simulated_robot import _robot_of

ROBOT = {
    "wheel_separation": 0.35,
    "wheel_radius": 0.05,
    "left_ticks_per_revolution": 2000.0,
    "right_ticks_per_revolution": 2000.0,
}
PATIENT = {"odom_timeout": 1.0, "max_deviation": 0.5}
"""On a machine that does other things beside."""


def drive_state(client: Any) -> str:
    told = [each.message for each in client.diagnostics if each.name == "drive_node: drive"]
    return str(told[-1]) if told else ""


def driven_round(client: Any) -> None:
    """Ask drive_node to start, and wait for the end."""

    def ask(service: str) -> Any:
        return client.call(Trigger, f"drive_node/{service}", Trigger.Request())

    client.until(lambda: ask("check").success, "robot that could start", 30.0)
    answer = ask("start")
    assert answer.success, answer.message
    client.until(lambda: drive_state(client).startswith(("done", "stopped")), "end", 120.0)
    assert drive_state(client).startswith("done"), drive_state(client)


def test_a_square_ends_where_it_began_and_its_recording_can_be_read(
    launch: Any, tmp_path: Path
) -> None:
    client = launch(ROBOT)
    about = {"manoeuvre": "umbmark_ccw", "length": 0.3, "area_radius": 1.2, "record": tmp_path}
    quick = {"max_vel_x": 0.8, "max_vel_theta": 3.0, "acc_lim_x": 2.5, "acc_lim_theta": 8.0}
    file = tmp_path / "robot.yaml"
    with (
        beside(tmp_path, client.environment, "simulated_robot", robot_file=file),
        beside(tmp_path, client.environment, "drive_node", **about, **quick, **PATIENT) as drive,
    ):
        measured = client.keep(PoseStamped, "reference")
        driven_round(client)
        client.rest(0.8)
        place = client.odometry[-1].pose.pose.position
        true = measured[-1].pose.position
        assert "Next: werrimbi diagnose" in drive.said()
    assert math.hypot(place.x, place.y) < 0.02
    assert math.hypot(true.x, true.y) < 0.03
    assert max(abs(each.pose.position.y) for each in measured) > 0.25  # it was there
    robot_file = read_robot_file(file)
    assert robot_file.robot.wheel_separation == 0.35
