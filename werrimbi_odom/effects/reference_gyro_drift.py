# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A reference with the heading of a gyro, the bias of which drifts."""

from __future__ import annotations

from werrimbi_odom.model.effect import Parameter, Sketch, reference_effect
from werrimbi_odom.model.reference_view import View


@reference_effect(
    sketch=Sketch(
        "wandering_bias",
        "the reference's heading leaves the true one, faster and faster",
        "the gyro's heading leaves the true one",
    ),
    rate=Parameter(
        "rad/s^2",
        null=0.0,
        typical=3e-5,
        bounds=(-1e-3, 1e-3),
        says="by which the bias of its heading's rate grows, from none as a drive begins",
        per_run=True,
    ),
)
def reference_gyro_drift(view: View, rate: float) -> View:
    """The reference's heading is a gyro's, whose bias wanders along a drive.

    A gyro's bias goes with its chip's temperature, and the chip warms up, or cools in a draught: by
    0.01 to 0.1 degrees a second for each kelvin. What the bias is as the drive begins its driver
    has taken off, or (where headings alone are measured) is fitted for each drive; what it gains
    or loses from then on is this, in each drive by another rate.

    Formula    measured yaw = yaw + rate / 2 * t^2, t since the drive began       [rad]
    Signature  the heading is off by more and more, with the square of time, standing or not, and
               to either side in different drives
    Ruler      switch the robot on as for a drive and let it stand for two minutes: its reference's
               heading must stay; what it turned is rate / 2 * (120 s)^2
    Alike      radius_drift, as long as the robot turns at one rate: stand, drive lines and turn to
               both sides. Where headings alone are measured, a constant bias is fitted for each
               drive, and of this only what bends
    """
    return view._replace(wander=view.wander + rate)
