# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Axles and references that are not mounted, or do not tell the time, as believed."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..chassis import Chassis
from ..engine import AxlePose
from ..recording import Recording
from ..robot import TrueRobot
from ..sensors import ReferenceSensor, wrap
from .peculiarity import Peculiarity


@dataclass(frozen=True)
class AskewAxle(Peculiarity):
    """The axle is not square to the body, so the robot drives like a crab.

    Parameters
    ----------
    angle : float
        From the body's forward axis to the direction of travel, anticlockwise [rad].
    """

    angle: float

    def chassis(self, chassis: Chassis) -> Chassis:
        """Turn the axle with both wheels under the body."""
        return replace(chassis, axle_yaw=chassis.axle_yaw + self.angle)


@dataclass(frozen=True)
class ReferenceMount(Peculiarity):
    """The marker sits elsewhere on the robot, or askew: ahead, left [m], turned [rad]."""

    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0

    def reference(self, sensor: ReferenceSensor) -> ReferenceSensor:
        """Move the marker."""
        mount = sensor.mount
        return replace(
            sensor, mount=AxlePose(mount.x + self.x, mount.y + self.y, mount.yaw + self.yaw)
        )


@dataclass(frozen=True)
class ReferenceDelay(Peculiarity):
    """The reference's stamps are late.

    Parameters
    ----------
    delay : float
        What is stamped t was measured at t - delay [s].
    heading_delay : float
        The yaw's further delay [s].
    """

    delay: float = 0.0
    heading_delay: float = 0.0

    def reference(self, sensor: ReferenceSensor) -> ReferenceSensor:
        """Set its clock back."""
        return replace(
            sensor,
            delay=sensor.delay + self.delay,
            heading_delay=sensor.heading_delay + self.heading_delay,
        )


@dataclass(frozen=True)
class WarmingGyro(Peculiarity):
    """The reference's heading is a gyro's, whose chip warms up or cools in each drive anew.

    Its bias goes with its temperature, which nears that of its surroundings; as the drive begins
    its driver has just taken the bias off.

    Parameters
    ----------
    rate : float
        By which the bias grows or falls at first, on average over drives [rad/s^2].
    settles : float
        Time in which the chip has done all but 1/e of its change of temperature [s].
    unrest : float
        Random walk of the bias beside, over a second [rad/s]; as a share of what it drifts in one.
    """

    rate: float
    settles: float = 200.0
    unrest: float = 0.5

    def recording(
        self, recording: Recording, robot: TrueRobot, rng: np.random.Generator
    ) -> Recording:
        """Turn what was measured by the integral of the bias."""
        rate = self.rate * float(rng.choice([-1.0, 1.0]) * rng.uniform(0.5, 1.5))
        time = recording.reference_t_s
        steps = np.diff(time, prepend=0.0)
        walked = np.cumsum(rng.standard_normal(time.size) * np.sqrt(steps)) * self.unrest
        bias = rate * (self.settles * (1.0 - np.exp(-time / self.settles)) + walked)
        off = np.cumsum(0.5 * (bias + np.concatenate(([0.0], bias[:-1]))) * steps)
        return replace(recording, reference_yaw_rad=wrap(recording.reference_yaw_rad + off))


@dataclass(frozen=True)
class ReferenceMirrored(Peculiarity):
    """The reference's frame is left-handed: y points down, or east and north are exchanged."""

    exchanged: bool

    def reference(self, sensor: ReferenceSensor) -> ReferenceSensor:
        """Mirror what it writes."""
        return replace(sensor, mirrored="exchanged" if self.exchanged else "y_down")
