# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Any sequence of readings, poses, resets and parameters: the node lives, its numbers are numbers.

The callbacks of a real node are called as the executor calls them, without waiting for DDS, so that
hypothesis can try thousands; test/faults/test_any_message.py sends such sequences over DDS.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

pytest.importorskip("rclpy")

import rclpy
from geometry_msgs.msg import PoseWithCovarianceStamped
from rclpy.parameter import Parameter
from sensor_msgs.msg import JointState
from std_msgs.msg import Int64, Int64MultiArray
from std_srvs.srv import Trigger

from test.ros.messages import PLANE, assert_covariances
from werrimbi_odom.ros.domain import free_domain
from werrimbi_odom.ros.odom_node import OdomNode
from werrimbi_odom.ros.odom_parameters import CHANGEABLE

WILD = st.floats() | st.sampled_from(
    [0.0, 1e-160, 1e-300, 5e-324, 1e155, 1e300, 1e-9, 1e9, -1.0, 2.0**31, 2.0**62, -(2.0**62)]
)
COUNTS = st.integers(-(2**63), 2**63 - 1) | st.integers(-3000, 3000)
STAMPS = st.tuples(st.integers(-(2**31), 2**31 - 1), st.integers(0, 2**32 - 1)) | st.tuples(
    st.integers(100, 110), st.integers(0, 10**9 - 1)
)
EFFECTS = ["eccentric_left_wheel", "lateral_slip", "radius_drift", "castor_kick", "floor_slope"]
OWN = ["lateral_slip.creep", "radius_drift.per_distance", "eccentric_left_wheel.phase"]
NAMES = st.sampled_from([*sorted(CHANGEABLE), *OWN])

READING = st.tuples(st.just("reading"), STAMPS, COUNTS | WILD, COUNTS | WILD)
POSE = st.tuples(
    st.just("pose"),
    st.tuples(WILD | st.floats(-1e12, 1e12), st.floats(-10, 10)),
    st.sampled_from([(0.0, 1.0), (1.0, 0.0), (0.6, 0.8), (1e200, 0.0)]),
    st.lists(st.floats(-1e12, 1e12), min_size=9, max_size=9),
    st.booleans(),
)
CHANGE = st.tuples(
    st.just("change"), st.dictionaries(NAMES, WILD | st.floats(1e-3, 1e3), max_size=3)
)
SEQUENCES = st.lists(READING | READING | POSE | CHANGE | st.just(("reset",)), max_size=40)

ROBOT: dict[str, Any] = {
    "wheel_separation": 0.35,
    "wheel_radius": 0.05,
    "left_ticks_per_revolution": 2000.0,
    "right_ticks_per_revolution": 1000.0,
}
SEVERAL = {"left_wheel_names": ["a", "b"], "right_wheel_names": ["c", "d"]}
ROBOTS = {
    "joints": {"position_unit": "ticks"},
    "wrapping": {"position_unit": "ticks", "encoder_bits": 16},
    "four_wheels": {"position_unit": "ticks", "encoder_bits": 16, **SEVERAL},
    "array": {"input_type": "int64_multi_array"},
    "pair": {"input_type": "int64_pair"},
    "exact": {"position_unit": "ticks", "covariance_order": "exact"},
    "limited": {"position_unit": "ticks", "max_wheel_speed": 2.0},
    "effects": {"position_unit": "ticks", "effects": EFFECTS},
    "exact_effects": {
        "input_type": "int64_multi_array",
        "covariance_order": "exact",
        "effects": EFFECTS,
    },
}
OFTEN = ("four_wheels", "pair", "exact_effects")
"""Of each input one, counters that wrap, and all that a robot file can ask for."""


@pytest.fixture(scope="module")
def domain() -> Iterator[int]:
    number, lock = free_domain()
    yield number
    lock.close()


