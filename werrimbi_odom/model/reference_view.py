# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Point, axis and time at which the reference observes the robot."""

from __future__ import annotations

from typing import Any, NamedTuple


class View(NamedTuple):
    """How the reference observes the robot."""

    ahead: float = 0.0
    """Distance of the measured point ahead of the axle's midpoint [m]."""
    left: float = 0.0
    """Distance of the measured point to its left [m]."""
    yaw: float = 0.0
    """Angle of the reference's forward axis relative to the robot's [rad]."""
    delay: float = 0.0
    """A measurement stamped t was taken at t - delay, but for `clock_drift` [s]."""
    heading_delay: float = 0.0
    """Additional delay of its heading [s]."""
    mirrored: bool = False
    """Its frame is left-handed."""
    scale: float = 1.0
    """Measured over true: of distances, or of turns where only headings are measured."""
    wander: float = 0.0
    """Its heading is that of a gyro whose bias grows from zero at this rate [rad/s^2]."""
    clock_drift: float = 0.0
    """What its clock gains on that of the encoders in a second [s/s]."""

    def late(self, since: Any) -> Any:
        """Delay of a stamp at a time since the start of the drive [s], scalar or array."""
        return self.delay + self.clock_drift * since

    def drifted(self, since: Any) -> Any:
        """Heading error at a time since the start of the drive [s], scalar or array."""
        return 0.5 * self.wander * since * since
