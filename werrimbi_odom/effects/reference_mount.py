# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A reference that measures another point, or another axis, than the robot's."""

from __future__ import annotations

from werrimbi_odom.effects.indistinguishable_pairs import askew
from werrimbi_odom.model.effect import Parameter, Sketch, reference_effect
from werrimbi_odom.model.reference_view import View


@reference_effect(
    sketch=Sketch(
        "lever_arm",
        "another point than the axle's middle is measured",
        "spinning on the spot moves the measured point",
    ),
    x=Parameter(
        "m", null=0.0, typical=0.05, bounds=(-5.0, 5.0), says="ahead of the axle's midpoint"
    ),
    y=Parameter(
        "m", null=0.0, typical=0.05, bounds=(-5.0, 5.0), says="left of the axle's midpoint"
    ),
)
def reference_lever_arm(view: View, x: float, y: float) -> View:
    """The reference measures another point of the robot than the middle between its wheels.

    A marker, a laser or an aerial is where there was room for it. When the robot turns, that point
    swings round.

    Formula    measured point = axle's midpoint + x ahead + y to the left             [m]
    Signature  on the spot the reference goes round a circle; on lines nothing is wrong
    Ruler      tape from the middle between the wheels to the marker, along the robot and across it
    Twins      y: a midpoint that is not the middle. Where one wheel stands farther from the marker
               than the other, the axle's midpoint is off by half the difference: the same thing.
               Driven wheels that skid may turn the robot about another point than their middle
               (skid_steer, the same x and y with the other sign): the same thing too
    Alike      lateral_slip at a steady speed (x = -creep * speed); reference_delay on lines at one
               speed (x = -delay * speed): spin on the spot
    """
    return view._replace(ahead=view.ahead + x, left=view.left + y)


@reference_effect(
    twins=(askew("sideways_drift"),),
    sketch=Sketch(
        "yaw_offset", "the reference's forward axis is askew", "the marker is mounted askew"
    ),
    angle=Parameter(
        "rad",
        null=0.0,
        typical=0.02,
        bounds=(-3.1415927, 3.1415927),
        says="from the robot's forward axis to the reference's, anticlockwise",
    ),
)
def reference_yaw_offset(view: View, angle: float) -> View:
    """The reference's forward axis is not the robot's: its marker or laser is mounted askew.

    By some milliradians where it was mounted by eye; by 90 or 180 degrees where it was mounted
    otherwise than entered.

    Formula    measured yaw = robot's yaw + angle                    [rad]
    Signature  the robot seems to travel at a constant angle to where it looks, forwards and back
    Ruler      chalk the robot's track on a line of 5 m and the marker's axis at its end: the angle
               between them
    Twins      At 180 degrees, also wheels_swapped with both wheels reversed: a robot that drives
               stern first. Look which end goes ahead
    """
    return view._replace(yaw=view.yaw + angle)
