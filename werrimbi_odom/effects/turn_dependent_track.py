# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A wheel base that depends on the kind of turn."""

from __future__ import annotations

from werrimbi_odom.effects.functions import limited, share
from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.effect import Parameter, Sketch, body_effect
from werrimbi_odom.model.motion import BodyMotion, Number

STRAIGHT = 0.05
"""Sharpness below which the sense of turning has a reduced weight: on a line, jitter of the
counters turns the robot to and fro, which must not count as turns."""


@body_effect(
    sketch=Sketch(
        "two_bases", "spins and wide curves need another base", "each needs another base"
    ),
    sharpness=Parameter(
        "",
        null=0.0,
        typical=0.02,
        bounds=(-0.3, 0.3),
        says="growth of the base when spinning on the spot, less in wider curves",
    ),
    sense=Parameter(
        "",
        null=0.0,
        typical=0.01,
        bounds=(-0.3, 0.3),
        says="growth of the base in left turns, and as much shrinking in right ones",
    ),
)
def turn_dependent_track(
    motion: BodyMotion[Number], drive: Drive[Number], sharpness: float, sense: float
) -> BodyMotion[Number]:
    """The base that counts for turning is not one number: it grows in sharp turns, or to one side.

    When a wide tyre scrubs round, the point about which it turns wanders across the tread; and a
    robot that leans, or carries its load on one side, does so differently to the left and right.

    Formula    q = (right - left speed) / (|right| + |left| speed), from -1 to 1
               turn /= 1 + sharpness * |q| + sense * sign(q)         [rad] = [rad] / [1]
    Signature  turns on the spot need another base than wide curves, or left turns than right ones
    Ruler      spin ten turns by the odometry from a chalk line, left, then right: to the left
               40 pi * sense more is missing than to the right. Then ten turns in a wide circle:
               about 20 pi * sharpness less is missing
    Alike      track_width, when all turns are alike: drive spins and wide curves, both ways
    """
    left, right = drive.left_speed.end, drive.right_speed.end
    q = share(right - left, abs(right) + abs(left))
    base = 1.0 + sharpness * abs(q) + sense * limited(q / STRAIGHT, -1.0, 1.0)
    return motion._replace(turn=motion.turn / base)
