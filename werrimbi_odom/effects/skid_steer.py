# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Driven wheels, or tracks, that skid as the robot turns."""

from __future__ import annotations

from werrimbi_odom.effects.indistinguishable_pairs import (
    as_a_wider_base,
    turning_about_another_point,
)
from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.effect import Parameter, Sketch, body_effect
from werrimbi_odom.model.motion import BodyMotion, Number


@body_effect(
    twins=(turning_about_another_point("reference_lever_arm"), as_a_wider_base("track_width")),
    sketch=Sketch(
        "skid",
        "four wheels that skid: each side turns about a point outside its wheels",
        "each side's centre of rotation lies outside its wheels",
    ),
    multiplier=Parameter(
        "",
        null=1.0,
        typical=1.7,
        bounds=(1.0, 4.0),
        says="effective over true distance of the two sides",
        as_base=True,
    ),
    x=Parameter(
        "m",
        null=0.0,
        typical=0.03,
        bounds=(-1.0, 1.0),
        says="the point it turns about on the spot, ahead of the wheels' middle",
    ),
    y=Parameter(
        "m",
        null=0.0,
        typical=0.02,
        bounds=(-1.0, 1.0),
        says="the same point, left of the wheels' middle",
    ),
)
def skid_steer(
    motion: BodyMotion[Number], drive: Drive[Number], multiplier: float, x: float, y: float
) -> BodyMotion[Number]:
    """Driven wheels that cannot steer skid as the robot turns, so it turns less than they roll.

    That is what four driven wheels, or tracks, do; nothing is entered wrongly. The floor under each
    side turns about a point beside the wheels, its instantaneous centre of rotation, and these two
    points stay much where they are on one floor, at speeds where the robot does not slide (Mandow
    et al., IROS 2007; Martinez et al., Int. J. Robotics Research 24, 2005: tracks). They lie
    `multiplier` times as far apart as the two sides, 1.3 to 2.5 on most robots; where the load is
    not in the middle, their own middle is not the wheels'. Another floor, other tyres or another
    load make other values. The parameter files of such robots have it: Jackal 1.5, Husky 1.875.

    Formula    turn /= multiplier;  then  along += y * turn;  sideways -= x * turn  [rad], [m]
    Signature  every turn falls short by the same share, left and right; lines are good; on the spot
               the robot goes round a point that is not the middle between its wheels
    Ruler      spin ten turns by the odometry from a chalk line on the floor: the robot falls short
               of the line by 20 pi * (1 - 1 / multiplier). Go on spinning and mark the point of
               the body that stays over one place of the floor: it lies x ahead of the wheels'
               middle and y to its left
    Twins      multiplier: track_width, and wheel_separation_multiplier of the robot file, are the
               same number; four wheels tell which name is right
    Alike      lateral_slip, in curves at one speed (creep = x / speed): drive slow and fast ones
    """
    turn = motion.turn / multiplier
    return BodyMotion(motion.along + y * turn, motion.sideways - x * turn, turn)
