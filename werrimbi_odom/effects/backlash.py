# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Backlash between an encoder and its wheel."""

from __future__ import annotations

from werrimbi_odom.effects.functions import limited, saturated
from werrimbi_odom.model.drive import Drive, Span
from werrimbi_odom.model.effect import Parameter, Sketch, wheel_effect
from werrimbi_odom.model.motion import Number, WheelTravel
from werrimbi_odom.model.right_wheel_effect import on_the_right

TRAVEL = Parameter(
    "m", null=0.0, typical=2e-3, bounds=(0.0, 0.05), says="free travel at the rim, stop to stop"
)


@wheel_effect(
    sketch=Sketch(
        "backlash",
        "play between the left encoder and its wheel",
        "after each reversal the encoder turns alone first",
        ("left",),
    ),
    travel=TRAVEL,
)
def left_backlash(
    wheels: WheelTravel[Number], drive: Drive[Number], travel: float
) -> WheelTravel[Number]:
    """The left encoder turns freely against its wheel for a while whenever the wheel reverses.

    Play in gears, couplings, keys and belts: the first of the travel after each reversal is the
    encoder's alone. Before the first reversal nobody knows where in its play the wheel stands, so
    half of it, the fair guess, is taken from the first motion.

    Formula    left -= direction * change of min(s, travel)          [m]
               s: travel of the wheel since it reversed, direction: 1 forwards, -1 backwards
    Signature  after each reversal of the left wheel, in spins too, the same piece of its travel is
               missing
    Ruler      hold the encoder's shaft (or let the motor brake) and turn the left wheel by hand
               from stop to stop: the travel of a chalk mark on the tread
    Alike      castor_kick, when driven to and fro only: drive spins both ways; encoder_skew and
               reference_delay, when driven at one speed: drive slowly and fast
    """
    lost = _taken_up(drive.left_since_reversal, drive.left_reversals, travel)
    return wheels._replace(left=wheels.left - drive.left_direction * lost)


@on_the_right(left_backlash)
def right_backlash(
    wheels: WheelTravel[Number], drive: Drive[Number], travel: float
) -> WheelTravel[Number]:
    """As `left_backlash`, of the right wheel."""
    lost = _taken_up(drive.right_since_reversal, drive.right_reversals, travel)
    return wheels._replace(right=wheels.right - drive.right_direction * lost)


def _taken_up(since: Span[Number], reversals: Number, travel: float) -> Number:
    """Part of the play that is taken up in the step [m]."""
    play = travel * limited(0.5 + 0.5 * reversals, 0.5, 1.0)
    return saturated(since.end, play) - saturated(since.start, play)
