# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A wheel that is not round: an error with half the period of the wheel's rotation."""

from __future__ import annotations

from werrimbi_odom.effects.functions import limited, share, sin
from werrimbi_odom.model.drive import Drive, Span
from werrimbi_odom.model.effect import Parameter, Sketch, wheel_effect
from werrimbi_odom.model.motion import Number, WheelTravel
from werrimbi_odom.model.right_wheel_effect import on_the_right

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
    leads and lags twice in each of its turns; an ellipse is also a little longer round than a
    circle of its mean radius. The phase belongs to the counter; where that starts anywhere, each
    drive has a phase of its own.

    Formula    left += amplitude / 2 * change of sin(2 * left wheel's angle + phase)
               + (amplitude / radius)^2 / 4 * left                                 [m]
    Signature  heading and distance swing twice in each turn of the left wheel, whatever the speed
    Ruler      lift the robot, hold a block close to the tread and turn the wheel by hand: the gap
               varies by twice the amplitude, from widest to narrowest in a quarter of a turn
    Alike      oval_right_wheel, as long as both wheels turn alike: drive curves. An axle off the
               centre (eccentric_left_wheel) swings once in a turn
    """
    more = _more(travel.left, drive.left_angle, amplitude, phase)
    return travel._replace(left=travel.left + more)


@on_the_right(oval_left_wheel)
def oval_right_wheel(
    travel: WheelTravel[Number], drive: Drive[Number], amplitude: float, phase: float
) -> WheelTravel[Number]:
    """As `oval_left_wheel`, of the right wheel."""
    more = _more(travel.right, drive.right_angle, amplitude, phase)
    return travel._replace(right=travel.right + more)


def _more(travel: Number, angle: Span[Number], amplitude: float, phase: float) -> Number:
    """Integral of (lever - mean radius) over the angle, from its ends: exact at any message rate.

    Half the circumference of an ellipse with half axes r (1 + e) and r (1 - e) is pi r (1 + e^2 /
    4), up to e^4 / 64 (Ivory 1798); 1 / r is the step's angle over its travel. In the play of a
    backlash hardly any travel is left, so e is kept below 1.
    """
    turned = angle.end - angle.start
    lead = sin(2.0 * angle.end + phase) - sin(2.0 * angle.start + phase)
    e = limited(amplitude * share(turned, travel), -1.0, 1.0)
    return 0.5 * amplitude * lead + 0.25 * amplitude * turned * e
