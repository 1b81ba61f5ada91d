# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Tyres that creep longitudinally under the force of acceleration."""

from __future__ import annotations

from werrimbi_odom.model.drive import Drive, Span
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
)
def longitudinal_slip(
    travel: WheelTravel[Number], drive: Drive[Number], coefficient: float
) -> WheelTravel[Number]:
    """A driving tyre rolls more than it travels, a braking one less, in proportion to the force.

    Rubber carries a force along only by creeping. What is lost while the robot gains speed comes
    back while it brakes, so it is behind its odometry only while it moves. The coefficient is the
    mass on the wheel over the tyre's stiffness.

    Formula    travel -= coefficient * change of (speed * |speed| / 2), each wheel for itself
               [m] = [s^2/m] * [m^2/s^2]
    Signature  an error along that follows the acceleration; none at steady speed, none at rest
    Ruler      lay a tape along the floor and film the robot beside it: at speed it is behind its
               odometry by coefficient * speed^2 / 2, at rest it is not
    Alike      reference_delay and encoder_skew, when driven at one speed: drive slow and fast lines
               with hard starts and stops
    """
    return WheelTravel(
        travel.left - coefficient * _gained(drive.left_speed),
        travel.right - coefficient * _gained(drive.right_speed),
    )


def _gained(speed: Span[Number]) -> Number:
    """Integral of the acceleration over the rolled path, from both ends of the step."""
    return 0.5 * (speed.end * abs(speed.end) - speed.start * abs(speed.start))
