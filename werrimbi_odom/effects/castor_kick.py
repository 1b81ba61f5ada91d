# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A castor that swings round after each reversal and changes the heading."""

from __future__ import annotations

from werrimbi_odom.effects.functions import exp
from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.effect import Parameter, Sketch, body_effect
from werrimbi_odom.model.motion import BodyMotion, Number


@body_effect(
    sketch=Sketch(
        "castor",
        "after a reversal the castor swings round",
        "the castor swings round and kicks the robot aside",
    ),
    angle=Parameter(
        "rad",
        null=0.0,
        typical=0.01,
        bounds=(-0.5, 0.5),
        says="heading gained after each reversal, of the same sign each time",
    ),
    alternating=Parameter(
        "rad",
        null=0.0,
        typical=0.01,
        bounds=(-0.5, 0.5),
        says="heading gained on turning forwards, and lost on turning backwards",
    ),
    length=Parameter(
        "m",
        null=0.04,
        typical=0.04,
        bounds=(0.001, 0.5),
        says="way over which the swing dies out by a factor e: about the castor's trail",
        tries=(0.01, 0.04, 0.15),
    ),
)
def castor_kick(
    motion: BodyMotion[Number],
    drive: Drive[Number],
    angle: float,
    alternating: float,
    length: float,
) -> BodyMotion[Number]:
    """When the robot reverses, its castor swings round to trail again and pushes the robot aside.

    The drive wheels hold against it only by creeping, so the heading is kicked while the castor
    swings, over about its own trail. Whether it always swings round by the same side, or is pushed
    back and forth, depends on how it is mounted.

    Formula    turn += (angle + alternating * direction) * change of (1 - exp(-s / length)),
               s: travel since the last reversal, direction: 1 forwards, -1 backwards     [rad]
    Signature  a kick of heading in the first centimetres after each reversal, none without one
    Ruler      drive 1 m along a chalk line to and fro, five times: after each reversal the robot
               stands at another angle to the line, by the kick; it adds up if of the same sign, and
               comes and goes if alternating
    Alike      left_backlash and right_backlash, when driven to and fro only: play is taken up by
               spins as well, so drive spins both ways; castor_swing, whose side is not always the
               same, and which acts in spins too
    """
    since = drive.since_reversal
    swing = (exp(since.start / -length) - exp(since.end / -length)) * (drive.reversals > 0.0)
    kick = angle + alternating * drive.direction
    return motion._replace(turn=motion.turn + kick * swing)
