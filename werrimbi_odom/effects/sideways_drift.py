# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A robot that drives at an angle to its forward axis."""

from __future__ import annotations

import math

from werrimbi_odom.effects.indistinguishable_pairs import askew
from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.effect import Parameter, Sketch, body_effect
from werrimbi_odom.model.motion import BodyMotion, Number


@body_effect(
    sketch=Sketch(
        "sideways", "the robot goes askew of where it faces", "the axle is not square to the body"
    ),
    twins=(askew("reference_yaw_offset"),),
    angle=Parameter(
        "rad",
        null=0.0,
        typical=0.01,
        bounds=(-0.3, 0.3),
        says="from the body's forward axis to the direction of travel, anticlockwise",
    ),
)
def sideways_drift(
    motion: BodyMotion[Number], drive: Drive[Number], angle: float
) -> BodyMotion[Number]:
    """The axle is not square to the body, so the robot travels at an angle to where it looks.

    Wheels roll where the axle lets them. The body, and all that is mounted on it, looks elsewhere
    by a constant angle.

    Formula    along, sideways = cos(angle) * along - sin(angle) * sideways,
               sin(angle) * along + cos(angle) * sideways            [m]
    Signature  a sideways error in proportion to signed distance; none on the spot; heading is good
    Ruler      drive 5 m straight and chalk the floor below the middle of bow and stern, before and
               after: the line between the bow marks is turned against the line from stern to bow by
               the angle
    """
    cos, sin = math.cos(angle), math.sin(angle)
    return BodyMotion(
        cos * motion.along - sin * motion.sideways,
        sin * motion.along + cos * motion.sideways,
        motion.turn,
    )
