# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Set-up mistakes: counters on the wrong wheel, or counting backwards."""

from __future__ import annotations

from werrimbi_odom.effects.indistinguishable_pairs import turning_the_wrong_way
from werrimbi_odom.model.effect import Sketch, wiring_mistake
from werrimbi_odom.model.right_wheel_effect import on_the_right
from werrimbi_odom.model.wiring import Wiring


@wiring_mistake(
    twins=(turning_the_wrong_way("reference_mirrored"),),
    sketch=Sketch(
        "swapped", "left and right counters are exchanged", "left and right counters are exchanged"
    ),
)
def wheels_swapped(wiring: Wiring) -> Wiring:
    """The counter that is recorded as left belongs to the right wheel, and the other way round.

    Two plugs are exchanged, or left was taken for looking at the robot from the front.

    Formula    left, right = right, left
    Signature  left turns come out as right turns of the same size; lines are good
    Ruler      push the robot round its right wheel, by hand: the left counter must run, and grow
    """
    return wiring._replace(swapped=not wiring.swapped)


@wiring_mistake(
    sketch=Sketch(
        "wrong_sign",
        "the left counter has the wrong sign",
        "driving forwards, the left counter falls",
        ("left",),
    )
)
def left_wheel_reversed(wiring: Wiring) -> Wiring:
    """The left counter counts backwards while its wheel rolls forwards.

    Motors on the two sides are mounted facing each other, so one of the encoders must be negated
    somewhere; here it was not, or twice.

    Formula    left = -left
    Signature  straight driving comes out as spinning on the spot, and spins as straight driving
    Ruler      push the robot forwards by hand: both counters must grow
    Alike      right_wheel_reversed, on a robot that drives stern first before a mirrored reference:
               push it forwards and look
    """
    return wiring._replace(left_sign=-wiring.left_sign)


@on_the_right(left_wheel_reversed)
def right_wheel_reversed(wiring: Wiring) -> Wiring:
    """As `left_wheel_reversed`, of the right wheel."""
    return wiring._replace(right_sign=-wiring.right_sign)
