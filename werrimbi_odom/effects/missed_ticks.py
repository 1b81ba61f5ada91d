# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""An encoder that loses counts above a speed."""

from __future__ import annotations

from werrimbi_odom.effects.functions import limited
from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.effect import Parameter, Sketch, wheel_effect
from werrimbi_odom.model.motion import Number, WheelTravel
from werrimbi_odom.model.right_wheel_effect import on_the_right

RAMP = 0.05
"""Width of the onset as a share of the threshold: a fit needs a slope to estimate the threshold,
and counted speeds just below it may be true or reduced ones."""

TYPICAL = 0.02
"""Share of the counts; counted speeds between the threshold and this below it are of either."""

FRACTION = Parameter(
    "", null=0.0, typical=TYPICAL, bounds=(0.0, 0.5), says="share of the counts that are lost"
)
ABOVE = Parameter(
    "m/s",
    null=0.3,
    typical=0.3,
    bounds=(0.01, 20.0),
    says="speed of the rim beyond which they are lost",
    tries=(0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.5, 0.6, 0.8, 1.0, 1.5, 2.0, 4.0, 8.0),
    grain=RAMP + TYPICAL,
)


@wheel_effect(
    sketch=Sketch(
        "lost_counts",
        "the left encoder loses counts",
        "above a speed the left encoder loses counts",
        ("left",),
    ),
    fraction=FRACTION,
    above=ABOVE,
)
def left_missed_ticks(
    travel: WheelTravel[Number], drive: Drive[Number], fraction: float, above: float
) -> WheelTravel[Number]:
    """The left encoder loses counts when its wheel turns fast.

    A counter that is read by interrupts, a filter on its lines or an optical disc at its limit lets
    a share of the marks slip by above some speed.

    Formula    left /= 1 - fraction, where |left speed| > above            [m] = [m] / [1]
               (setting in within 5 % of that speed)
    Signature  the left wheel goes farther than its counter says, above a speed and not below it
    Ruler      lift the robot, chalk the left tyre and let it turn a hundred times, slowly, then
               fast: the counter shows fewer counts when fast, by the fraction
    Alike      unequal_wheel_radii, when driven at one speed: drive slow and fast lines
    """
    return travel._replace(left=travel.left / (1.0 - _lost(drive.left_speed.end, fraction, above)))


@on_the_right(left_missed_ticks)
def right_missed_ticks(
    travel: WheelTravel[Number], drive: Drive[Number], fraction: float, above: float
) -> WheelTravel[Number]:
    """As `left_missed_ticks`, of the right wheel."""
    return travel._replace(
        right=travel.right / (1.0 - _lost(drive.right_speed.end, fraction, above))
    )


def _lost(counted: Number, fraction: float, above: float) -> Number:
    """Lost share at a counted speed: from zero well below the threshold to `fraction`."""
    threshold = above * (1.0 - 0.5 * fraction)  # as counted, with half the loss
    return fraction * limited(0.5 + (abs(counted) / threshold - 1.0) / RAMP, 0.0, 1.0)
