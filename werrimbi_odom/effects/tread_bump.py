# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A bump or a flat at one place of the tread: an error while the wheel stands on it."""

from __future__ import annotations

import math

from werrimbi_odom.effects.functions import limited, within_half_a_turn
from werrimbi_odom.model.drive import Drive, Span
from werrimbi_odom.model.effect import Parameter, Sketch, wheel_effect
from werrimbi_odom.model.motion import Number, WheelTravel
from werrimbi_odom.model.right_wheel_effect import on_the_right

WIDTH = math.pi / 3.0
"""Angle of the wheel covered by the bump [rad]. Drives determine its height times its width, and
its place, but hardly its width. For true widths between a twelfth and a quarter of a turn, a width
of a sixth leaves at most a ninth of the effect unexplained."""

HEIGHT = Parameter(
    "m",
    null=0.0,
    typical=1.5e-3,
    bounds=(-0.01, 0.01),
    says="of a bump that goes a sixth of the way round; below zero: the depth of a flat",
    grain=1.0 / 3.0,
)
PLACE = Parameter(
    "rad",
    null=0.0,
    typical=1.0,
    bounds=(-3.1415927, 3.1415927),
    says="how far the wheel has turned, at counter zero, since it stood on the middle of it",
    per_run=True,
    tries=tuple(math.pi * (0.25 * eighth - 1.0) for eighth in range(8)),
)


@wheel_effect(
    sketch=Sketch(
        "tread_bump",
        "a bump on the left tread",
        "the left wheel gains on its bump, once a turn",
        ("left",),
    ),
    height=HEIGHT,
    place=PLACE,
)
def left_tread_bump(
    travel: WheelTravel[Number], drive: Drive[Number], height: float, place: float
) -> WheelTravel[Number]:
    """The left tread has a bump, or a flat, in one place: its lever to the floor is longer there.

    Tape or a patch on the tread, something that stuck to it, a flat from braking hard or from
    standing. While the wheel rolls on it, its hub stands higher and goes farther for the same
    angle; the radius of the robot file is that of the rest of the tread. A narrow high bump and a
    wide low one do the same to drives, so the height is told for a width of a sixth of a turn; of
    one that covers 30 to 90 degrees it is then out by up to a sixth; its ± allows for that. The
    place belongs to the counter; where that starts anywhere, each drive has a place of its own.

    Formula    left += height * angle that the left wheel turns while it stands on it    [m]
               (that is from -30 to 30 degrees of its angle + place, in each turn)
    Signature  heading and distance jump in one part of each turn of the left wheel, whatever the
               speed
    Ruler      lift the robot, hold a block close to the tread and turn the wheel by hand: the gap
               is even but for one place
    Alike      right_tread_bump, as long as both wheels turn alike: drive curves. An axle off the
               centre (eccentric_left_wheel) swings once in a turn as well, but evenly: a small
               bump is one to its drives, and more drives tell them apart. A flat across
               from it, with a radius that is larger by a third of its depth: what goes twice round
               in a turn tells the sign, and of a small one no few drives do
    """
    return travel._replace(left=travel.left + height * _gained(drive.left_angle, place))


@on_the_right(left_tread_bump)
def right_tread_bump(
    travel: WheelTravel[Number], drive: Drive[Number], height: float, place: float
) -> WheelTravel[Number]:
    """As `left_tread_bump`, of the right wheel."""
    return travel._replace(right=travel.right + height * _gained(drive.right_angle, place))


def _gained(angle: Span[Number], place: float) -> Number:
    """Angle turned on the bump in a step, from its ends: exact at any message rate [rad]."""
    return _turned_on_it(angle.end + place) - _turned_on_it(angle.start + place)


def _turned_on_it(angle: Number) -> Number:
    """Angle turned on the bump since its middle, including whole turns [rad]."""
    within = within_half_a_turn(angle)
    whole = WIDTH / (2.0 * math.pi) * (angle - within)
    return whole + limited(within, -0.5 * WIDTH, 0.5 * WIDTH)
