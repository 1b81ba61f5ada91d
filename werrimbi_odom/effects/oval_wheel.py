# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A wheel that is not round: an error twice a turn of that wheel."""

from __future__ import annotations

from werrimbi_odom.effects.functions import sin
from werrimbi_odom.model.drive import Drive, Span
from werrimbi_odom.model.effect import Parameter, Sketch, wheel_effect
from werrimbi_odom.model.motion import Number, WheelTravel

AMPLITUDE = Parameter(
    "m",
    null=0.0,
    typical=1e-3,
    bounds=(0.0, 0.02),
    says="half the difference between its largest and its smallest radius",
)
PHASE = Parameter(
    "rad",
    null=0.0,
    typical=1.0,
    bounds=(-3.1415927, 3.1415927),
    says="twice the angle by which the wheel has turned, at counter zero, since its largest radius "
    "stood upright",
    per_run=True,
)


@wheel_effect(
    sketch=Sketch(
        "oval",
        "the left wheel is not round",
        "the left wheel leads and lags twice a turn",
        ("left",),
    ),
    quadrature=("amplitude", "phase"),
    amplitude=AMPLITUDE,
    phase=PHASE,
)
def oval_left_wheel(
    travel: WheelTravel[Number], drive: Drive[Number], amplitude: float, phase: float
) -> WheelTravel[Number]:
    """The left wheel is not round: its lever to the floor is longer, and shorter, twice in a turn.

    A tyre that stood under its load, a rim that was hit, a wheel printed or cast askew. The wheel
    leads and lags twice in each of its turns and loses nothing over a half one; what it is longer
    round than its mean radius says is calibration. The phase belongs to the counter; where that
    starts anywhere, each drive has a phase of its own.

    Formula    left += amplitude / 2 * change of sin(2 * left wheel's angle + phase)       [m]
    Signature  heading and distance swing twice in each turn of the left wheel, whatever the speed
    Ruler      lift the robot, hold a block close to the tread and turn the wheel by hand: the gap
               varies by twice the amplitude, from widest to narrowest in a quarter of a turn
    Alike      oval_right_wheel, as long as both wheels turn alike: drive curves. An axle off the
               centre (eccentric_left_wheel) swings once in a turn
    """
    return travel._replace(left=travel.left + _lead(drive.left_angle, amplitude, phase))


@wheel_effect(
    sketch=Sketch(
        "oval",
        "the right wheel is not round",
        "the right wheel leads and lags twice a turn",
        ("right",),
    ),
    quadrature=("amplitude", "phase"),
    amplitude=AMPLITUDE,
    phase=PHASE,
)
def oval_right_wheel(
    travel: WheelTravel[Number], drive: Drive[Number], amplitude: float, phase: float
) -> WheelTravel[Number]:
    """The right wheel is not round: its lever to the floor is longer, and shorter, twice in a turn.

    A tyre that stood under its load, a rim that was hit, a wheel printed or cast askew. The wheel
    leads and lags twice in each of its turns and loses nothing over a half one; what it is longer
    round than its mean radius says is calibration. The phase belongs to the counter; where that
    starts anywhere, each drive has a phase of its own.

    Formula    right += amplitude / 2 * change of sin(2 * right wheel's angle + phase)     [m]
    Signature  heading and distance swing twice in each turn of the right wheel, whatever the speed
    Ruler      lift the robot, hold a block close to the tread and turn the wheel by hand: the gap
               varies by twice the amplitude, from widest to narrowest in a quarter of a turn
    Alike      oval_left_wheel, as long as both wheels turn alike: drive curves. An axle off the
               centre (eccentric_right_wheel) swings once in a turn
    """
    return travel._replace(right=travel.right + _lead(drive.right_angle, amplitude, phase))


def _lead(angle: Span[Number], amplitude: float, phase: float) -> Number:
    """The integral of (lever - mean lever) over the angle, by its ends: exact at any rate."""
    return 0.5 * amplitude * (sin(2.0 * angle.end + phase) - sin(2.0 * angle.start + phase))
