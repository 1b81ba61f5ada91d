# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""An effective wheel base that differs from the nominal one."""

from __future__ import annotations

from werrimbi_odom.effects.indistinguishable_pairs import own_scale, radii_over_base
from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.effect import Parameter, Sketch, body_effect
from werrimbi_odom.model.motion import BodyMotion, Number


@body_effect(
    twins=(radii_over_base("wheel_radius_scale"), own_scale("reference_scale", inverse=True)),
    sketch=Sketch(
        "track",
        "the wheels' contact points are farther apart than entered",
        "the wheels stand on the floor wider apart",
    ),
    multiplier=Parameter(
        "", null=1.0, typical=1.02, bounds=(1e-4, 1e4), says="effective over assumed wheel base"
    ),
)
def track_width(
    motion: BodyMotion[Number], drive: Drive[Number], multiplier: float
) -> BodyMotion[Number]:
    """The wheels turn the robot as if they stood farther apart, or closer, than is assumed.

    A wide or soft tyre touches the floor along a line, not at a point, and which part of it carries
    the turn depends on load and wear. Near 2, 1/2, 1000 or the like, a diameter, a half base or
    millimetres stand in the robot file.

    Formula    turn /= multiplier                                    [rad] = [rad] / [1]
    Signature  every turn is off by the same share, left and right, fast and slow; lines are good
    Ruler      spin ten turns by the odometry from a chalk line on the floor: the robot falls short
               of the line by 20 pi * (1 - 1 / multiplier)
    Twins      wheel_separation_multiplier of the robot file is the same number
    """
    return motion._replace(turn=motion.turn / multiplier)