class Driven:
    """A node whose callbacks are called here."""

    def __init__(self, domain: int, parameters: dict[str, Any]) -> None:
        words = [f"{name}:={value}" for name, value in (ROBOT | parameters).items()]
        arguments = ["--ros-args", *(word for each in words for word in ("-p", each))]
        rclpy.init(args=arguments, domain_id=domain)
        self.kind = str(parameters.get("input_type", "joint_state"))
        self.names = [
            *parameters.get("left_wheel_names", ["left_wheel_joint"]),
            *parameters.get("right_wheel_names", ["right_wheel_joint"]),
        ]
        self.node = OdomNode()
        self.now = 10**18
        self.arrived = 0

    def close(self) -> None:
        self.node.destroy_node()
        rclpy.shutdown()

    def do(self, what: str, *with_it: Any) -> None:
        getattr(self, f"_{what}")(*with_it)

    def _reading(self, stamp: tuple[int, int], left: float, right: float) -> None:
        self.now += stamp[1] % 50_000_000
        self.arrived += 1
        info = {"received_timestamp": self.now, "publication_sequence_number": self.arrived}
        take = self.node._input
        if self.kind == "joint_state":
            half = len(self.names) // 2
            counts = [float(left)] * half + [float(right)] * half
            message = JointState(name=self.names, position=counts)
            message.header.stamp.sec, message.header.stamp.nanosec = stamp
            take._arrived(message, info)
            return
        whole = [int(count) if abs(count) < 2**63 else 0 for count in (left, right)]  # NaN: 0
        if self.kind == "int64_pair":
            take._arrived(self.arrived % 2, Int64(data=whole[0]), info)
        else:
            take._arrived(Int64MultiArray(data=whole), info)

    def _pose(
        self, place: tuple[float, float], turn: tuple[float, float], root: Any, good: bool
    ) -> None:
        message = PoseWithCovarianceStamped()
        message.header.frame_id = "odom"
        message.pose.pose.position.x, message.pose.pose.position.y = place
        message.pose.pose.orientation.z, message.pose.pose.orientation.w = turn
        block = np.array(root).reshape(3, 3)
        whole = np.zeros((6, 6))
        whole[PLANE] = block @ block.T if good else block
        message.pose.covariance = whole.ravel()
        self.node._on_set_pose(message)

    def _change(self, values: dict[str, float]) -> None:
        named = {name: value for name, value in values.items() if self.node.has_parameter(name)}
        given_in = [Parameter(name, value=value) for name, value in named.items()]
        result = self.node.set_parameters_atomically(given_in)
        assert result.successful or result.reason

    def _reset(self) -> None:
        self.node._on_reset(None, Trigger.Response())

    def check(self) -> None:
        """What was published last."""
        odometry = self.node._message._message
        place, turn = odometry.pose.pose.position, odometry.pose.pose.orientation
        speed, rate = odometry.twist.twist.linear, odometry.twist.twist.angular
        for number in (place.x, place.y, turn.z, turn.w, speed.x, speed.y, rate.z):
            assert math.isfinite(number), odometry
        assert_covariances(odometry)

    def count(self) -> None:
        """Every message is in exactly one count, and all that is told can be told."""
        self.node._rounds = -1
        self.node._viewers = 1  # as if RViz looked
        self.node._publish_status()
        self.node._show_open_piece()
        self.node._report()
        tally = self.node._tracker.odometer.tally
        counts = self.node._health._counts(tally, self.node._input.tally())
        ends = ["published", "refused", "duplicates", "out of order", "not finite", "implausible"]
        if self.kind == "int64_pair":
            ends += ["unpaired", "earlier of a pair"]
        told = sum(counts[end] for end in ends) + self.node._tracker.started
        waiting = self.node._input._pairing.waiting if self.kind == "int64_pair" else 0
        assert counts["messages"] == self.arrived == told + waiting, counts


@pytest.mark.parametrize(
    "robot",
    [pytest.param(robot, marks=[pytest.mark.evidence] * (robot not in OFTEN)) for robot in ROBOTS],
)
@settings(
    max_examples=30,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)
@given(SEQUENCES)
def test_any_sequence_leaves_numbers_and_a_true_tally(
    domain: int, robot: str, sequence: list[Any]
) -> None:
    driven = Driven(domain, ROBOTS[robot])
    try:
        for each in sequence:
            driven.do(*each)
            driven.check()
        driven.count()
    finally:
        driven.close()
