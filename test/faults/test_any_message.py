# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Messages and parameters that hypothesis makes up, to the real node over DDS."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

pytest.importorskip("rclpy")

from geometry_msgs.msg import PoseWithCovarianceStamped
from sensor_msgs.msg import JointState

from test.ros.messages import assert_covariances
from werrimbi_odom.ros.odom_parameters import CHANGEABLE

NUMBER = st.floats() | st.sampled_from(
    [0.0, 1e308, -1e308, 5e-324, math.nan, math.inf, 2.0**31, 2.0**53, -(2.0**63)]
)
NAME = st.sampled_from(["left_wheel_joint", "right_wheel_joint", "arm", ""]) | st.text(max_size=5)
WHEELS = ["left_wheel_joint", "right_wheel_joint"]
SECONDS = st.integers(-(2**31), 2**31 - 1) | st.integers(100, 300)
NANOSECONDS = st.integers(0, 2**32 - 1)


@st.composite
def joint_states(draw: Any) -> JointState:
    names = draw(st.just(WHEELS) | st.lists(NAME, max_size=4))
    size = draw(st.just(len(names)) | st.integers(0, 4))
    message = JointState(
        name=[name.encode("utf-8", "replace").decode().replace("\0", "") for name in names],
        position=draw(st.lists(NUMBER, min_size=size, max_size=size)),
    )
    message.header.stamp.sec, message.header.stamp.nanosec = draw(SECONDS), draw(NANOSECONDS)
    return message


@st.composite
def poses(draw: Any) -> PoseWithCovarianceStamped:
    message = PoseWithCovarianceStamped()
    message.header.frame_id = draw(st.sampled_from(["odom", "map"]))
    place, turn = message.pose.pose.position, message.pose.pose.orientation
    place.x, place.y = draw(NUMBER), draw(NUMBER)
    turn.z, turn.w = draw(
        st.sampled_from([(0.0, 1.0), (1.0, 0.0), (0.6, 0.8)]) | st.tuples(NUMBER, NUMBER)
    )
    for place_in_matrix in draw(st.sets(st.integers(0, 35), max_size=4)):
        message.pose.covariance[place_in_matrix] = draw(NUMBER)
    return message


CHANGES = st.dictionaries(st.sampled_from(sorted(CHANGEABLE)), NUMBER | st.floats(1e-3, 1e3))
ENDS = ("published", "refused", "duplicates", "out of order", "not finite", "implausible")


def test_the_node_lives_publishes_covariances_and_counts_each_message_once(node: Any) -> None:
    before = drained(node)
    sent = 0

    @settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.too_slow])
    @given(messages=st.lists(joint_states() | poses(), min_size=5, max_size=40), changes=CHANGES)
    def lives(messages: list[Any], changes: dict[str, float]) -> None:
        nonlocal sent
        for message in messages:
            is_joints = isinstance(message, JointState)
            sent += is_joints
            node.send(type(message), "joint_states" if is_joints else "set_pose", message)
        for name, value in changes.items():
            result = node.set_parameters(**{name: value})
            assert result.successful or result.reason
        node.rest(0.05)
        assert node.process.poll() is None, node.stderr()
        for odometry in node.odometry:
            check(odometry)
        node.odometry.clear()

    lives()
    after = drained(node)
    new = {key: after[key] - before[key] for key in after}
    assert new["messages"] + new["messages of other joints"] == sent
    assert sum(new[end] for end in ENDS) == new["messages"], new


def drained(node: Any) -> Any:
    """Counts once all that was sent has been taken."""
    node.rest(0.5)
    node.report()
    return node.counts()


def check(odometry: Any) -> None:
    pose, twist = odometry.pose, odometry.twist
    numbers = [pose.pose.position.x, pose.pose.position.y, pose.pose.orientation.z]
    numbers += [twist.twist.linear.x, twist.twist.angular.z]
    assert all(map(math.isfinite, numbers)), odometry
    assert_covariances(odometry)
