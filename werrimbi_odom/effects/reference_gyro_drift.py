# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A gyro whose bias wanders while it is driven."""

from __future__ import annotations

from werrimbi_odom.model.effect import Parameter, Sketch, reference_effect
from werrimbi_odom.model.reference_view import View


@reference_effect(
    sketch=Sketch(
        "wander",
        "a gyro's heading bends away from the true one",
        "the gyro's bias grows along the drive",
    ),
    rate=Parameter(
        "rad/s^2",
        null=0.0,
        typical=5e-5,
        bounds=(-0.02, 0.02),
        says="growth of the gyro's bias each second",
    ),
)
def reference_gyro_drift(view: View, rate: float) -> View:
    """The reference is a gyro, and its bias grows while the robot drives: it warms up.

    A bias that stays is found in each drive by itself and needs no effect. One that grows steadily
    is a straight law for a bend, good for as long as the drives that it was fitted on: a gyro is
    warm after some minutes. Its noise, by which it wanders to and fro, is told with the noise.

    Formula    measured yaw += rate * t^2 / 2, t since the drive's first heading     [rad]
               where headings alone are measured
    Signature  the heading bends away with the square of the time, in rest as in motion, to the
               same side in each drive
    Ruler      let the robot stand as long as a drive takes, switched on as before one: the gyro's
               heading at the middle is off the line between begin and end by rate * t^2 / 8
    Alike      turns that are off by a share (track_width, reference_scale), where a robot turns one
               way ever faster: turn both ways, and stand for a while
    """
    return view._replace(wander=view.wander + rate)
