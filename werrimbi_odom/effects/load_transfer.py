# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Tyres that deflect as the load moves between them."""

from __future__ import annotations

from werrimbi_odom.effects.wheel_force import accelerations
from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.effect import Parameter, Sketch, wheel_effect
from werrimbi_odom.model.motion import Number, WheelTravel


@wheel_effect(
    sketch=Sketch(
        "load", "in a curve the outer tyre is pressed flat", "the load moves to the outer wheel"
    ),
    lateral=Parameter(
        "s^2/m",
        null=0.0,
        typical=0.01,
        bounds=(-0.2, 0.2),
        says="relative loss of the outer wheel's radius, and gain of the inner one's, per "
        "centripetal acceleration",
    ),
    longitudinal=Parameter(
        "s^2/m",
        null=0.0,
        typical=0.01,
        bounds=(-0.2, 0.2),
        says="relative loss of both radii per forward acceleration; negative where the driven "
        "wheels are the front ones",
    ),
)
def load_transfer(
    travel: WheelTravel[Number], drive: Drive[Number], lateral: float, longitudinal: float
) -> WheelTravel[Number]:
    """The load moves to the outer wheel in a curve, to the rear as the robot gains speed.

    A tyre under more load is a spring pressed deeper, so it rolls on a smaller radius: the outer
    one in a curve, and the inner one on a larger. In proportion to the height of the centre of mass
    over the base, and to how soft tyres are.

    Formula    left *= 1 + lateral * speed * yaw rate;  right *= 1 - lateral * speed * yaw rate
               travel -= longitudinal * speed of the wheel * change of the robot's speed
               [m] = [m] * [s^2/m] * [m/s^2]
    Signature  fast curves fall short of their turn by a share that grows with the square of the
               speed, slow ones and spins are right; lines lose way as the robot gains speed
    Ruler      drive ten laps of one circle by the odometry, at a crawl, then fast: the fast ones
               turn less than the crawl by 20 pi * 2 * lateral * speed^2 / base
    Alike      turn_dependent_track, when curves are all driven at one speed: drive slow and fast
               ones. longitudinal_slip, when driven forwards alone: it turns its sign backwards.
               tyre_squash, in turns, which are all that a gyro sees: drive fast lines beside a
               reference of positions
    """
    shifted = lateral * drive.speed.end * drive.yaw_rate.end
    gained = longitudinal * accelerations(drive, turning=0.0)[0] * drive.duration
    return WheelTravel(
        travel.left * (1.0 + shifted) - gained * drive.left_smooth_speed.mean,
        travel.right * (1.0 - shifted) - gained * drive.right_smooth_speed.mean,
    )
