# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A floor on which the distance per wheel turn depends on the direction."""

from __future__ import annotations

from werrimbi_odom.effects.shapes import mean_cos, mean_sin
from werrimbi_odom.model.drive import Drive, Span
from werrimbi_odom.model.effect import Parameter, Sketch, body_effect
from werrimbi_odom.model.motion import BodyMotion, Number


@body_effect(
    sketch=Sketch(
        "carpet", "a carpet has a grain", "a turn of the wheels is worth more along the grain"
    ),
    along_x=Parameter(
        "",
        null=0.0,
        typical=5e-3,
        bounds=(-0.2, 0.2),
        says="share by which the way along x is longer, and along y shorter, than in the mean",
    ),
    diagonal=Parameter(
        "",
        null=0.0,
        typical=5e-3,
        bounds=(-0.2, 0.2),
        says="share by which the way at 45 degrees to x is longer, and at -45 degrees shorter",
    ),
)
def anisotropic_floor(
    motion: BodyMotion[Number], drive: Drive[Number], along_x: float, diagonal: float
) -> BodyMotion[Number]:
    """The floor has a grain: a turn of the wheels is worth more along it than across it.

    Carpets and boards have ribs. Along them a tyre rolls on their crests, across them it climbs
    each one and sinks in between, which costs way. x and y are those of the frame in which the
    heading is given: the reference's. A node whose frame starts anywhere must be told where it
    stands. What is the same in all directions is wheel_radius_scale.

    Formula    along *= 1 + along_x * cos(2 * heading) + diagonal * sin(2 * heading)
               [m] = [m] * [1]
    Signature  lines along one direction of the room are too long, across it too short, to and fro
               alike; turns are right
    Ruler      drive 5 m by the odometry beside a tape, along the boards and across them: the two
               differ by 10 m * sqrt(along_x^2 + diagonal^2). Turn the carpet: the error turns too
    Alike      floor_slope, when driven one way only: it changes sign on the way back; a camera
               whose picture is longer along one axis: odometry and tape then agree along both
    """
    twice = Span(2.0 * drive.heading.start, 2.0 * drive.heading.end)
    share = along_x * mean_cos(twice) + diagonal * mean_sin(twice)
    return motion._replace(along=motion.along * (1.0 + share))
