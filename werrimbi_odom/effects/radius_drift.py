# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Radii that change during a drive."""

from __future__ import annotations

from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.effect import Parameter, Sketch, wheel_effect
from werrimbi_odom.model.motion import Number, WheelTravel


@wheel_effect(
    sketch=Sketch(
        "shrinking", "the wheels get smaller with time", "the wheels wear, warm or lose pressure"
    ),
    per_metre=Parameter(
        "1/m",
        null=0.0,
        typical=3e-4,
        bounds=(-0.004, 0.004),
        says="relative growth of both radii per metre of path",
    ),
    per_second=Parameter(
        "1/s",
        null=0.0,
        typical=1e-4,
        bounds=(-1.5e-3, 1.5e-3),
        says="relative growth of both radii per second since the drive began",
    ),
)
def radius_drift(
    travel: WheelTravel[Number], drive: Drive[Number], per_metre: float, per_second: float
) -> WheelTravel[Number]:
    """Both wheels swell or shrink steadily during the drive: warmth, pressure, wear.

    Each drive begins with the radii of the robot file. A straight law holds about as long as the
    drives that it was fitted on, not for a lifetime; more than 8 % in 20 m, or 9 % in a minute, is
    no tyre.

    Formula    travel *= 1 + per_metre * distance + per_second * time       [m] = [m] * [1]
    Signature  a scale error that grows from the drive's beginning to its end
    Ruler      chalk a wheel and roll it ten turns along a tape, before the drive and right after
    Alike      wheel_radius_scale, on short drives; per_metre and per_second, at one steady speed:
               drive long, with rests
    """
    grown = 1.0 + per_metre * drive.distance.mean + per_second * drive.time.mean
    return WheelTravel(travel.left * grown, travel.right * grown)
