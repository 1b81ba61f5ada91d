# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Yaw rate of a gyro that may be mounted on its side."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.pose import Floats

TILTED = math.radians(30.0)
"""Angle between an IMU's z axis and the vertical beyond which it is assumed to be mounted on its
side. Wheeled robots tilt less, and a smaller angle only scales the yaw rate, which is fitted.
Upside-down mounting is said, not mended: too many drivers invert the accelerometer's sign."""
GRAVITY = (5.0, 15.0)
"""Plausible range of the mean specific force [m/s^2]: half to one and a half times gravity. Other
values have other units, or nothing was measured."""
UPSIDE_DOWN = (
    "upside down (z downwards) by its accelerometer, if that has the right sign; its turning about "
    "its z axis is taken as it is, and then is of the wrong sign"
)
_FEWEST = 20
_SIDES = ("x", "y", "z")


def yaw_rate(rates: Floats, forces: NDArray[np.float64]) -> tuple[Floats, str]:
    """Rotation rate about the vertical, as given by the accelerometer.

    `rates` (n, 3): rates of the gyro [rad/s]. `forces` (m, 3): specific forces of the accelerometer
    [m/s^2]; m may be 0. Result: rate about the z axis if that is vertical or the vertical is
    unknown. The words are the end of a sentence; "" if there is nothing to say.
    """
    known = forces[np.isfinite(forces).all(axis=1)]
    if len(known) < _FEWEST:
        return rates[:, 2], ""
    up = np.median(known, axis=0)
    size = float(np.linalg.norm(up))
    if not GRAVITY[0] < size < GRAVITY[1] or up[2] / size > math.cos(TILTED):
        return rates[:, 2], ""
    if -up[2] / size > math.cos(TILTED):
        return rates[:, 2], UPSIDE_DOWN
    main = int(np.argmax(np.abs(up)))
    axis = f"{'minus ' if up[main] < 0.0 else ''}{_SIDES[main]}"
    aside = math.degrees(math.acos(min(abs(up[main]) / size, 1.0)))
    where = f"its {axis} axis" if aside < 10.0 else f"{aside:.0f}° from its {axis} axis"
    words = (
        f"mounted on its side: by its accelerometer upwards is {where}, and its turning about that"
    )
    return rates @ (up / size), f"{words} is taken"
