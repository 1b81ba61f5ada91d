# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A reference with late stamps."""

from __future__ import annotations

from werrimbi_odom.model.effect import Parameter, Sketch, reference_effect
from werrimbi_odom.model.reference_view import View


@reference_effect(
    sketch=Sketch(
        "late",
        "the reference's stamps are late",
        "the reference tells the same, later",
        ("counters", "reference"),
    ),
    delay=Parameter(
        "s",
        null=0.0,
        typical=0.03,
        bounds=(-5.0, 5.0),
        says="what the reference stamps t, it saw at t - delay",
    ),
)
def reference_delay(view: View, delay: float) -> View:
    """The reference's clock is offset against the encoders': a network, a driver, two computers.

    Which of the two clocks is off cannot be told, and need not be.

    Formula    measured(t) = true(t - delay)                         [s]
    Signature  the reference lags by speed times delay, and its yaw by yaw rate times delay
    Ruler      drive a line to and fro past one chalk mark, at one speed: where the reference sees
               the mark passed differs by 2 * delay * speed between forth and back
    Alike      reference_lever_arm along x, on lines at one speed; longitudinal_slip, backlash of
               both wheels: drive slow and fast, with hard starts and stops, and spins
    """
    return view._replace(delay=view.delay + delay)


@reference_effect(
    sketch=Sketch(
        "late",
        "the reference's heading is later than its position",
        "the reference's heading comes after its position",
        ("its position", "its heading"),
    ),
    delay=Parameter(
        "s",
        null=0.0,
        typical=0.05,
        bounds=(-2.0, 2.0),
        says="by which its heading is later than its position",
    ),
)
def reference_heading_delay(view: View, delay: float) -> View:
    """The reference's heading is later than its position: a filter, a course from GPS, a gyro.

    Positions are measured; headings are often filtered from them, or integrated, and come late.

    Formula    measured yaw(t) = true yaw(t - delay)                 [s]
    Signature  heading lags by yaw rate times delay; positions are good; lines are good
    Ruler      spin left, then right, at one rate past a chalk line: the reference's yaw in passing
               it differs by 2 * delay * yaw rate between left and right
    Alike      lateral_slip, on a steady circle (creep = -delay): begin and end curves abruptly;
               reference_delay, where positions are poor: drive lines with hard starts and stops
    """
    return view._replace(heading_delay=view.heading_delay + delay)
