# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Radii that depend on a measured channel."""

from __future__ import annotations

from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.effect import Parameter, Sketch, wheel_effect
from werrimbi_odom.model.motion import Number, WheelTravel

AS_ENTERED = 20.0
"""Temperature at which the radii are those of the robot file [degrees Celsius]; the standard
reference temperature for lengths (ISO 1)."""

TEMPERATURE, PAYLOAD = "temperature", "payload"
"""Words in the name of a column that identify its quantity."""


@wheel_effect(
    one_of_channels=(TEMPERATURE, PAYLOAD),
    sketch=Sketch(
        "by_channel", "the radius follows a thermometer", "radii follow what is measured beside"
    ),
    temperature=Parameter(
        "1/K",
        null=0.0,
        typical=1e-3,
        bounds=(-0.02, 0.02),
        says="relative growth of both radii per kelvin above 20 degrees Celsius",
    ),
    payload=Parameter(
        "1/kg",
        null=0.0,
        typical=2e-3,
        bounds=(-0.05, 0.05),
        says="relative growth of both radii per kilogram; negative where tyres give way",
    ),
)
def radius_by_channel(
    travel: WheelTravel[Number], drive: Drive[Number], temperature: float, payload: float
) -> WheelTravel[Number]:
    """Both radii follow what is measured beside the counters: warmth, or a payload.

    Rubber swells with warmth, and the air in it even more; tyres give way under a load. A column of
    ticks.csv is known by its name: one with "temperature" in it (degrees Celsius), or "payload"
    (kilograms); of several of a kind their mean counts. The node has the counters alone, so this
    works on recorded runs.

    Formula    travel *= 1 + temperature * (T - 20) + payload * load
               [m] = [m] * ([1/K] * [K] + [1/kg] * [kg])
    Signature  a scale error of all ways that comes and goes with the column, on lines and in curves
    Ruler      chalk a wheel and roll it ten turns along a tape, cold and warm, empty and loaded:
               the distance differs by the coefficient times the column's change
    Alike      radius_drift, where the column rises or falls steadily along the drives: drive once
               more when it is back where it was, or longer, until it does not go on so
    """
    grown = (
        1.0
        + temperature * _measured(drive, TEMPERATURE, AS_ENTERED)
        + payload * _measured(drive, PAYLOAD)
    )
    return WheelTravel(travel.left * grown, travel.right * grown)


def _measured(drive: Drive[Number], word: str, above: float = 0.0) -> Number | float:
    """Mean of the columns with a word in their names, minus `above`; 0 if there is none."""
    found = [drive.channels[name].mean for name in drive.channels if word in name.lower()]
    return sum(found[1:], found[0]) / len(found) - above if found else 0.0
