# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A live diagnosis that cannot begin: the comparison goes on, and says so."""

from __future__ import annotations

import pickle
import tempfile
from functools import partial
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("rclpy")

import rclpy
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseStamped
from rclpy.context import Context

from test.robot_file import BARE
from werrimbi_odom.model.motion import BodyMotion
from werrimbi_odom.ros.compare_parameters import PARAMETERS
from werrimbi_odom.ros.domain import free_domain
from werrimbi_odom.ros.live_diagnosis import Watching
from werrimbi_odom.ros.recent_messages import LINGER, MOST_BYTES, RESTING, Kept
from werrimbi_odom.ros.topics import subscribe


def test_without_room_for_its_files_the_node_goes_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "robot.yaml"
    file.write_text(BARE)
    values: dict[str, Any] = {item.name: item.default for item in PARAMETERS}
    values |= {"robot_file": str(file), "diagnose_every": 0.1}
    domain, lock = free_domain()
    context = Context()
    rclpy.init(context=context, args=[], domain_id=domain)
    node = rclpy.create_node("compare_node", context=context)
    watching = Watching(node, values, PoseStamped, partial(subscribe, node))
    for number in range(20):
        watching.odometry(0.5 * number, BodyMotion(0.3, 0.0, 0.0))
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "full"))
    (status,) = watching.look()
    assert status.level == DiagnosticStatus.WARN
    assert "the diagnosis cannot begin" in status.message
    assert str(tmp_path / "full") in status.message
    node.destroy_node()
    rclpy.shutdown(context=context)
    lock.close()


def test_a_message_larger_than_the_memory_is_not_kept_and_the_node_goes_on(tmp_path: Path) -> None:
    kept = Kept([("/joint_states", "sensor_msgs/msg/JointState")], 60.0)
    kept.take(0, 10**9, bytes(MOST_BYTES))
    kept.take(0, 2 * 10**9, b"small")
    kept.write(tmp_path / "messages")
    _, messages = pickle.loads((tmp_path / "messages").read_bytes())
    assert [data for _, _, data in messages] == [b"small"]


def test_what_is_driven_in_a_bag_played_fast_is_kept_where_the_odometry_is_behind(
    tmp_path: Path,
) -> None:
    """Ten seconds each second: a rest of two is over long before the odometry tells of it."""
    kept = Kept([("/joint_states", "sensor_msgs/msg/JointState")], 60.0)
    kept.motion(10**9, 100.0, 0.3, 0.0)
    for late in range(5):  # twists at rest, the last that have come
        kept.motion(10**9 + 5 * 10**6, 100.5 + 0.5 * late, 0.0, 0.0)
    fast = range(10**9, 2 * 10**9, 10**7)
    for received in fast:
        kept.take(0, received, b"drives")
    kept.write(tmp_path / "messages")
    assert len(pickle.loads((tmp_path / "messages").read_bytes())[1]) == len(fast)


def test_a_parked_robot_is_kept_thinly(tmp_path: Path) -> None:
    kept = Kept([("/joint_states", "sensor_msgs/msg/JointState")], 60.0)
    for received in range(10**9, 61 * 10**9, 10**7):
        kept.motion(received, 1e-9 * received, 0.0, 0.0)
        kept.take(0, received, b"parked")
    kept.write(tmp_path / "messages")
    rows = len(pickle.loads((tmp_path / "messages").read_bytes())[1])
    assert rows == pytest.approx(100 * LINGER + (60.0 - LINGER) / RESTING, abs=5.0)
