# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Tyres that creep longitudinally under the force of acceleration."""

from __future__ import annotations

from werrimbi_odom.effects.wheel_force import TURNING, accelerations
from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.effect import Parameter, Sketch, wheel_effect
from werrimbi_odom.model.motion import Number, WheelTravel


@wheel_effect(
    sketch=Sketch(
        "slip_ahead",
        "a driving tyre rolls more than it travels",
        "lost while speeding up, back while braking",
    ),
    coefficient=Parameter(
        "s^2/m",
        null=0.0,
        typical=0.01,
        bounds=(0.0, 0.3),
        says="share of a wheel's travel that is lost per acceleration of that wheel",
    ),
    turning=TURNING,
)
def longitudinal_slip(
    travel: WheelTravel[Number], drive: Drive[Number], coefficient: float, turning: float
) -> WheelTravel[Number]:
    """A driving tyre rolls more than it travels, a braking one less, in proportion to the force.

    Rubber carries a force along only by creeping. What is lost while the robot gains speed comes
    back while it brakes, so it is behind its odometry only while it moves. The coefficient is the
    mass on the wheel over the tyre's stiffness. The mass resists a start along; a start of a turn
    only the moment of inertia does, so most robots, with their mass in the middle, slip less in it.

    Formula    travel -= coefficient * integral of the acceleration over the path rolled, back while
               it brakes: turning * the wheel's own + (1 - turning) * that of the robot along
               [m] = [s^2/m] * [m^2/s^2]
    Signature  an error along that follows the acceleration; none at steady speed, none at rest
    Ruler      lay a tape along the floor and film the robot beside it: at speed it is behind its
               odometry by coefficient * speed^2 / 2, at rest it is not
    Alike      reference_delay and encoder_skew, when driven at one speed: drive slow and fast lines
               with hard starts and stops
    """
    share = coefficient * drive.duration
    left, right = accelerations(drive, turning)
    return WheelTravel(
        travel.left - share * left * abs(drive.left_smooth_speed.mean),
        travel.right - share * right * abs(drive.right_smooth_speed.mean),
    )
