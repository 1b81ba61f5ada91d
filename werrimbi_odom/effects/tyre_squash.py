# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Tyres with a rolling radius that depends on speed."""

from __future__ import annotations

from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.effect import Parameter, Sketch, wheel_effect
from werrimbi_odom.model.motion import Number, WheelTravel


@wheel_effect(
    sketch=Sketch(
        "squash", "a soft tyre is smaller at speed", "the rolling radius changes with speed"
    ),
    coefficient=Parameter(
        "s^2/m^2",
        null=0.0,
        typical=0.02,
        bounds=(-0.3, 0.3),
        says="relative loss of a wheel's radius per squared speed of its rim; negative: it grows",
    ),
)
def tyre_squash(
    travel: WheelTravel[Number], drive: Drive[Number], coefficient: float
) -> WheelTravel[Number]:
    """A soft tyre does not keep its radius at speed: it squashes, or the spin stretches it.

    Rubber that is rolled fast has no time to spring back behind its contact, so it rides lower; a
    light balloon tyre is thrown outwards instead and grows. Both go with the square of the speed,
    at a robot's speeds, and differ in sign. Each wheel goes by its own speed. A tyre that gives way
    under a payload is radius_by_channel, one that does so in curves load_transfer.

    Formula    travel *= 1 - coefficient * speed^2, each wheel for itself       [m] = [m] * [1]
    Signature  distances are too long at speed (negative: too short) and right at a crawl, forwards
               and backwards alike; turns too, more so with the outer wheel of a fast curve
    Ruler      drive 10 m by the odometry beside a tape, at 0.1 m/s, then fast: fast, it goes less
               far than slowly, by 10 m * coefficient * speed^2
    Alike      wheel_radius_scale, when driven at one speed: drive slow and fast lines.
               load_transfer, in turns, which are all that a gyro sees: drive fast lines beside a
               reference of positions
    """
    return WheelTravel(
        travel.left * (1.0 - coefficient * drive.left_speed.end * drive.left_speed.end),
        travel.right * (1.0 - coefficient * drive.right_speed.end * drive.right_speed.end),
    )
