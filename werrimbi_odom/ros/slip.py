# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A gyro beside the wheels: where they slip, the covariance grows by what was missed.

The reckoning is in `werrimbi_odom.model.slip`; here is the subscription, and what is told of it.
"""

from __future__ import annotations

import math
from typing import Any

from rclpy.event_handler import SubscriptionEventCallbacks
from sensor_msgs.msg import Imu

from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.slip import NOTHING, Missed, SlipGuard
from werrimbi_odom.ros import inputs
from werrimbi_odom.ros.learning import FASTEST
from werrimbi_odom.ros.live_odometer import LiveOdometer
from werrimbi_odom.ros.upright_gyro import UprightGyro


class NoSlip:
    """Where no gyro is given."""

    def missed(self, tracker: LiveOdometer) -> Missed:
        """What the reading that the tracker has just taken adds to the covariance."""
        return NOTHING

    def retune(self, robot: Robot) -> None:
        """Go on with other values of the robot."""

    def told(self) -> dict[str, str]:
        """What of it stands on /diagnostics."""
        return {}


class Slip(NoSlip):
    """Compares the wheels with the gyro of a topic.

    Parameters
    ----------
    wiring : Wiring
    robot : Robot
    topic : str
        Of sensor_msgs/Imu.
    """

    def __init__(self, wiring: inputs.InputOptions, robot: Robot, topic: str) -> None:
        self._topic = topic
        self._guard = SlipGuard(robot.track, max(robot.left_tick, robot.right_tick))
        self._gyro = UprightGyro(topic, wiring.node.get_logger())
        self._heard = 0
        self._tracker: LiveOdometer | None = None
        wiring.node.create_subscription(
            Imu,
            topic,
            self._see,
            inputs.sensor_qos(),
            event_callbacks=SubscriptionEventCallbacks(use_default_callbacks=False),
        )

    def missed(self, tracker: LiveOdometer) -> Missed:
        """What the reading that the tracker has just taken adds to the covariance."""
        self._tracker = tracker
        return self._guard.wheels(tracker.seconds(tracker.stamp), tracker.heading)

    def retune(self, robot: Robot) -> None:
        """Go on with another base."""
        self._guard.track = robot.track

    def told(self) -> dict[str, str]:
        """What of it stands on /diagnostics."""
        if not self._heard:
            return {"slip": f"no gyro heard on {self._topic}"}
        turn = math.degrees(self._guard.missed)
        return {"slip": f"{self._guard.times} times, {turn:.1f} deg missed"}

    def _see(self, message: Any) -> None:
        if message.angular_velocity_covariance[0] < 0.0:
            return
        rate = self._gyro.rate(message)
        if self._tracker is None:
            return
        if abs(rate) < FASTEST:
            self._heard += 1
            self._guard.gyro(self._tracker.seconds(message.header.stamp), rate)


def slip_of(wiring: inputs.InputOptions, robot: Robot) -> NoSlip:
    """What the robot file asks for."""
    topic = str(wiring.values["slip_imu_topic"])
    return Slip(wiring, robot, topic) if topic else NoSlip()
