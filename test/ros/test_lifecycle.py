# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Starting and ending the node, names, clocks, and the transform."""

from __future__ import annotations

import math
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from test.evidence import in_evidence

pytest.importorskip("rclpy")

from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import Int64MultiArray

from test.ros.beside import stand_in_for_tf2_ros

Robot = dict[str, Any]
Launch = Callable[..., Any]


@pytest.mark.parametrize("name", ["SIGINT", in_evidence("SIGTERM")])
def test_a_signal_ends_it_well_in_the_midst_of_work(
    launch: Launch, robot: Robot, name: str
) -> None:
    node = launch(robot).begin()
    end = time.monotonic() + 0.3
    while time.monotonic() < end:
        node.step(10, 5)
    node.process.send_signal(getattr(signal, name))
    for _ in range(100):
        node.step(10, 5)
    assert node.stop(getattr(signal, name)) == 0, "also when it is told twice"
    assert "Traceback" not in node.stderr()


@pytest.mark.parametrize("name", [in_evidence("SIGINT"), "SIGTERM"])
def test_a_signal_ends_it_well_while_it_starts(
    start_node: Callable[..., subprocess.Popen[str]], robot: Robot, name: str
) -> None:
    """Once its handlers stand, which is before the node does; until then Python's own act."""
    for delay in (0.0, 0.03, 0.1):
        process = start_node(robot)
        log = Path(f"/proc/{process.pid}/status")
        end = time.monotonic() + 10.0
        while not _handles(log, getattr(signal, name)) and time.monotonic() < end:
            time.sleep(0.002)
        time.sleep(delay)
        process.send_signal(getattr(signal, name))
        _, errors = process.communicate(timeout=10.0)
        assert process.returncode == 0, errors
        assert "Traceback" not in errors


def _handles(status: Path, number: int) -> bool:
    """Whether rclpy has put its handlers for SIGINT and SIGTERM in place."""
    caught = next(line for line in status.read_text().splitlines() if line.startswith("SigCgt"))
    mask = int(caught.split()[1], 16)
    return all(mask >> (wanted - 1) & 1 for wanted in (signal.SIGINT, signal.SIGTERM, number))


def test_namespace_names_and_remapping(launch: Launch, robot: Robot) -> None:
    overrides = {"qos_overrides": {"/kangaroo/wheels": robot["qos_overrides"]["/joint_states"]}}
    arguments = [
        *("-r", "__ns:=/kangaroo"),
        *("-r", "__node:=legs"),
        *("-r", "joint_states:=wheels"),
        *("-r", "odom:=/wheel_odom"),
    ]
    frames = {"odom_frame_id": "k/odom", "base_frame_id": "k/base"}
    node = launch(robot | overrides | frames, *arguments)
    odometry = node.keep(Odometry, "/wheel_odom")
    names = ["left_wheel_joint", "right_wheel_joint"]
    message = JointState(name=names, position=[0.0, 0.0])
    for second in range(1, 1000):
        message.header.stamp.sec = second
        node.send(JointState, "/kangaroo/wheels", message)
        node.rest(0.05)
        if odometry and any(status.level == b"\x00" for status in node.diagnostics):
            break
    assert (odometry[0].header.frame_id, odometry[0].child_frame_id) == ("k/odom", "k/base")
    assert node.diagnostics[-1].name == "kangaroo/legs: wheel encoders"
    services = [name for name, _ in node.node.get_service_names_and_types()]
    assert "/kangaroo/legs/reset" in services
    assert node.node.count_publishers("/kangaroo/legs/status") == 1
    assert node.node.count_publishers("/kangaroo/legs/pieces") == 1


def test_simulated_time_stamps_what_has_no_stamp(launch: Launch, robot: Robot) -> None:
    node = launch(robot | {"input_type": "int64_multi_array", "use_sim_time": True})
    clock = Clock()
    clock.clock.sec = 5000

    def send() -> None:
        clock.clock.nanosec += 10_000_000
        node.send(Clock, "/clock", clock)
        node.rest(0.05)
        node.send(Int64MultiArray, "ticks", Int64MultiArray(data=[0, 0]))

    node.begin(send)
    assert node.odometry[0].header.stamp.sec == 5000
    node.report()  # /diagnostics goes on though simulated time stands still
    node.report()


def test_the_transform_goes_out_where_tf2_ros_is(
    launch: Launch, robot: Robot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With a stand-in for tf2_ros, which has no wheel: it publishes what it is told to send."""
    stand_in_for_tf2_ros(tmp_path, monkeypatch)
    node = launch(robot | {"enable_odom_tf": True})
    sent = node.keep(TransformStamped, "sent")
    node.begin()
    message = node.drive([(-200, 100), (100, 50)])
    node.until(lambda: bool(sent) and sent[-1].header == message.header, "transform")
    assert sent[-1].child_frame_id == "base_link"
    translation, position = sent[-1].transform.translation, message.pose.pose.position
    assert (translation.x, translation.y, translation.z) == (position.x, position.y, 0.0)
    assert sent[-1].transform.rotation == message.pose.pose.orientation
    assert not math.isclose(position.x, 0.0)


@pytest.mark.parametrize("node", ["odom_node", in_evidence("compare_node")])
def test_what_is_no_argument_of_ros_is_told(node: str) -> None:
    """Where rclpy leaves it unread: a parameter file that nobody reads costs an afternoon."""

    def run(*words: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", f"werrimbi_odom.ros.{node}", *words]
        return subprocess.run(command, capture_output=True, text=True, check=False, timeout=30.0)

    asked = run("--help")
    assert asked.returncode == 0, asked.stderr
    assert asked.stdout.startswith(f"{node} --ros-args [--params-file FILE.yaml]")
    assert not asked.stderr
    lost = run("--params-file", "robot.yaml")
    assert lost.returncode == 2
    assert lost.stderr.startswith(
        f"{node}: --params-file is unknown, or must come after --ros-args: {node} --ros-args"
    )
    assert lost.stderr.count("\n") == 1
