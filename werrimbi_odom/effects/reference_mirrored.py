# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Set-up mistake: a reference in a left-handed frame."""

from __future__ import annotations

from werrimbi_odom.effects.indistinguishable_pairs import turning_the_wrong_way
from werrimbi_odom.model.effect import Sketch, reference_effect
from werrimbi_odom.model.reference_view import View


@reference_effect(
    twins=(turning_the_wrong_way("wheels_swapped"),),
    sketch=Sketch(
        "mirrored", "the reference's frame is left-handed", "the reference's y points the other way"
    ),
)
def reference_mirrored(view: View) -> View:
    """The reference's frame is left-handed: y points down, or east and north are exchanged.

    Images have y down, maps have north up and count clockwise, and some capture systems do both; a
    lidar that hangs upside down sees so, where no transform of its recording says that it does.

    Formula    measured y = -y;  measured yaw = -yaw (x and y exchanged is the same, turned)
    Signature  left turns come out as right turns of the same size; lines are good
    Ruler      push the robot from the reference's origin along x, then to the left: y must grow;
               turn it to the left: yaw must grow
    """
    return view._replace(mirrored=not view.mirrored)
