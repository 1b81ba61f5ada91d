# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A castor that drags the robot round wherever it swings: at reversals, into curves and spins."""

from __future__ import annotations

from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.effect import Parameter, Sketch, body_effect
from werrimbi_odom.model.motion import BodyMotion, Number


@body_effect(
    sketch=Sketch(
        "castor",
        "wherever the castor swings, it drags the robot round",
        "the castor swings and drags the robot round",
    ),
    drag=Parameter(
        "",
        null=0.0,
        typical=0.01,
        bounds=(-0.2, 0.2),
        says="heading gained per angle by which the castor swings against the body",
    ),
)
def castor_swing(
    motion: BodyMotion[Number], drive: Drive[Number], drag: float
) -> BodyMotion[Number]:
    """A castor that is stiff, or grips the floor, drags the robot round whenever it swings.

    Its wheel scrubs on the floor while its fork turns, and the drive wheels hold against that only
    by creeping. A castor swings by a quarter turn when a line goes over into a spin, and by half a
    turn when the robot reverses, to the side to which the last curve has left it: not always the
    same. Its angle is that of a trailer, 0.15 wheel separations behind a pivot that is 0.6 of them
    behind the axle. One of other lengths swings at nearly the same places, and so does one in front
    of the axle, with the other sign; the fitted number is then three quarters of its drag, in front
    of the axle a half to two thirds (simulated). After a long straight line, chance decides to
    which side it swings: single kicks are left.

    Formula    turn += drag * change of the castor's angle      [rad] = [1] * [rad]
               d angle = -turn - (along * sin(angle) + 0.6 separation * turn * cos(angle)) / trail,
               trail = 0.15 separation
    Signature  heading lost or gained where the motion changes its kind: from a line into a spin,
               after a reversal; none in a long line, a long curve, a long spin
    Ruler      turn the castor by hand to the front, a little to the left, and drive 0.3 m forwards
               along a chalk line; then the same with the castor a little to the right: each time
               the robot ends turned by pi * drag against the line, once to each side
    Alike      castor_kick, which is the same to the same side at each reversal, and nothing in
               spins; turn_dependent_track, in drives of short spins between lines
    """
    return motion._replace(turn=motion.turn + drag * drive.castor_angle.change)
