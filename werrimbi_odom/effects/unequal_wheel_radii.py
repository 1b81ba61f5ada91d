# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Wheels of different size: UMBmark's E_d."""

from __future__ import annotations

from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.effect import Parameter, Sketch, wheel_effect
from werrimbi_odom.model.motion import Number, WheelTravel


@wheel_effect(
    sketch=Sketch(
        "unequal", "one wheel is larger than the other", "equal counts, unequal ways: a line bends"
    ),
    ratio=Parameter(
        "", null=1.0, typical=1.005, bounds=(1e-4, 1e4), says="right over left radius (E_d)"
    ),
)
def unequal_wheel_radii(
    travel: WheelTravel[Number], drive: Drive[Number], ratio: float
) -> WheelTravel[Number]:
    """One wheel is larger than the other, so the robot bends to a side where it should go straight.

    Rubber tyres of one batch differ by some tenths of a percent, and so does their wear and load.
    Near 2 or 4, one encoder's resolution or gear is entered wrongly.

    Formula    left *= 2 / (1 + ratio);  right *= 2 ratio / (1 + ratio)      [m] = [m] * [1]
    Signature  heading gained in proportion to distance, taken back when driving backwards; turns on
               the spot are good; squares driven left and right go wrong in opposite ways
    Ruler      drive 3 m straight by the odometry along a chalk line and measure how far left of it
               the robot ends: ratio - 1 = 2 * base * offset / distance^2
    Twins      left_wheel_radius_multiplier and right_wheel_radius_multiplier of the robot file
               hold the same ratio
    """
    return WheelTravel(
        travel.left * (2.0 / (1.0 + ratio)), travel.right * (2.0 * ratio / (1.0 + ratio))
    )
