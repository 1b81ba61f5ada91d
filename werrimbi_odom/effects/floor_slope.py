# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A floor that displaces the robot in one direction."""

from __future__ import annotations

from werrimbi_odom.effects.functions import cos, limited, sin, sinc
from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.effect import Parameter, Sketch, body_effect
from werrimbi_odom.model.motion import BodyMotion, Number


@body_effect(
    sketch=Sketch("slope", "the floor leans", "drifts to one side of the room, whatever it faces"),
    x=Parameter(
        "m/m", null=0.0, typical=5e-3, bounds=(-0.2, 0.2), says="drift along x per metre of path"
    ),
    y=Parameter(
        "m/m", null=0.0, typical=5e-3, bounds=(-0.2, 0.2), says="drift along y per metre of path"
    ),
    x_rate=Parameter(
        "m/s", null=0.0, typical=1e-3, bounds=(-0.1, 0.1), says="drift along x per second"
    ),
    y_rate=Parameter(
        "m/s", null=0.0, typical=1e-3, bounds=(-0.1, 0.1), says="drift along y per second"
    ),
)
def floor_slope(
    motion: BodyMotion[Number],
    drive: Drive[Number],
    x: float,
    y: float,
    x_rate: float,
    y_rate: float,
) -> BodyMotion[Number]:
    """The floor leans, or moves, so the robot drifts towards one side of the room.

    On a slope tyres creep downhill with every metre they roll; a carpet's pile does the same, a
    conveyor carries all the time. x and y are those of the frame in which the heading is given: the
    reference's. A node whose frame starts anywhere must be told where it stands.

    Formula    displacement += (x, y) * path + (x_rate, y_rate) * duration
               [m] = [m/m] * [m] + [m/s] * [s]
    Signature  an error towards one direction of the room, whatever the robot's heading
    Ruler      drive a line of 5 m along a chalk mark, turn round, drive it back: both times the
               robot ends off the mark on the same side of the room. A marble rolls there too
    """
    path = drive.distance.change
    drift_x = x * path + x_rate * drive.duration
    drift_y = y * path + y_rate * drive.duration
    # The twist of a step is later turned into the chord of an arc, which is shorter by sinc and
    # rotated by half the turn. Both are compensated here, so that the drift itself is straight.
    half = 0.5 * motion.turn
    facing = drive.heading.start + half
    shrink = limited(sinc(half), 0.1, 1.0)
    ahead = (cos(facing) * drift_x + sin(facing) * drift_y) / shrink
    left = (cos(facing) * drift_y - sin(facing) * drift_x) / shrink
    return BodyMotion(motion.along + ahead, motion.sideways + left, motion.turn)
