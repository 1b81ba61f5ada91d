# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What real drivers get wrong, into the real node: nothing jumps, all is counted, it goes on."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable
from typing import Any

import pytest

from test.evidence import in_evidence

pytest.importorskip("rclpy")

from diagnostic_msgs.msg import DiagnosticStatus
from std_msgs.msg import Int64, Int64MultiArray

from test.ros.messages import values_of

NAMES = ["left_wheel_joint", "right_wheel_joint"]
TICK = 2.0 * math.pi * 0.05 / 2000.0

BAD = {
    "nan": (NAMES, [math.nan, 0.0], "position not finite"),
    "infinite": (NAMES, [0.0, -math.inf], "position not finite"),
    "absurd": (NAMES, [1e300, 0.0], "position out of range"),
    "missing_joint": (["left_wheel_joint", "castor"], [0, 0], "joint right_wheel_joint missing"),
    "too_few": (NAMES, [0.0], "wrong array length"),
    "too_many": (NAMES, [0.0, 0.0, 0.0], "wrong array length"),
    "empty": (NAMES, [], "empty position"),
    "twice": (["left_wheel_joint", *NAMES], [0.0, 100.0, 50.0], "joint left_wheel_joint twice"),
}


@pytest.fixture(scope="module")
def counts_after_all(node: Any) -> dict[str, int]:
    """Counts once every message above has been sent, with some driving after each.

    The next good message holds the motion of the one that was refused.
    """
    for names, positions, _ in BAD.values():
        node.reset()
        published = len(node.odometry)
        node.drive([(100, 50)] * 2)
        node.raw_joints(names, positions)
        message = node.drive([(200, 100)] * 2)
        assert len(node.odometry) == published + 4
        assert message.pose.pose.position.x == pytest.approx(600 * TICK, abs=1e-9)
        assert all(math.isfinite(value) for value in message.pose.covariance)
    node.counted(Counter(), refused=len(BAD))
    return node.counts()


@pytest.mark.parametrize("case", BAD)
def test_a_message_that_cannot_be_used(
    node: Any, counts_after_all: dict[str, int], case: str
) -> None:
    """It is refused, counted with its cause, said once; nothing else comes of it."""
    cause = BAD[case][2]
    assert counts_after_all[f"refused: {cause}"] == sum(
        cause == other for *_, other in BAD.values()
    )
    assert node.stderr().count(f"input refused: {cause}: ") == 1


def test_nothing_but_messages_that_cannot_be_used(node: Any) -> None:
    before = len(node.diagnostics)
    node.drive([(0, 0)])
    while len(node.diagnostics) < before + 2:
        node.raw_joints(NAMES, [])
        node.rest(0.05)
    status = node.diagnostics[-1]
    assert status.level == DiagnosticStatus.ERROR
    assert status.message.startswith("no odometry, all input is refused: empty position (")
    node.drive([(0, 0)])
    node.report()  # the last of them is counted before the next test counts


def test_messages_of_another_driver_on_the_topic_are_not_for_us(node: Any) -> None:
    """Many robots have the joints of an arm and of the wheels on one topic."""
    node.reset()
    node.drive([(0, 0)])
    before, published = node.counts(), len(node.odometry)
    for _ in range(3):
        node.raw_joints(["shoulder", "elbow"], [0.1, math.nan])
        node.step(100, 50)
        node.last()
    assert len(node.odometry) == published + 3
    level, _ = node.counted(before, node.stand, refused=0, messages_of_other_joints=3)
    assert level == DiagnosticStatus.OK


def test_wheels_by_other_names_are_told_by_name(
    launch: Callable[..., Any], robot: dict[str, Any]
) -> None:
    node = launch(robot | {"left_wheel_names": ["left"], "right_wheel_names": ["right"]})
    while len(node.diagnostics) < 2:
        node.step(0, 0)
        node.rest(0.1)
    status = node.diagnostics[-1]
    assert status.level == DiagnosticStatus.ERROR
    assert status.message == (
        "no odometry: /joint_states has left_wheel_joint, right_wheel_joint, and none of the "
        "joints in left_wheel_names and right_wheel_names"
    )


@pytest.mark.parametrize(
    ("unit", "step", "told"),
    [
        ("radians", 7.0, "whole numbers, and rather counts than radians: position_unit: ticks"),
        ("ticks", 0.13, "no whole numbers, and rather radians than counts: position_unit: radians"),
        ("radians", 0.13, ""),
        ("ticks", 7.0, ""),
    ],
)
def test_positions_in_another_unit_than_stated_are_suspected(
    launch: Callable[..., Any], robot: dict[str, Any], unit: str, step: float, told: str
) -> None:
    node = launch(robot | {"position_unit": unit}).begin()
    for row in range(60):
        node.ticks(step * row, step * row)
    seen = len(node.diagnostics)
    while len(node.diagnostics) < seen + 2:
        node.step(step, step)
        node.rest(0.1)
    message = node.diagnostics[-1].message
    assert told in message
    assert told or "positions" not in message


def test_time_goes_back(node: Any) -> None:
    node.reset()
    node.drive([(100, 50)])
    before, published = node.counts(), len(node.odometry)
    node.ticks(node.left + 100, node.right + 50, node.now - 0.3)
    message = node.drive([(100, 50)])
    assert len(node.odometry) == published + 1
    assert message.pose.pose.position.x == pytest.approx(300 * TICK, abs=1e-9)
    level, words = node.counted(before, node.stand, out_of_order=1)
    assert level == DiagnosticStatus.WARN
    assert "out of order (1)" in words


