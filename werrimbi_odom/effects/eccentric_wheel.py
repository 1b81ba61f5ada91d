# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""An axle off its wheel's centre: an error with the period of the wheel's rotation."""

from __future__ import annotations

from werrimbi_odom.effects.functions import cos
from werrimbi_odom.model.drive import Drive, Span
from werrimbi_odom.model.effect import Parameter, Sketch, wheel_effect
from werrimbi_odom.model.motion import Number, WheelTravel
from werrimbi_odom.model.right_wheel_effect import on_the_right

AMPLITUDE = Parameter(
    "m", null=0.0, typical=5e-4, bounds=(0.0, 0.02), says="from the axle to the wheel's centre"
)
PHASE = Parameter(
    "rad",
    null=0.0,
    typical=1.0,
    bounds=(-3.1415927, 3.1415927),
    says="how far the wheel has turned, at counter zero, since its centre was ahead of its axle",
    per_run=True,
)


@wheel_effect(
    sketch=Sketch(
        "eccentric",
        "the axle is off the left wheel's centre",
        "the left wheel leads and lags once a turn",
        ("left",),
    ),
    quadrature=("amplitude", "phase"),
    amplitude=AMPLITUDE,
    phase=PHASE,
)
def eccentric_left_wheel(
    travel: WheelTravel[Number], drive: Drive[Number], amplitude: float, phase: float
) -> WheelTravel[Number]:
    """The left wheel's axle misses its centre: its lever to the floor is now longer, now shorter.

    The wheel leads and lags once in each of its turns and loses nothing over a whole one. The phase
    belongs to the counter; where that starts anywhere, each drive has a phase of its own.

    Formula    left -= amplitude * change of cos(left wheel's angle + phase)           [m]
    Signature  heading and distance swing once in each turn of the left wheel, whatever the speed
    Ruler      lift the robot, hold a block close to the tread and turn the wheel by hand: the gap
               varies by twice the amplitude
    Alike      eccentric_right_wheel, as long as both wheels turn alike: drive curves
    """
    return travel._replace(left=travel.left + _lead(drive.left_angle, amplitude, phase))


@on_the_right(eccentric_left_wheel)
def eccentric_right_wheel(
    travel: WheelTravel[Number], drive: Drive[Number], amplitude: float, phase: float
) -> WheelTravel[Number]:
    """As `eccentric_left_wheel`, of the right wheel."""
    return travel._replace(right=travel.right + _lead(drive.right_angle, amplitude, phase))


def _lead(angle: Span[Number], amplitude: float, phase: float) -> Number:
    """Lead of the hub over rolling, from the ends of the step: exact at any message rate [m]."""
    return amplitude * (cos(angle.start + phase) - cos(angle.end + phase))
