# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Axles and references that are not mounted, or do not tell the time, as believed."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ..chassis import Chassis
from ..engine import Pose
from ..sensors import ReferenceSensor
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
        return replace(sensor, mount=Pose(mount.x + self.x, mount.y + self.y, mount.yaw + self.yaw))


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
class ReferenceMirrored(Peculiarity):
    """The reference's frame is left-handed: y points down, or east and north are exchanged."""

    exchanged: bool

    def reference(self, sensor: ReferenceSensor) -> ReferenceSensor:
        """Mirror what it writes."""
        return replace(sensor, mirrored="exchanged" if self.exchanged else "y_down")
