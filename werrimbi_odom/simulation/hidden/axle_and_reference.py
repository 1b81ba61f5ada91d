# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Faults of the axle's mount, and of the reference: its mount, clock, gyro, frame."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..chassis import Chassis
from ..engine import AxlePose
from ..recording import Recording
from ..robot import TrueRobot
from ..sensors import ReferenceSensor, wrap
from .hidden_effect import Peculiarity, Rng


@dataclass(frozen=True)
class AskewAxle(Peculiarity):
    """The axle is not perpendicular to the body, so the robot drives slightly sideways."""

    angle: float
    """Angle from the body's forward axis to the direction of travel, anticlockwise [rad]."""

    def chassis(self, chassis: Chassis) -> Chassis:
        """Rotate the axle with both wheels relative to the body."""
        return replace(chassis, axle_yaw=chassis.axle_yaw + self.angle)


@dataclass(frozen=True)
class ReferenceMount(Peculiarity):
    """Offset of the marker on the robot: ahead, to the left [m], yaw [rad]."""

    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0

    def reference(self, sensor: ReferenceSensor) -> ReferenceSensor:
        """Displace the marker."""
        mount = sensor.mount
        return replace(
            sensor, mount=AxlePose(mount.x + self.x, mount.y + self.y, mount.yaw + self.yaw)
        )


@dataclass(frozen=True)
class ReferenceDelay(Peculiarity):
    """The stamps of the reference are late."""

    delay: float = 0.0
    """A sample with stamp t was measured at t - delay [s]."""
    heading_delay: float = 0.0
    """Additional delay of the yaw [s]."""

    def reference(self, sensor: ReferenceSensor) -> ReferenceSensor:
        """Add the delays."""
        return replace(
            sensor,
            delay=sensor.delay + self.delay,
            heading_delay=sensor.heading_delay + self.heading_delay,
        )


@dataclass(frozen=True)
class DriftingClock(Peculiarity):
    """The reference is recorded by another computer, whose clock runs at another rate.

    The clocks are set to one another at some time before each drive, so the delay as it begins is
    another one in each. The rate changes little, with the temperature of the quartz.
    """

    live = False
    rate: float
    """Mean of what its clock gains in a second [s/s]."""
    unset: float = 100.0
    """Longest time from when the clocks were set to when a drive begins [s]."""

    def recording(self, recording: Recording, robot: TrueRobot, rng: Rng) -> Recording:
        """Stamp the same measurements by the other clock."""
        rate = self.rate * float(rng.uniform(0.8, 1.2))
        since = recording.reference_t_s + self.unset * float(rng.uniform())
        return replace(recording, reference_t_s=recording.reference_t_s + rate * since)


@dataclass(frozen=True)
class WarmingGyro(Peculiarity):
    """The reference's heading is from a gyro, and its temperature changes in each drive.

    Its bias follows the temperature, which approaches the ambient one exponentially. The bias is
    zero at the start of a drive, as after a calibration.
    """

    live = False
    rate: float
    """Mean size of the initial rate of change of the bias over drives [rad/s^2]."""
    settles: float = 200.0
    """Time constant of the temperature [s]."""
    unrest: float = 0.5
    """Additional random walk of the bias over one second, as a share of its drift in one second."""

    def recording(self, recording: Recording, robot: TrueRobot, rng: Rng) -> Recording:
        """Add the integral of the bias to the measured yaw."""
        rate = self.rate * float(rng.choice([-1.0, 1.0]) * rng.uniform(0.5, 1.5))
        time = recording.reference_t_s
        steps = np.diff(time, prepend=min(0.0, time[0]))  # its clock may be behind the drive's
        walked = np.cumsum(rng.standard_normal(time.size) * np.sqrt(steps)) * self.unrest
        bias = rate * (self.settles * (1.0 - np.exp(-time / self.settles)) + walked)
        off = np.cumsum(0.5 * (bias + np.concatenate(([0.0], bias[:-1]))) * steps)
        return replace(recording, reference_yaw_rad=wrap(recording.reference_yaw_rad + off))


@dataclass(frozen=True)
class ReferenceMirrored(Peculiarity):
    """The reference's frame is left-handed: y points down, or east and north are exchanged."""

    exchanged: bool

    def reference(self, sensor: ReferenceSensor) -> ReferenceSensor:
        """Mirror the output of the reference."""
        return replace(sensor, mirrored="exchanged" if self.exchanged else "y_down")
