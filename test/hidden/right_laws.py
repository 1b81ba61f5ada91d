# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Effects outside the library with their right laws, as a user who knew them would write them."""

from __future__ import annotations

from werrimbi_odom.effects.shapes import mean_cos, mean_sin, share_inside, standing
from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.effect import Effect, Parameter, body_effect, wheel_effect
from werrimbi_odom.model.motion import BodyMotion, Number, WheelTravel

HALF_BASE = 0.175
"""Of the robot of `werrimbi simulate` [m]."""

GROWTH = Parameter("1/kPa", 0.0, 3e-4, (-0.01, 0.01), "relative growth of the radius")


@wheel_effect(channels=("left_tyre_kpa",), growth=GROWTH)
def right_law_of_the_left_pressure(
    travel: WheelTravel[Number], drive: Drive[Number], growth: float
) -> WheelTravel[Number]:
    """The left tyre leaks."""
    beyond = drive.channels["left_tyre_kpa"].mean - 180.0
    return travel._replace(left=travel.left * (1.0 + growth * beyond))


@wheel_effect(channels=("right_tyre_kpa",), growth=GROWTH)
def right_law_of_the_right_pressure(
    travel: WheelTravel[Number], drive: Drive[Number], growth: float
) -> WheelTravel[Number]:
    """The right tyre leaks."""
    beyond = drive.channels["right_tyre_kpa"].mean - 180.0
    return travel._replace(right=travel.right * (1.0 + growth * beyond))


@body_effect(
    channels=("payload_kg",),
    broadening=Parameter("1/kg", 0.0, 3e-3, (-0.05, 0.05), "relative growth of the base"),
)
def right_law_of_the_payload(
    motion: BodyMotion[Number], drive: Drive[Number], broadening: float
) -> BodyMotion[Number]:
    """A payload presses tyres broad."""
    wider = 1.0 + broadening * drive.channels["payload_kg"].mean
    return motion._replace(turn=motion.turn / wider)


LOSS = Parameter("", 0.0, 0.01, (-0.1, 0.1), "share of the radius that is lost backwards")


@wheel_effect(loss=LOSS)
def right_law_of_the_left_tread(
    travel: WheelTravel[Number], drive: Drive[Number], loss: float
) -> WheelTravel[Number]:
    """The left tyre is mounted against its tread."""
    return travel._replace(left=travel.left * (1.0 - loss * (drive.left_speed.end < 0.0)))


@wheel_effect(loss=LOSS)
def right_law_of_the_right_tread(
    travel: WheelTravel[Number], drive: Drive[Number], loss: float
) -> WheelTravel[Number]:
    """The right tyre is mounted against its tread."""
    return travel._replace(right=travel.right * (1.0 - loss * (drive.right_speed.end < 0.0)))


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


@body_effect(
    channels=("tilt_rad", "payload_kg"),
    creep=Parameter("", 0.0, 0.05, (-1.0, 1.0), "way downhill per radian and kilogram"),
)
def right_law_of_the_tilt(
    motion: BodyMotion[Number], drive: Drive[Number], creep: float
) -> BodyMotion[Number]:
    """Tyres creep downhill under their load."""
    lean = drive.channels["tilt_rad"].mean * drive.channels["payload_kg"].mean
    return motion._replace(sideways=motion.sideways - creep * lean * abs(motion.along))


FLATTENING = Parameter("", 0.0, 0.2, (-5.0, 5.0), "loss of radius per kilogram over kilopascal")


@wheel_effect(channels=("payload_kg", "left_tyre_kpa"), flattening=FLATTENING)
def right_law_of_the_left_flat(
    travel: WheelTravel[Number], drive: Drive[Number], flattening: float
) -> WheelTravel[Number]:
    """The left tyre leaks under a payload."""
    pressed = drive.channels["payload_kg"].mean / drive.channels["left_tyre_kpa"].mean
    return travel._replace(left=travel.left * (1.0 - flattening * pressed))


@wheel_effect(channels=("payload_kg", "right_tyre_kpa"), flattening=FLATTENING)
def right_law_of_the_right_flat(
    travel: WheelTravel[Number], drive: Drive[Number], flattening: float
) -> WheelTravel[Number]:
    """The right tyre leaks under a payload."""
    pressed = drive.channels["payload_kg"].mean / drive.channels["right_tyre_kpa"].mean
    return travel._replace(right=travel.right * (1.0 - flattening * pressed))


RIGHT_LAWS: dict[str, tuple[Effect, ...]] = {
    "slippery_spot": (right_law_of_the_spot,),
    "cable_pull": (right_law_of_the_cable,),
    "one_tyre_by_pressure": (right_law_of_the_left_pressure, right_law_of_the_right_pressure),
    "base_by_payload": (right_law_of_the_payload,),
    "one_tyre_backwards": (right_law_of_the_left_tread, right_law_of_the_right_tread),
    "slide_by_tilt_and_payload": (right_law_of_the_tilt,),
    "one_tyre_by_load_over_pressure": (right_law_of_the_left_flat, right_law_of_the_right_flat),
}
"""By the names of what can be hidden; of several the likeliest is right."""

DEPENDS_ON = {
    "slippery_spot": ("position",),
    "cable_pull": ("heading",),
    "one_tyre_by_pressure": ("left_tyre_kpa", "right_tyre_kpa"),
    "base_by_payload": ("payload_kg",),
    "one_tyre_backwards": ("direction",),
    "slide_by_tilt_and_payload": ("tilt_rad", "payload_kg"),
    "one_tyre_by_load_over_pressure": ("payload_kg", "left_tyre_kpa", "right_tyre_kpa"),
}
"""The variables that are right."""
