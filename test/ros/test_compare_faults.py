# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""compare_node is OK only while it compares, and no message of anybody's ends it."""

from __future__ import annotations

import math
from collections import Counter
from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

pytest.importorskip("rclpy")

from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from nav_msgs.msg import Odometry
from rclpy.qos import QoSProfile

from test.ros.messages import stamp_at, values_of
from test.ros.test_compare_node import DEEP, pose_stamped, robot_file
from test.ros.test_compare_node import compare as compare  # a fixture
from werrimbi_odom.ros.compare_node import CompareNode

NUMBER = st.floats() | st.sampled_from(
    [0.0, 1.0, 1e308, 1.6e308, -1e308, 5e-324, math.nan, math.inf, -1.0]
)
SECONDS = st.integers(-(2**31), 2**31 - 1) | st.integers(100, 110)
NANOSECONDS = st.integers(0, 10**9 - 1) | st.integers(0, 2**32 - 1)


def test_a_clock_that_is_set_while_it_compares_is_told(launch: Any, compare: Any) -> None:
    node = launch(robot_file()).begin()
    comparing = compare(node)

    def both(seconds: float, ahead: float) -> None:
        node.publisher(PoseStamped, "reference")
        for _ in range(round(seconds / 0.05)):
            node.step(10, 10)
            node.send(PoseStamped, "reference", pose_stamped(node.now - 1000.0 + ahead, 0, 0, 0))
            node.rest(0.05)

    for _ in range(20):
        both(2.0, 0.0)
        before = values_of(comparing.verdict())
        if int(before.get("compared", 0)) > 10:
            break
    assert int(before["compared"]) > 10
    assert comparing.said[-1].level == DiagnosticStatus.OK
    for _ in range(20):
        both(1.0, 1000.0)
        if comparing.said[-1].message.startswith("no stamp"):
            break
    status = comparing.said[-1]
    assert status.level == DiagnosticStatus.WARN
    assert status.message.startswith("no stamp of the reference falls between two of the odometry")
    assert "+1000." in status.message
    assert values_of(status)["waiting"] != "0"
    comparing.stop()


def odometry(second: int, variance: float) -> Odometry:
    message = Odometry()
    message.header.stamp = stamp_at(second)
    message.pose.pose.position.x = 0.5 * second
    message.twist.twist.linear.x = 0.5
    message.pose.pose.orientation.w = 1.0
    for place in (0, 7, 35):
        message.pose.covariance[place] = variance
    return message


def stated(second: int) -> PoseWithCovarianceStamped:
    message = PoseWithCovarianceStamped()
    message.header.stamp = stamp_at(second)
    message.pose.pose.orientation.w = 1.0
    return message


class Talk:
    """Publishers in the place of an odometry and a reference."""

    def __init__(self, launched: Any) -> None:
        self.launched = launched
        deep = QoSProfile(depth=10_000)
        node = launched.node
        self.wheels = node.create_publisher(Odometry, "wheels", deep)
        self.laser = node.create_publisher(PoseWithCovarianceStamped, "laser", deep)
        launched.until(
            lambda: self.wheels.get_subscription_count() and self.laser.get_subscription_count(),
            "compare_node",
        )
        launched.rest(0.3)
        self.sent = {"odom": 0, "reference": 0}

    def send(self, message: Any) -> None:
        of_wheels = isinstance(message, Odometry)
        self.sent["odom" if of_wheels else "reference"] += 1
        (self.wheels if of_wheels else self.laser).publish(message)


@pytest.fixture
def talk(launch: Any, compare: Any, robot: dict[str, Any]) -> Any:
    comparing = compare(
        launch(robot),
        *("-r", "odom:=wheels", "-r", "reference:=laser"),
        reference_type="pose_with_covariance_stamped",
        leg=0.1,
        qos_overrides={"/wheels": DEEP, "/laser": DEEP},
    )
    return comparing, Talk(comparing.launched)


