# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A reference with late stamps, or with a clock that runs at another rate."""

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
        # As of reference_delay: derivatives are differences over a share of it, and what both do to
        # a heading is alike only over the same counts.
        typical=0.03,
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


@reference_effect(
    sketch=Sketch(
        "late",
        "the reference's clock runs fast, or slow",
        "the reference tells the same, later and later",
        ("counters", "reference"),
    ),
    extends="reference_delay",
    delay=Parameter(
        "s",
        null=0.0,
        typical=0.03,
        bounds=(-5.0, 5.0),
        says="by which its stamps are late as the drive begins",
        per_run=True,
    ),
    rate=Parameter(
        "s/s",
        null=0.0,
        typical=1e-3,
        bounds=(-0.02, 0.02),
        says="what its clock gains on the encoders' in a second",
        per_run=True,
    ),
)
def reference_clock_drift(view: View, delay: float, rate: float) -> View:
    """The reference's clock runs faster or slower than the encoders': no two run alike.

    Two recordings that were begun by hand differ by some delay, and by more and more from then on,
    in each drive by others: clocks without NTP or PTP gain 10 to 100 millionths on each other, a
    microcontroller's up to a hundredth. Rows that were stamped by counting, at a rate that the
    sensor did not keep, do the same. Which of the two clocks is off cannot be told.

    Formula    measured(t) = true(t - delay - rate * t), t since the drive began         [s]
    Signature  the reference lags by speed times a delay that grows along a drive; by its middle it
               may be right, and early before
    Ruler      let both record for two minutes, with a jolt by hand at the begin and at the end: the
               time between the jolts differs by 120 s * rate
    Alike      wheel_radius_scale and track_width, at one speed: stop now and then; reference_delay,
               in short drives: drive for two minutes
    """
    return view._replace(delay=view.delay + delay, clock_drift=view.clock_drift + rate)
