# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""odom_node with a gyro: wheels that slip make it less sure, and nothing else does."""

from __future__ import annotations

import time
from typing import Any

import pytest

pytest.importorskip("rclpy")

from rclpy.qos import ReliabilityPolicy
from sensor_msgs.msg import Imu

from test.ros.messages import stamp_at


@pytest.mark.parametrize("upwards", ["z", "y"])
def test_a_spin_that_the_gyro_denies_makes_the_heading_unsure(
    launch: Any, robot: dict[str, Any], upwards: str
) -> None:
    node = launch(robot | {"slip_imu_topic": "imu"}).begin()

    def spin(body: float) -> float:
        """Turn the wheels by 0.6 rad within a second and a half; the variance of the heading."""
        for step in range(75):
            message = Imu()
            setattr(message.angular_velocity, upwards, body if 10 <= step < 60 else 0.0)
            setattr(message.linear_acceleration, upwards, 9.8)
            node.step(*((-13.4, 6.7) if 10 <= step < 60 else (0, 0)))
            message.header.stamp = stamp_at(node.now)
            node.send(Imu, "imu", message)
            node.rest(0.002)
        return float(node.last().pose.covariance[35])

    for _ in range(60):  # at rest: which way is up
        message = Imu()
        setattr(message.linear_acceleration, upwards, 9.8)
        node.send(Imu, "imu", message)
        node.rest(0.002)
    honest = spin(0.6015)  # as the wheels turn
    assert honest < 1e-4
    _, _, values = node.report()
    assert values["slip"] == "0 times, 0.0 deg missed"
    assert spin(0.0) == pytest.approx(0.36, rel=0.1)
    _, _, values = node.report()
    assert values["slip"].startswith("1 time, 3")


def test_its_gyro_takes_a_qos_override(launch: Any, robot: dict[str, Any]) -> None:
    own = robot["qos_overrides"] | {"/imu": {"subscription": {"reliability": "reliable"}}}
    node = launch(robot | {"slip_imu_topic": "imu", "qos_overrides": own})
    node.until(lambda: node.node.count_subscribers("imu") == 1, "subscription")
    (heard,) = node.node.get_subscriptions_info_by_topic("/imu")
    assert heard.qos_profile.reliability == ReliabilityPolicy.RELIABLE
    assert "is not used" not in node.stderr()


def test_a_gyro_without_stamps_is_taken_as_it_comes(launch: Any, robot: dict[str, Any]) -> None:
    """As counters without a stamp are: its slips were never seen, and /diagnostics was content."""
    node = launch(robot | {"slip_imu_topic": "imu"}).begin()
    for step in range(75):
        left, right = (-13.4, 6.7) if 10 <= step < 60 else (0.0, 0.0)
        node.ticks(node.left + left, node.right + right, time.time())
        node.send(Imu, "imu", Imu())
        node.rest(0.02)
    node.rest(1.0)
    _, _, values = node.report()
    times, _, missed = values["slip"].partition(" time, ")
    assert times == "1"
    assert float(missed.split()[0]) == pytest.approx(34.5, abs=6.0)