def counts(comparing: Any) -> dict[str, int]:
    told = values_of(comparing.verdict())
    return {key: int(value) for key, value in told.items() if value.isdigit()}


def test_a_covariance_that_stands_for_unknown_is_refused(talk: Any) -> None:
    comparing, out = talk
    for second in range(100, 130):
        out.send(odometry(second, 1.6e308))
        out.send(stated(second))
        comparing.launched.rest(0.3)
        if comparing.said[-1:] and comparing.said[-1].level == DiagnosticStatus.ERROR:
            break
    status = comparing.said[-1]
    assert status.level == DiagnosticStatus.ERROR
    assert status.message.startswith("nothing to compare: odom refused: covariance out of range (")
    for second in range(130, 140):
        out.send(odometry(second, 1e-4 * second))
        out.send(stated(second))
    comparing.verdict()
    assert counts(comparing)["compared"] >= 9
    comparing.stop()


@st.composite
def messages(draw: Any) -> Any:
    kind = draw(st.sampled_from([Odometry, PoseWithCovarianceStamped]))
    message = kind()
    message.header.stamp.sec, message.header.stamp.nanosec = draw(SECONDS), draw(NANOSECONDS)
    place, turn = message.pose.pose.position, message.pose.pose.orientation
    place.x, place.y = draw(NUMBER), draw(NUMBER)
    turn.z, turn.w = draw(st.sampled_from([(0.0, 1.0), (0.6, 0.8)]) | st.tuples(NUMBER, NUMBER))
    if kind is Odometry:
        message.twist.twist.linear.x, message.twist.twist.angular.z = draw(NUMBER), draw(NUMBER)
    variances = draw(st.sampled_from([0.0, 1e-4, 1e24, 1.6e308]) | NUMBER)
    for at in (0, 7, 35):
        message.pose.covariance[at] = variances
    for at in draw(st.sets(st.integers(0, 35), max_size=3)):
        message.pose.covariance[at] = draw(NUMBER)
    return message


def test_no_message_ends_it_and_each_is_in_one_count(talk: Any) -> None:
    comparing, out = talk

    @settings(
        max_examples=25,
        deadline=None,
        suppress_health_check=[HealthCheck.too_slow, HealthCheck.large_base_example],
    )
    @given(st.lists(messages(), min_size=10, max_size=40))
    def lives(made_up: list[Any]) -> None:
        for message in made_up:
            out.send(message)
        comparing.launched.rest(0.02)
        assert comparing.process.poll() is None, comparing.process.stderr.read()

    lives()
    comparing.launched.rest(0.5)
    comparing.verdict()
    told = counts(comparing)
    refused = {
        topic: sum(n for key, n in told.items() if key.startswith(f"{topic} refused: "))
        for topic in ("odom", "reference")
    }
    ends = ("compared", "without odometry", "old references", "waiting")
    assert refused["reference"] + sum(told.get(end, 0) for end in ends) == out.sent["reference"]
    assert (
        refused["odom"] + told["odometry taken"] + told.get("old odometry", 0) == out.sent["odom"]
    )
    for error in comparing.errors:
        parts = error.vector.x, error.vector.y, error.vector.z
        assert all(map(math.isfinite, parts)), error
    comparing.stop()


def test_a_reference_that_was_always_refused_is_told_as_such() -> None:
    """One in some seconds, so that none was refused since the last look: "+nan s" was printed."""
    counts = Counter({"reference refused: not finite": 3, "odometry taken": 200})
    node: Any = SimpleNamespace(
        _now=lambda: 100.0,
        _window=SimpleNamespace(count=0),
        _counts=counts,
        _counts_before=Counter(counts),
        _heard={"odom": 99.9, "reference": 99.0},
        _compared_at=0.0,
        _latest=math.nan,
        _track=SimpleNamespace(newest=50.0),
    )
    level, words = CompareNode._verdict_on_messages(node)
    assert words == "nothing to compare: reference refused: not finite (3)"
    assert level == DiagnosticStatus.ERROR
