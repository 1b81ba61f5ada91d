# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Where a sensor sits on the robot's base, by constant transforms."""

from __future__ import annotations

import cmath
import math
from typing import NamedTuple


class Mount(NamedTuple):
    """Pose of a level sensor on the robot's base: ahead, left [m], rotation [rad]."""

    x: float
    y: float
    yaw: float
    inverted: bool = False
    """Mounted upside down, so left and right are swapped."""
    base: str = ""
    """Frame of the base."""
    sensor: str = ""
    """Frame of the sensor."""
    tilt: float = 0.0
    """Angle by which it is not level [rad]; the pose is that of its projection."""

    def with_base_at(self, x: float, y: float, yaw: float) -> Mount:
        """The same pose, told from where its base sits at x, y [m] and is turned by yaw [rad].

        A path that was freed of this mount, though the sensor sits otherwise, is that of a point of
        the robot that is not its base. If that is at x, y, yaw, the sensor sits as is returned.
        """
        place = complex(x, y) + complex(self.x, self.y) * cmath.exp(1j * yaw)
        turned = math.remainder(self.yaw + yaw, math.tau)
        return self._replace(x=place.real, y=place.imag, yaw=turned)