def test_the_clock_is_set_back(node: Any) -> None:
    node.reset()
    node.drive([(100, 50)])
    before = node.counts()
    node.now -= 50.0
    message = node.drive([(100, 50)] * 3)
    assert message.pose.pose.position.x == pytest.approx(400 * TICK, abs=1e-9)
    level, words = node.counted(before, node.stand, clock_jumps=1)
    assert level == DiagnosticStatus.WARN
    assert "clock jumps (1)" in words


def test_a_message_comes_twice(node: Any) -> None:
    node.reset()
    node.drive([(100, 50)])
    before = node.counts()
    node.ticks(node.left, node.right, node.now)
    node.counted(before, duplicates=1)


def test_a_gap_loses_no_motion(node: Any) -> None:
    node.reset()
    node.drive([(100, 50)] * 5)
    before = node.counts()
    node.now += 10.0
    message = node.drive([(20_000, 10_000)])
    assert message.pose.pose.position.x == pytest.approx(20_500 * TICK, abs=1e-9)
    assert message.twist.twist.linear.x == pytest.approx(20_000 * TICK / 10.02, rel=1e-6)
    level, words = node.counted(before, node.stand, gaps=1)
    assert level == DiagnosticStatus.WARN
    assert "gaps (1)" in words


def test_the_counters_are_reset_in_mid_drive(node: Any) -> None:
    node.reset()
    far = node.drive([(100, 50)] * 60)
    before = node.counts()
    node.ticks(0, 0)
    restarted = node.last()
    assert restarted.pose.pose == far.pose.pose
    assert restarted.pose.covariance[0] > far.pose.covariance[0], "travel that nobody counted"
    message = node.drive([(100, 50)])
    assert message.pose.pose.position.x == pytest.approx(6100 * TICK, abs=1e-9)
    level, words = node.counted(before, node.stand, resets=1)
    assert level == DiagnosticStatus.WARN
    assert "resets (1)" in words


@pytest.mark.parametrize("bits", [16, *(in_evidence(bits) for bits in (8, 32))])
def test_counters_wrap_in_both_directions(
    launch: Callable[..., Any], robot: dict[str, Any], bits: int
) -> None:
    node = launch(robot | {"encoder_bits": bits})
    half = 2 ** (bits - 1)

    def send(travel: int) -> None:
        left, right = half - 20 + 2 * travel, -half + 20 + travel
        node.ticks(*((count + half) % (2 * half) - half for count in (left, right)))

    node.begin(lambda: send(0))
    for travel in [*range(0, 120, 5), *range(120, -120, -5)]:
        send(travel)
    node.last()
    send(-100)
    message = node.last()
    assert message.pose.pose.position.x == pytest.approx(-200 * TICK, abs=1e-9)
    assert message.pose.pose.orientation.z == pytest.approx(0.0, abs=1e-12)
    node.counted(Counter(), wraps=3)


def test_one_wheel_falls_silent(launch: Callable[..., Any], robot: dict[str, Any]) -> None:
    node = launch(robot | {"input_type": "int64_pair", "gap_duration": 0.5})

    def send(count: int, *topics: str) -> None:
        for topic in topics:
            ticks = count if topic == "left_ticks" else count // 2
            node.send(Int64, topic, Int64(data=ticks))

    node.begin(lambda: send(0, "left_ticks", "right_ticks"))
    published = len(node.odometry)
    reports = len(node.diagnostics)
    while len(node.diagnostics) < reports + 2:
        send(2000, "left_ticks")
        node.rest(0.05)
    level, words = node.diagnostics[-1].level, node.diagnostics[-1].message
    values = values_of(node.diagnostics[-1])
    assert level == DiagnosticStatus.ERROR
    assert words.startswith("no odometry without both wheels: /right_ticks silent for ")
    assert int(values["messages on /left_ticks"]) > int(values["messages on /right_ticks"])
    assert len(node.odometry) == published
    send(4000, "left_ticks", "right_ticks")
    node.until(lambda: len(node.odometry) > published, "odometry with both wheels again")
    assert node.odometry[-1].pose.pose.position.x == pytest.approx(4000 * TICK, abs=1e-9)
    node.rest(0.6)
    level, words, _ = node.report()
    assert level == DiagnosticStatus.STALE
    assert words.count("silent for") == 2


def test_an_array_of_the_wrong_length(launch: Callable[..., Any], robot: dict[str, Any]) -> None:
    node = launch(robot | {"input_type": "int64_multi_array"})

    def send(*counts: int) -> None:
        node.send(Int64MultiArray, "ticks", Int64MultiArray(data=list(counts)))

    node.begin(lambda: send(0, 0))
    before, published = node.counts(), len(node.odometry)
    for counts in ((), (1,), (1, 2, 3)):
        send(*counts)
    node.counted(before, refused=3, refused_wrong_array_length=3)
    send(400, 200)
    node.until(lambda: len(node.odometry) > published, "odometry")
    assert node.odometry[-1].pose.pose.position.x == pytest.approx(400 * TICK, abs=1e-9)
    assert node.stderr().count("input refused: wrong array length") == 1, "said once, then counted"


def test_a_speed_that_cannot_be_is_refused_until_it_is_confirmed(
    launch: Callable[..., Any], robot: dict[str, Any]
) -> None:
    node = launch(robot | {"max_wheel_speed": 2.0}).begin()
    node.drive([(100, 50)] * 3)
    before, published = node.counts(), len(node.odometry)
    node.ticks(900_000, 50)
    node.ticks(400, 200)
    assert node.last().pose.pose.position.x == pytest.approx(400 * TICK, abs=1e-9)
    assert len(node.odometry) == published + 1
    level, _ = node.counted(before, node.stand, implausible=1)
    assert level == DiagnosticStatus.WARN
