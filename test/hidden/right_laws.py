# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Effects outside the library with their right laws, as a user who knew them would write them."""

from __future__ import annotations

from werrimbi_odom.effects.functions import cos
from werrimbi_odom.effects.shapes import mean_cos, mean_sin, mean_square, share_inside, standing
from werrimbi_odom.model.drive import Drive, Span
from werrimbi_odom.model.effect import Effect, Parameter, body_effect, wheel_effect
from werrimbi_odom.model.motion import BodyMotion, Number, WheelTravel

HALF_BASE = 0.175
"""Of the robot of `werrimbi simulate` [m]."""

AMPLITUDE = Parameter("m", null=0.0, typical=5e-4, bounds=(0.0, 0.02), says="lead of the wheel")
PHASE = Parameter("rad", 0.0, 1.0, (-3.1415927, 3.1415927), "of the oval", per_run=True)


@wheel_effect(
    channels=("wheel_temperature_c",),
    expansion=Parameter("1/K", 0.0, 1e-3, (-0.01, 0.01), "relative growth of the radii per kelvin"),
)
def right_law_of_temperature(
    travel: WheelTravel[Number], drive: Drive[Number], expansion: float
) -> WheelTravel[Number]:
    """Wheels swell with warmth."""
    growth = expansion * (drive.channels["wheel_temperature_c"].mean - 22.0)
    return WheelTravel(travel.left * (1.0 + growth), travel.right * (1.0 + growth))


@wheel_effect(
    channels=("payload_kg",),
    yielding=Parameter("1/kg", 0.0, 2e-3, (-0.02, 0.02), "relative loss of radius per kilogram"),
)
def right_law_of_payload(
    travel: WheelTravel[Number], drive: Drive[Number], yielding: float
) -> WheelTravel[Number]:
    """Tyres give way under a payload."""
    growth = -yielding * drive.channels["payload_kg"].mean
    return WheelTravel(travel.left * (1.0 + growth), travel.right * (1.0 + growth))


@wheel_effect(growth=Parameter("s^2/m^2", 0.0, 0.03, (-0.5, 0.5), "relative growth at 1 m/s"))
def right_law_of_speed(
    travel: WheelTravel[Number], drive: Drive[Number], growth: float
) -> WheelTravel[Number]:
    """Soft tyres grow with the square of their speed."""
    left, right = mean_square(drive.left_speed), mean_square(drive.right_speed)
    return WheelTravel(travel.left * (1.0 + growth * left), travel.right * (1.0 + growth * right))


@wheel_effect(quadrature=("amplitude", "phase"), amplitude=AMPLITUDE, phase=PHASE)
def right_law_of_the_left_oval(
    travel: WheelTravel[Number], drive: Drive[Number], amplitude: float, phase: float
) -> WheelTravel[Number]:
    """A left wheel pressed out of round."""
    return travel._replace(left=travel.left + _twice_a_turn(drive.left_angle, amplitude, phase))


@wheel_effect(quadrature=("amplitude", "phase"), amplitude=AMPLITUDE, phase=PHASE)
def right_law_of_the_right_oval(
    travel: WheelTravel[Number], drive: Drive[Number], amplitude: float, phase: float
) -> WheelTravel[Number]:
    """A right wheel pressed out of round."""
    return travel._replace(right=travel.right + _twice_a_turn(drive.right_angle, amplitude, phase))


def _twice_a_turn(angle: Span[Number], amplitude: float, phase: float) -> Number:
    return amplitude * (cos(2.0 * angle.start + phase) - cos(2.0 * angle.end + phase))


RATE = Parameter("rad/m", 0.0, 0.02, (-0.5, 0.5), "heading gained per metre")


@body_effect(east=RATE, north=RATE)
def right_law_of_the_cable(
    motion: BodyMotion[Number], drive: Drive[Number], east: float, north: float
) -> BodyMotion[Number]:
    """A cable drags the tail, so the robot turns towards one direction of the room."""
    pull = north * mean_cos(drive.heading) - east * mean_sin(drive.heading)
    return motion._replace(turn=motion.turn + drive.distance.change * pull)


PLACE = Parameter("m", 0.2, 0.5, (-3.0, 3.0), "its middle", tries=(-0.6, -0.2, 0.2, 0.6))


@wheel_effect(
    pose=True,
    loss=Parameter("", 0.0, 0.1, (-0.9, 0.9), "share of the travel that is lost"),
    x=PLACE,
    y=PLACE,
    radius=Parameter("m", 0.45, 0.45, (0.1, 1.0), "its size", tries=(0.45,)),
)
def right_law_of_the_spot(
    travel: WheelTravel[Number],
    drive: Drive[Number],
    loss: float,
    x: float,
    y: float,
    radius: float,
) -> WheelTravel[Number]:
    """A wheel on an oil stain travels less than it rolls."""
    left, right = (
        share_inside(*standing(drive, side), x, y, radius) for side in (HALF_BASE, -HALF_BASE)
    )
    return WheelTravel(travel.left * (1.0 - loss * left), travel.right * (1.0 - loss * right))


RIGHT_LAWS: dict[str, tuple[Effect, ...]] = {
    "radius_follows_temperature": (right_law_of_temperature,),
    "radius_follows_payload": (right_law_of_payload,),
    "radius_grows_with_speed": (right_law_of_speed,),
    "slippery_spot": (right_law_of_the_spot,),
    "cable_pull": (right_law_of_the_cable,),
    "oval_wheel": (right_law_of_the_left_oval, right_law_of_the_right_oval),
}
"""By the names of what can be hidden; of several the likeliest is right."""

DEPENDS_ON = {
    "radius_follows_temperature": ("wheel_temperature_c",),
    "radius_follows_payload": ("payload_kg",),
    "radius_grows_with_speed": ("speed", "wheel_speed"),
    "slippery_spot": ("position",),
    "cable_pull": ("heading",),
    "oval_wheel": ("left_wheel_angle_twice", "right_wheel_angle_twice"),
}
"""The variables that are right."""
