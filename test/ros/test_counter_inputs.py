# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Every kind of input, each into the real node; and several wheels as one counter."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from test.evidence import in_evidence

pytest.importorskip("rclpy")

from sensor_msgs.msg import JointState
from std_msgs.msg import Int32, Int64, Int64MultiArray

from test.ros.messages import seconds_of
from werrimbi_odom.files.bags.bag_joints import side_counts
from werrimbi_odom.ros.wheel_side import WheelSide

Robot = dict[str, Any]

TURNS = (3.0, 3.2)
"""Turns of the left and the right wheel that every test here drives."""


def assert_driven(message: Any) -> None:
    """The odometry is that of wheels which made these turns at a constant ratio."""
    left, right = (2.0 * math.pi * 0.05 * turn for turn in TURNS)
    turn = (right - left) / 0.35
    radius = 0.5 * (left + right) / turn
    assert message.pose.pose.position.x == pytest.approx(radius * math.sin(turn), abs=1e-9)
    assert message.pose.pose.position.y == pytest.approx(radius * (1 - math.cos(turn)), abs=1e-9)
    assert message.pose.pose.orientation.z == pytest.approx(math.sin(0.5 * turn), abs=1e-9)
    assert message.pose.covariance[0] > 0.0


def test_joints_in_any_order_and_among_others(launch: Callable[..., Any], robot: Robot) -> None:
    node = launch(robot).begin()
    first = {"left_wheel_joint": 0.0, "right_wheel_joint": 0.0}
    node.joints({"lid": 0.3, **dict(reversed(first.items())), "castor": -7.0})
    node.joints({"left_wheel_joint": 3000.0, "castor": 2.0, "right_wheel_joint": 1600.0})
    node.joints({"right_wheel_joint": 3200.0, "left_wheel_joint": 6000.0})
    assert_driven(node.last())


def test_radians_with_the_encoders_resolution(launch: Callable[..., Any], robot: Robot) -> None:
    node = launch(robot | {"position_unit": "radians"}).begin()
    for share in (0.5, 1.0):
        node.ticks(*(2.0 * math.pi * share * turn for turn in TURNS))
    message = node.last()
    assert_driven(message)
    ticks = 2.0 * math.pi * 0.05 / 2000.0, 2.0 * math.pi * 0.05 / 1000.0
    quantum = sum(tick * tick / 6.0 for tick in ticks) / 4.0
    assert message.twist.covariance[0] > quantum / 0.02**2


def test_radians_of_an_unknown_encoder(launch: Callable[..., Any]) -> None:
    node = launch({"wheel_separation": 0.35, "wheel_radius": 0.05}).begin()
    for share in (0.5, 1.0):
        node.ticks(*(2.0 * math.pi * share * turn for turn in TURNS))
    message = node.last()
    assert_driven(message)
    at_rest = node.drive([(0.0, 0.0)])
    assert 0.0 < at_rest.twist.covariance[0] < 1e-9
    assert "no ticks_per_revolution" in node.stderr()


@pytest.mark.parametrize("bits", [in_evidence(0), 16])
def test_several_wheels_on_a_side_are_averaged(
    launch: Callable[..., Any], robot: Robot, bits: int
) -> None:
    """Each with a counter of its own that starts, and wraps, where it likes."""
    names = {
        "left_wheel_names": ["front_left", "rear_left"],
        "right_wheel_names": ["rear_right", "front_right"],
        "encoder_bits": bits,
    }
    node = launch(robot | names)
    starts = {"front_left": 32_000, "rear_left": -500, "front_right": 31_900, "rear_right": 7}

    def counter(name: str, turns: float, extra: float) -> float:
        count = starts[name] + turns * (2000 if "left" in name else 1000) + extra
        return (count + 2**15) % 2**16 - 2**15 if bits else count

    def send(share: float, slip: float = 0.0) -> None:
        turned = {name: share * TURNS["right" in name] for name in starts}
        extra = {"front_left": slip, "rear_left": -slip, "front_right": 0.0, "rear_right": 0.0}
        node.joints({name: counter(name, turned[name], extra[name]) for name in starts})

    node.begin(lambda: send(0.0))
    for step in range(1, 21):
        send(step / 20.0, slip=3.0 * step)
    assert_driven(node.last())
    if bits:
        node.counted(Counter(), wraps_of_single_wheels=2)


def test_one_of_two_drivers_restarts(launch: Callable[..., Any], robot: Robot) -> None:
    """The counters of the front wheels begin anew; the rear ones know how far it went."""
    names = {"left_wheel_names": ["fl", "rl"], "right_wheel_names": ["fr", "rr"]}
    node = launch(robot | names)

    def send(step: int) -> None:
        left, right = 120.0 * step, 64.0 * step
        restart = 30 if step >= 30 else 0
        front = {"fl": 120.0 * (step - restart), "fr": 64.0 * (step - restart)}
        if not restart:
            front = {"fl": 5000.0 + left, "fr": 2500.0 + right}
        node.joints({**front, "rl": 5000.0 + left, "rr": 2500.0 + right})

    node.begin(lambda: send(0))
    for step in range(1, 51):
        send(step)
    assert_driven(node.last())


