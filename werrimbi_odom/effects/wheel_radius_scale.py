# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A common scale error of both radii."""

from __future__ import annotations

from werrimbi_odom.effects.indistinguishable_pairs import own_scale, radii_over_base
from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.effect import Parameter, Sketch, wheel_effect
from werrimbi_odom.model.motion import Number, WheelTravel


@wheel_effect(
    twins=(radii_over_base("track_width"), own_scale("reference_scale")),
    sketch=Sketch(
        "radius", "both wheels are larger than entered", "each turn goes farther than was entered"
    ),
    multiplier=Parameter(
        "", null=1.0, typical=1.01, bounds=(1e-4, 1e4), says="true over assumed wheel radius"
    ),
)
def wheel_radius_scale(
    travel: WheelTravel[Number], drive: Drive[Number], multiplier: float
) -> WheelTravel[Number]:
    """Both wheels are larger or smaller than is assumed, by the same factor.

    Worn or soft tyres make a percent. Near 2, 1/2, 4, pi, 57.3 or 1000, a diameter, counts times
    four, degrees or millimetres stand where they should not.

    Formula    left *= multiplier;  right *= multiplier              [m] = [m] * [1]
    Signature  every distance and every turn is off by the same share
    Ruler      drive straight between two chalk marks: multiplier = distance by tape / by odometry
    Twins      left_wheel_radius_multiplier and right_wheel_radius_multiplier of the robot file
               together. A reference whose own metre is wrong (reference_scale; a calibration board
               printed at 99 %) shows as this and track_width with the same multiplier: lay a tape
               beside it
    """
    return WheelTravel(travel.left * multiplier, travel.right * multiplier)
