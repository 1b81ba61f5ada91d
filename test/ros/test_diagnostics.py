# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""/diagnostics is OK only while odometry comes, of one robot's counters, from one node."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import pytest

from test.evidence import in_evidence

pytest.importorskip("rclpy")

from diagnostic_msgs.msg import DiagnosticStatus
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState
from std_msgs.msg import Int64

NAMES = ["left_wheel_joint", "right_wheel_joint"]
SEVERAL = "several publish /joint_states ("


def level_and_words(node: Any, send: Callable[[], None], until: str = "") -> tuple[bytes, str]:
    """What /diagnostics says while messages are sent all the time: once it says `until`, if so."""
    before, end = len(node.diagnostics), time.monotonic() + 40.0
    while len(node.diagnostics) < before + 2 or until not in node.diagnostics[-1].message:
        assert time.monotonic() < end, f"{until!r} never came: {node.diagnostics[-1].message}"
        send()
        node.rest(0.02)
    return node.diagnostics[-1].level, node.diagnostics[-1].message


@pytest.mark.parametrize(
    ("more", "says"),
    [
        in_evidence({}, "duplicates ("),
        ({"late": 0.5}, "out of order ("),
        in_evidence({"max_wheel_speed": 1e-6}, "implausible ("),
    ],
    ids=["frozen_stamp", "all_late", "too_slow"],
)
def test_messages_of_which_no_odometry_comes_are_an_error(
    launch: Any, robot: dict[str, Any], more: dict[str, float], says: str
) -> None:
    late = more.get("late", 0.0)
    node = launch(robot | {key: value for key, value in more.items() if key != "late"}).begin()
    frozen = node.now - late

    def send() -> None:
        if "max_wheel_speed" in more:
            node.step(20, 10)
        else:
            node.ticks(node.left + 20, node.right + 10, frozen)

    level, words = level_and_words(node, send)
    assert level == DiagnosticStatus.ERROR
    assert words.startswith("no odometry, all input is refused: ")
    assert says in words
    assert "no odometry" in node.stderr()


def test_counts_that_never_meet_are_an_error(launch: Any, robot: dict[str, Any]) -> None:
    node = launch(robot | {"input_type": "int64_pair", "pairing_window": 1e-9})
    for topic in ("left_ticks", "right_ticks"):
        node.publisher(Int64, topic)

    def send() -> None:
        for topic in ("left_ticks", "right_ticks"):
            node.send(Int64, topic, Int64(data=1))
            node.rest(0.005)

    level, words = level_and_words(node, send)
    assert level == DiagnosticStatus.ERROR
    assert "unpaired (" in words
    assert "pairing_window" in words


def test_a_named_topic_that_nobody_publishes_is_a_warning(
    launch: Any, robot: dict[str, Any]
) -> None:
    """A misspelt gyro would leave the covariance as it is when wheels slip."""
    eccentric = {"effects": ["eccentric_left_wheel"], "eccentric_left_wheel": {"amplitude": 0.001}}
    node = launch(robot | eccentric | {"slip_imu_topic": "im", "learn_from_topic": "pose"}).begin()
    level, words = level_and_words(node, lambda: node.step(20, 10))
    assert level == DiagnosticStatus.WARN
    assert "no gyro heard on im (slip_imu_topic): wheels that slip go unseen" in words
    assert "nothing heard on pose (learn_from_topic): no phase is learnt" in words


def test_the_first_reading_is_no_error(launch: Any, robot: dict[str, Any]) -> None:
    node = launch(robot)
    node.publisher(JointState, "joint_states")
    node.rest(0.5)
    node.step(0, 0)
    level, words, values = node.report()
    assert values["messages"] == "1"
    assert level == DiagnosticStatus.OK, words


def test_what_the_node_cannot_keep_up_with_is_counted(launch: Any, robot: dict[str, Any]) -> None:
    """DDS drops the oldest of what waits, and reports none of it as lost."""
    del robot["qos_overrides"]
    node = launch(robot)
    flood = node.node.create_publisher(
        JointState, "joint_states", QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
    )
    node.until(lambda: flood.get_subscription_count() > 0, "subscriber")
    node.rest(0.3)
    sent = 3000
    message = JointState(name=NAMES, position=[0.0, 0.0])
    for count in range(sent):
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(
            10**9 + count * 10**6, 10**9
        )
        message.position = [float(count), float(count)]
        flood.publish(message)
        if count == 0:
            node.rest(0.3)  # what is before the first that is taken nobody misses
    messages = missed = 0
    for _ in range(4):  # the last that were sent may be among those never taken: nobody tells
        flood.publish(message)
        values = node.report()[2]
        messages, missed = int(values["messages"]), int(values["never taken"])
        if messages + missed >= sent:
            break
    assert messages < 0.9 * sent, "this machine keeps up; send more"
    assert messages + missed in range(sent, sent + 5)
    warned = [s for s in node.diagnostics if "never taken (" in s.message]
    assert warned
    assert warned[0].level == DiagnosticStatus.WARN


def test_two_drivers_and_two_nodes_of_one_name_are_told(launch: Any, robot: dict[str, Any]) -> None:
    import rclpy

    node = launch(robot).begin()
    other = node.node.create_publisher(JointState, "joint_states", 10)
    namesake = rclpy.create_node("odom_node", context=node.context)
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(namesake)
    try:
        told = "2 nodes are named /odom_node, and each publishes"
        level, words = level_and_words(node, lambda: node.step(20, 10), told)
        assert level == DiagnosticStatus.WARN
        level, words = level_and_words(node, lambda: node.step(20, 10), SEVERAL)
        assert level == DiagnosticStatus.WARN
        assert words.count(f"/{node.node.get_name()}") == 2
    finally:
        executor.shutdown()
        namesake.destroy_node()
    # An arm's driver on the same topic is none of ours.
    arm = JointState(name=["elbow"], position=[0.1])

    def with_the_arms() -> None:
        other.publish(arm)
        node.step(20, 10)

    level_and_words(node, with_the_arms)
    level, words = level_and_words(node, with_the_arms)
    assert level == DiagnosticStatus.OK, words
    node.node.destroy_publisher(other)
    level_and_words(node, lambda: node.step(20, 10))
    level, words = level_and_words(node, lambda: node.step(20, 10))
    assert level == DiagnosticStatus.OK, words
