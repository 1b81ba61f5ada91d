# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Increases the covariance when a gyro shows that the wheels slip.

The method is in `werrimbi_odom.model.slip`; this module subscribes and reports.
"""

from __future__ import annotations

import math
from typing import Any

from sensor_msgs.msg import Imu

from werrimbi_odom.errors import InputError
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.slip import NOTHING, Missed, SlipGuard
from werrimbi_odom.ros import counter_inputs
from werrimbi_odom.ros.live_odometer import LiveOdometer
from werrimbi_odom.ros.topics import stamp_of, subscribe
from werrimbi_odom.ros.upright_gyro import UprightGyro


class NoSlip:
    """No gyro is given."""

    def missed(self, tracker: LiveOdometer) -> Missed:
        """Variance added by the last reading of the odometer."""
        return NOTHING

    def retune(self, robot: Robot) -> None:
        """Change the parameter values of the robot."""

    def status(self) -> dict[str, str]:
        """Entries for /diagnostics."""
        return {}

    def wrong(self) -> list[str]:
        """What /diagnostics warns of."""
        return []


class Slip(NoSlip):
    """Compares the wheels with the gyro of a topic (sensor_msgs/Imu)."""

    def __init__(self, wiring: counter_inputs.InputOptions, robot: Robot, topic: str) -> None:
        self._topic = topic
        self._guard = SlipGuard(robot.track, max(robot.left_tick, robot.right_tick))
        self._gyro = UprightGyro(topic, wiring.node.get_logger())
        self._clock = wiring.node.get_clock()
        self._heard = False
        self._tracker: LiveOdometer | None = None
        subscribe(wiring.node, Imu, topic, self._see, overridable=True)

    def missed(self, tracker: LiveOdometer) -> Missed:
        """Variance added by the last reading of the odometer."""
        self._tracker = tracker
        return self._guard.wheels(tracker.seconds(tracker.stamp), tracker.heading)

    def retune(self, robot: Robot) -> None:
        """Change the track, and the travel per count."""
        self._guard.track, self._guard.tick = robot.track, max(robot.left_tick, robot.right_tick)

    def status(self) -> dict[str, str]:
        """Entries for /diagnostics."""
        if not self._heard:
            return {"slip": self._unheard}
        turn = math.degrees(self._guard.missed)
        times = self._guard.times
        return {"slip": f"{times} time{'s' * (times != 1)}, {turn:.1f} deg missed"}

    def wrong(self) -> list[str]:
        """The gyro was not heard although the wheels were."""
        return [] if self._heard or self._tracker is None else [self._unheard]

    @property
    def _unheard(self) -> str:
        return f"no gyro heard on {self._topic} (slip_imu_topic): wheels that slip go unseen"

    def _see(self, message: Any) -> None:
        try:
            rate = self._gyro.rate(message)
        except InputError:
            return
        if self._tracker is not None:
            self._heard = True
            self._guard.gyro(self._tracker.seconds(stamp_of(message, self._clock)), rate)


def slip_of(wiring: counter_inputs.InputOptions, robot: Robot) -> NoSlip:
    """Create what the robot file requests."""
    topic = str(wiring.values["slip_imu_topic"])
    return Slip(wiring, robot, topic) if topic else NoSlip()
