# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Where, along which axis and when the reference sees the robot."""

from __future__ import annotations

from typing import Any, NamedTuple


class View(NamedTuple):
    """How the reference looks at the robot."""

    ahead: float = 0.0
    """The measured point lies this far ahead of the axle's midpoint [m]."""
    left: float = 0.0
    """... and this far to its left [m]."""
    yaw: float = 0.0
    """The reference's forward axis is turned by this against the robot's [rad]."""
    delay: float = 0.0
    """What the reference stamps t, it saw at t - delay [s]."""
    heading_delay: float = 0.0
    """Its heading is later than its position by this [s]."""
    mirrored: bool = False
    """Its frame is left-handed."""
    scale: float = 1.0
    """What it shows over what was: of ways, or where headings alone are measured, of turns."""
    wander: float = 0.0
    """Its heading is a gyro's, whose bias grows by this from zero at the drive's start
    [rad/s^2]."""

    def drifted(self, since: Any) -> Any:
        """How far its heading is off, so long after the drive's start [s], an array or not."""
        return 0.5 * self.wander * since * since
