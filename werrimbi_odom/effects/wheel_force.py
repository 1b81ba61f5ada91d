# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Force that a wheel must pass to the floor in a start, along and of a turn.

With mass m, moment of inertia I about the vertical and base b it is m a / 2 along and I alpha / b
in a turn, against each other on the two sides. In units of m / 2 that is the acceleration of the
robot along, and `TURNING` times what the wheel's own has beyond it.
"""

from __future__ import annotations

from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.effect import Parameter
from werrimbi_odom.model.motion import Number

TURNING = Parameter(
    "",
    null=1.0,
    typical=1.0,
    bounds=(0.0, 4.0),
    says="share that counts of a wheel's acceleration beyond the robot's: moment of inertia over "
    "mass * (base / 2)^2",
    tries=(1.0,),
    refines=True,
)
"""1 where the masses stand over the wheels, 0.3 to 0.8 where they stand between them, more on a
body that is longer than the base: 3.3 at three times."""


def accelerations(drive: Drive[Number], turning: float) -> tuple[Number, Number]:
    """Accelerations of the rims that count as force, left and right [m/s^2].

    Of the smoothed speeds: those of single messages are of counters' steps and of stamps that
    scatter, and a law of them is noise (of an engine's drives with 100 counts a turn, slip that
    reads them explains 10 to 30 % less, and a late clock takes the rest).
    """
    apart = 0.5 * (1.0 - turning) * (drive.right_acceleration - drive.left_acceleration)
    return drive.left_acceleration + apart, drive.right_acceleration - apart
