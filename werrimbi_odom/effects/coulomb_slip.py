# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Tyres that grip up to a certain force and slip above it."""

from __future__ import annotations

import math

from werrimbi_odom.effects.functions import limited, sign
from werrimbi_odom.effects.wheel_force import TURNING, accelerations
from werrimbi_odom.model.drive import Drive, Span
from werrimbi_odom.model.effect import Parameter, Sketch, wheel_effect
from werrimbi_odom.model.motion import Number, WheelTravel

READ = 0.1
"""Width of what accelerations of counters leave open, of the size and of the threshold. The filter
before them rounds off each start, and takes 2 to 3.5 % of what lies above a threshold; steps of the
counters lift what lies just below it. Fits to starts of an engine, at 50 Hz and 2000 counts a turn,
are 1 to 6 % above the truth."""

LEAST = 0.1
"""Least threshold [m/s^2]: a friction of 0.01, where ice holds 0.02 and more. Below it a threshold
is no property of a floor: it leaves out what counters' steps do to an acceleration."""


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
        grain=READ,
    ),
    above=Parameter(
        "m/s^2",
        null=0.5,
        typical=0.5,
        bounds=(LEAST, 20.0),
        says="acceleration of the rim beyond which it slips",
        tries=(0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0, 1.3, 1.6, 2.0, 3.0, 5.0, 8.0),
        grain=READ,
    ),
    turning=TURNING,
)
def coulomb_slip(
    travel: WheelTravel[Number],
    drive: Drive[Number],
    coefficient: float,
    above: float,
    turning: float,
) -> WheelTravel[Number]:
    """A wheel slips above a force, and not below it: friction by Coulomb.

    A dry, hard tyre on a smooth floor holds until the force of its acceleration comes near what
    friction carries, and slides beyond; dust, wet tiles or little weight on the driven wheels let
    that come early. What is lost in a hard start comes back where the robot brakes as hard.

    Formula    travel -= coefficient * integral of (|acceleration| - above) over the path rolled,
               where |acceleration| > above; back while it brakes
               [m] = [s^2/m] * [m/s^2] * [m]
               acceleration: turning * the wheel's own + (1 - turning) * that of the robot along
    Signature  an error along after hard starts and stops, none after gentle ones, however fast
    Ruler      drive to a speed in a gentle start, then in a hard one, past a tape, filmed: the
               hard one is behind its odometry by coefficient * (1 - above / a) * speed^2 / 2
    Alike      longitudinal_slip, when all starts are as hard as one another; reference_delay, at
               one speed: drive gentle and hard starts
    """
    share = coefficient * drive.duration
    left, right = accelerations(drive, turning)
    return WheelTravel(
        travel.left - share * _lost(left, drive.left_smooth_speed, above),
        travel.right - share * _lost(right, drive.right_smooth_speed, above),
    )


def _lost(acceleration: Number, speed: Span[Number], above: float) -> Number:
    """Acceleration beyond the threshold times speed, both with the same delay."""
    return sign(acceleration) * limited(abs(acceleration) - above, 0.0, math.inf) * abs(speed.mean)
