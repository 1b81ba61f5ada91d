# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Two counters that are read at different times."""

from __future__ import annotations

from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.effect import Parameter, Sketch, wheel_effect
from werrimbi_odom.model.motion import Number, WheelTravel


@wheel_effect(
    sketch=Sketch(
        "late",
        "the right counter is read later than the left",
        "the two counters are not read at one instant",
        ("left counter", "right counter"),
    ),
    delay=Parameter(
        "s",
        null=0.0,
        typical=5e-3,
        bounds=(-0.5, 0.5),
        says="by which the right counter is read later than the left one",
    ),
)
def encoder_skew(
    travel: WheelTravel[Number], drive: Drive[Number], delay: float
) -> WheelTravel[Number]:
    """The right counter is read later than the left one, so it shows what the wheel did since.

    Two boards on one bus, or two messages paired by their arrival. At speed the later wheel seems
    ahead; at rest all is well again.

    Formula    right -= delay * change of right speed                [m] = [s] * [m/s]
    Signature  the heading jumps by delay * speed / base when the robot starts, and back when it
               stops
    Ruler      lift the robot, press a board on both tyres and move it to and fro: the counters
               differ by delay * speed while it moves, and agree when it rests
    Alike      right_backlash, at one speed; reference_delay, on spins of one sense: drive slow and
               fast, lines and spins, with hard starts and stops
    """
    return travel._replace(right=travel.right - delay * drive.right_speed.change)
