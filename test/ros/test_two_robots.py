# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Two robots on one machine, in one ROS domain, started as their launch files start them."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("rclpy")

from nav_msgs.msg import Odometry
from rclpy.qos import ReliabilityPolicy, qos_profile_sensor_data
from sensor_msgs.msg import JointState

from test.package.launching import launched
from test.ros.messages import read_by_ros, stamp_at

ROOT = Path(__file__).parents[2]


@pytest.fixture
def fleet(launch: Any, robot: dict[str, Any], tmp_path: Path) -> Iterator[Any]:
    """The client of a node in the root namespace, and two robots beside it."""
    client = launch(robot)
    processes = []
    for name, radius in (("robot1", 0.05), ("robot2", 0.10)):
        own = robot | {"wheel_radius": radius, "odom_frame_id": f"{name}/odom"}
        reliability = {"robot1": "reliable", "robot2": "best_effort"}[name]
        own["qos_overrides"] = {f"/{name}/odom": {"publisher": {"reliability": reliability}}}
        file = tmp_path / f"{name}.yaml"
        file.write_text(json.dumps({"/**": {"ros__parameters": own}}), encoding="utf-8")
        for process in launched(ROOT, "odom.launch.xml", robot_file=str(file), namespace=name):
            command = [sys.executable, "-m", f"{process.package}.ros.{process.executable}"]
            processes.append(
                subprocess.Popen([*command, *process.arguments], env=client.environment)
            )
    yield client
    for process in processes:
        process.terminate()
    assert [process.wait(10.0) for process in processes] == [0, 0]


def test_each_robot_hears_its_own_wheels_and_tells_its_own_odometry(fleet: Any) -> None:
    kept: dict[str, list[Any]] = {"robot1": [], "robot2": []}
    for name, messages in kept.items():
        topic = f"/{name}/odom"
        fleet.node.create_subscription(Odometry, topic, messages.append, qos_profile_sensor_data)
    names = ["left_wheel_joint", "right_wheel_joint"]
    for row in range(200):
        for name in kept:
            counts = [20.0 * row, 10.0 * row] if name == "robot1" else [10.0 * row, 5.0 * row]
            message = JointState(name=names, position=counts)
            message.header.stamp = stamp_at(1000.0 + 0.02 * row)
            fleet.send(JointState, f"/{name}/joint_states", message)
        fleet.rest(0.02)
        if min(map(len, kept.values())) > 20:
            break
    last = {name: messages[-1] for name, messages in kept.items()}
    for name, message in last.items():
        assert message.header.frame_id == f"{name}/odom"
    speeds = [message.twist.twist.linear.x for message in last.values()]
    # Half the counts on wheels twice as large.
    assert speeds[0] == pytest.approx(speeds[1])
    assert speeds[0] > 0.1
    assert fleet.odometry == []  # the third one has heard no wheel
    names_said = {status.name for status in fleet.diagnostics}
    fleet.until(
        lambda: (
            {status.name for status in fleet.diagnostics}
            >= {"robot1/odom_node: wheel encoders", "robot2/odom_node: wheel encoders"}
        ),
        f"diagnostics that tell the robots apart, after {names_said}",
    )


def test_qos_overrides_reach_the_topic_in_its_namespace(fleet: Any) -> None:
    for name, policy in (
        ("robot1", ReliabilityPolicy.RELIABLE),
        ("robot2", ReliabilityPolicy.BEST_EFFORT),
    ):
        topic = f"/{name}/odom"
        fleet.until(lambda topic=topic: fleet.node.count_publishers(topic) == 1, topic)
        (publisher,) = fleet.node.get_publishers_info_by_topic(topic)
        assert publisher.qos_profile.reliability == policy


def test_the_filters_file_is_read_in_any_namespace() -> None:
    for namespace in ("", "/robot1", "/site/robot1"):
        _, ekf = launched(ROOT, "odom_ekf.launch.xml", namespace=namespace)
        where, read = read_by_ros("ekf_filter_node", list(ekf.arguments))
        assert where == (namespace or "/")
        assert read["odom0"] == "odom"
        assert len(read["process_noise_covariance"]) == 225
