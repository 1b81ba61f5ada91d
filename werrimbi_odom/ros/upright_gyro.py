# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Yaw rate from sensor_msgs/Imu messages, for any mounting of the sensor (REP-145: raw data)."""

from __future__ import annotations

from typing import Any

import numpy as np

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.references.gyro import yaw_rate
from werrimbi_odom.model.pose import Floats

LISTENED = 50
"""Number of messages from which the vertical is estimated, once."""
FASTEST = 1e4
"""Yaw rate [rad/s] beyond which a gyro is broken."""


class UprightGyro:
    """Rate about the vertical by the accelerometer; about z until that is estimated."""

    def __init__(self, topic: str, logger: Any) -> None:
        self._topic, self._logger = topic, logger
        self._forces: list[tuple[float, float, float]] = []
        self._up: Floats = np.array([0.0, 0.0, 1.0])

    def rate(self, message: Any) -> float:
        """Yaw rate of one message [rad/s].

        InputError if it has none, or one that no robot turns at; arguments are the cause and the
        detail.
        """
        if message.angular_velocity_covariance[0] < 0.0:  # REP-145: the Imu does not measure this
            raise InputError("no angular velocity", "the Imu measures none")
        if len(self._forces) < LISTENED and message.linear_acceleration_covariance[0] != -1.0:
            force = message.linear_acceleration
            self._forces.append((force.x, force.y, force.z))
            if len(self._forces) == LISTENED:
                self._up, mounted = yaw_rate(np.eye(3), np.array(self._forces))
                if mounted:
                    self._logger.info(f"the gyro of {self._topic} is {mounted}")
        turning = message.angular_velocity
        about_z = self._up[2] == 1.0  # x and y may be anything then
        rate = turning.z if about_z else float(self._up @ (turning.x, turning.y, turning.z))
        if not abs(rate) < FASTEST:
            raise InputError("rate out of range", f"{rate} rad/s")
        return float(rate)
