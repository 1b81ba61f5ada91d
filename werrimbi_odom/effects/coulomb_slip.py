# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Tyres that hold up to a force, and slip above it."""

from __future__ import annotations

from werrimbi_odom.effects.functions import exp, limited, log, sign
from werrimbi_odom.model.drive import SMOOTHING, Drive, Span
from werrimbi_odom.model.effect import Parameter, Sketch, wheel_effect
from werrimbi_odom.model.motion import Number, WheelTravel


@wheel_effect(
    sketch=Sketch(
        "slip_above",
        "a tyre holds up to a force, and slips above it",
        "nothing is lost in gentle starts, more and more in hard ones",
    ),
    coefficient=Parameter(
        "s^2/m",
        null=0.0,
        typical=0.05,
        bounds=(0.0, 1.0),
        says="share of a wheel's travel that is lost per acceleration above the threshold",
    ),
    above=Parameter(
        "m/s^2",
        null=0.5,
        typical=0.5,
        bounds=(0.02, 20.0),
        says="acceleration of the rim beyond which it slips",
        tries=(0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0, 1.3, 1.6, 2.0, 3.0, 5.0, 8.0),
    ),
)
def coulomb_slip(
    travel: WheelTravel[Number], drive: Drive[Number], coefficient: float, above: float
) -> WheelTravel[Number]:
    """A wheel slips above a force, and not below it: friction by Coulomb.

    A dry, hard tyre on a smooth floor holds until the force of its acceleration comes near what
    friction carries, and slides beyond; dust, wet tiles or little weight on the driven wheels let
    that come early. What is lost in a hard start comes back where the robot brakes as hard.

    Formula    travel -= coefficient * integral of (|acceleration| - above) over the path rolled,
               where |acceleration| > above; each wheel for itself, back while it brakes
               [m] = [s^2/m] * [m/s^2] * [m]
    Signature  an error along after hard starts and stops, none after gentle ones, however fast
    Ruler      drive to a speed in a gentle start, then in a hard one, past a tape, filmed: the
               hard one is behind its odometry by coefficient * (1 - above / a) * speed^2 / 2
    Alike      longitudinal_slip, when all starts are as hard as one another; reference_delay, at
               one speed: drive gentle and hard starts
    """
    return WheelTravel(
        travel.left
        - coefficient
        * _beyond(drive.left_speed.end, drive.left_smooth_speed, drive.duration, above),
        travel.right
        - coefficient
        * _beyond(drive.right_speed.end, drive.right_smooth_speed, drive.duration, above),
    )


def _beyond(speed: Number, smooth: Span[Number], duration: Number, above: float) -> Number:
    """The integral of acceleration beyond a threshold over the path rolled.

    In a step of one speed the acceleration dies out as `smooth` comes up to it, so how long it
    stays beyond is a logarithm; steps cut in two come to the same.
    """
    lag = speed - smooth.start
    beyond = limited(abs(lag) / (above * SMOOTHING), 1.0, 1e12)
    lasts = limited(SMOOTHING * log(beyond), 0.0, duration)
    gained = abs(lag) * (1.0 - exp(-lasts / SMOOTHING)) - above * lasts
    return sign(lag) * gained * abs(speed)