@pytest.mark.parametrize(
    ("kind", "message"),
    [in_evidence("int32_pair", Int32), ("int64_pair", Int64)],
)
def test_two_topics(launch: Callable[..., Any], robot: Robot, kind: str, message: type) -> None:
    node = launch(robot | {"input_type": kind})
    start = 2**31 - 1000 if message is Int32 else 2**53 + 1  # one wraps, one is no float

    def send(left: int, right: int, wait: float = 0.0) -> None:
        for topic, count in (("left_ticks", left), ("right_ticks", right)):
            whole = (start + count + 2**31) % 2**32 - 2**31 if message is Int32 else start + count
            node.send(message, topic, message(data=whole))
            node.rest(wait)
        node.rest(0.05)

    node.begin(lambda: send(0, 0))
    published = len(node.odometry)
    send(1500, 800)
    node.until(lambda: len(node.odometry) == published + 1, "odometry of the first pair")
    send(3000, 1600, wait=0.1)  # too far apart: no pair, but the next one holds their motion
    assert len(node.odometry) == published + 1
    send(6000, 3200)
    node.until(lambda: len(node.odometry) == published + 2, "odometry of the second pair")
    assert_driven(node.odometry[-1])
    assert int(node.report()[2]["unpaired"]) >= 2
    age = 1e-9 * node.node.get_clock().now().nanoseconds - seconds_of(node.odometry[-1])
    assert 0.0 <= age < 3.0, "stamped on arrival"


def test_a_pairing_that_begins_one_message_off_mends_itself(
    launch: Callable[..., Any], robot: Robot
) -> None:
    """The window is wider than the period, and the first left count is lost."""
    node = launch(robot | {"input_type": "int64_pair", "pairing_window": 0.5})
    for topic in ("left_ticks", "right_ticks"):
        node.publisher(Int64, topic)
    node.send(Int64, "right_ticks", Int64(data=0))
    for step in range(1, 11):
        node.rest(0.06)
        node.send(Int64, "left_ticks", Int64(data=600 * step))
        node.rest(0.01)
        node.send(Int64, "right_ticks", Int64(data=300 * step))
    node.until(lambda: len(node.odometry) >= 9, "odometry of nine pairs")
    for message in node.odometry[2:]:
        assert message.twist.twist.angular.z == pytest.approx(0.0, abs=1e-9)
        assert message.twist.twist.linear.x > 0.0


def test_an_array_of_both(launch: Callable[..., Any], robot: Robot) -> None:
    node = launch(robot | {"input_type": "int64_multi_array"})
    start = 2**60 + 1

    def send(left: int, right: int) -> None:
        node.send(Int64MultiArray, "ticks", Int64MultiArray(data=[start + left, start + right]))

    node.begin(lambda: send(0, 0))
    published = len(node.odometry)
    send(3000, 1600)
    send(6000, 3200)
    node.until(lambda: len(node.odometry) == published + 2, "odometry")
    assert_driven(node.odometry[-1])


def test_without_stamps_the_arrival_is_the_stamp(launch: Callable[..., Any], robot: Robot) -> None:
    node = launch(robot)

    def send() -> None:
        names = ["left_wheel_joint", "right_wheel_joint"]
        node.send(JointState, "joint_states", JointState(name=names, position=[0.0, 0.0]))

    node.begin(send)
    age = 1e-9 * node.node.get_clock().now().nanoseconds - seconds_of(node.odometry[-1])
    assert 0.0 <= age < 3.0
    assert int(node.report()[2]["without stamp"]) >= 2


STEPS = st.lists(
    st.tuples(st.integers(-90, 90), st.integers(-3, 3), st.sampled_from("....fra")), max_size=60
)
"""What both wheels roll, how much more the second, and which of them restart, if any."""


@given(steps=STEPS, bits=st.sampled_from([0, 10]), start=st.integers(-400, 400))
def test_live_is_as_recorded(steps: list[tuple[int, int, str]], bits: int, start: int) -> None:
    counts = [np.array([start, -start], dtype=np.float64)]
    for roll, more, event in steps:
        new = counts[-1] + (roll, roll + more)
        if event in "fa":
            new[0] = 0.0
        if event in "ra":
            new[1] = 0.0
        if bits:
            new = (new + 2 ** (bits - 1)) % 2**bits - 2 ** (bits - 1)
        counts.append(new)
    recorded = side_counts(np.array(counts), 100.0, bits)
    side = WheelSide(1.0, 100.0, bits)
    live = [side.count(row.tolist()) for row in counts]
    np.testing.assert_allclose(live, recorded, atol=1e-9)


def test_one_wheel_is_itself() -> None:
    assert WheelSide(2.0, 100.0).count([21.0]) == 42.0


def test_a_wheel_that_is_not_finite_makes_the_side_so_and_is_forgotten() -> None:
    side = WheelSide(1.0, 100.0, 16)
    assert side.count([10.0, 20.0]) == 15.0
    assert math.isnan(side.count([math.inf, 20.0]))
    assert side.count([12.0, 24.0]) == 18.0
    assert (side.wraps, side.resets) == (0, 0)


def test_what_happened_is_counted() -> None:
    side = WheelSide(1.0, 100.0, 16)
    side.count([32_760.0, 5000.0])
    assert side.count([-32_760.0, 5016.0]) == 0.5 * (32_760 + 5000) + 16
    assert (side.wraps, side.resets) == (1, 0)
    assert side.count([-32_744.0, 7.0]) == 0.5 * (32_760 + 5000) + 32
    assert (side.wraps, side.resets) == (1, 1)
