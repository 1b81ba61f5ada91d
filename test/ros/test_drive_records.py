# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What drive_node records, and the command that it prints for the recording."""

from __future__ import annotations

import shlex
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("rclpy")

import rclpy
from rclpy.context import Context
from sensor_msgs.msg import JointState

from werrimbi_odom.ros.domain import free_domain
from werrimbi_odom.ros.drive_records import Records, _class_of

TOPICS = ("joint_states", "odom", "reference")


@pytest.fixture
def node() -> Iterator[Any]:
    """A node that knows of one topic, its own."""
    domain, lock = free_domain()
    context = Context()
    rclpy.init(context=context, args=[], domain_id=domain)
    made = rclpy.create_node("drive_node", namespace="r1", context=context)
    made.create_publisher(JointState, "joint_states", 1)
    yield made
    made.destroy_node()
    rclpy.shutdown(context=context)
    lock.close()


def test_the_command_can_be_pasted_and_names_what_the_bag_holds(node: Any, tmp_path: Path) -> None:
    file, folder = "my robots/r1.yaml", tmp_path / "my drives"
    records = Records(node, {"record": str(folder), "robot_file": file, "record_topics": TOPICS})
    records.begin("square")
    words = shlex.split(records.next_command())
    records.close()
    (bag,) = folder.iterdir()
    ticks = ["--ticks-topic", "/r1/joint_states"]
    assert words == ["werrimbi", "diagnose", "--robot", file, *ticks, str(bag)]


def test_a_start_that_is_refused_takes_no_name_from_the_next(node: Any, tmp_path: Path) -> None:
    """The next within a second did not start, since there was a bag of its name already."""
    records = Records(node, {"record": str(tmp_path), "robot_file": "", "record_topics": TOPICS})
    for _ in range(3):
        records.begin("square")
        records.close()
    assert len(list(tmp_path.iterdir())) == 3


def test_without_a_recording_it_has_the_names_to_record_under(node: Any) -> None:
    records = Records(node, {"record": "", "robot_file": "", "record_topics": TOPICS})
    assert records.next_command() == (
        "werrimbi diagnose --robot ROBOT.yaml --ticks-topic /r1/joint_states "
        "--reference-topic /r1/reference BAG"
    )


def test_a_type_that_is_not_installed_here_is_not_recorded() -> None:
    """As tf2_msgs beside a ROS from PyPI, where another computer broadcasts /tf."""
    assert _class_of("sensor_msgs/msg/JointState") is JointState
    assert _class_of("no_such_msgs/msg/Thing") is None
    assert _class_of("sensor_msgs/msg/NoSuchThing") is None
