# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Tyres that creep outwards in curves."""

from __future__ import annotations

from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.effect import Parameter, Sketch, body_effect
from werrimbi_odom.model.motion import BodyMotion, Number


@body_effect(
    sketch=Sketch(
        "slip_outwards",
        "in a curve the robot creeps outwards",
        "in a curve the tyres creep outwards",
    ),
    creep=Parameter(
        "s",
        null=0.0,
        typical=2e-3,
        bounds=(-0.1, 0.1),
        says="outward speed per speed times yaw rate",
    ),
)
def lateral_slip(
    motion: BodyMotion[Number], drive: Drive[Number], creep: float
) -> BodyMotion[Number]:
    """In a curve tyres carry the centripetal force, and rubber does so only by creeping outwards.

    A value beyond 0.1 s is no tyre's. Half a sampling interval betrays a reference that was itself
    integrated from wheel speeds by plain Euler steps.

    Formula    sideways -= creep * speed * turn                      [m] = [s] * [m/s] * [rad]
    Signature  a sideways error that grows with speed times yaw rate; none on lines or on the spot
    Ruler      from one chalk mark drive half a circle slowly, then the same fast: the fast one ends
               farther along the direction of the start, by 2 * creep * difference of the speeds (a
               whole circle closes all the same)
    Alike      reference_lever_arm along x, when all curves are driven at one speed: drive slow and
               fast ones
    """
    return motion._replace(sideways=motion.sideways - creep * drive.speed.end * motion.turn)
