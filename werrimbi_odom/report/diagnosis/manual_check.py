# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Expected result of the manual check of an effect on this robot, from the fitted values.

Each is the formula of the effect's own Ruler section (`werrimbi explain`) at the fitted values.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping

from werrimbi_odom.effects.lookup import find
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.report.number_format import two_digits

SLOW, FAST = 0.1, 0.5
"""Speeds of a manual check [m/s], which any robot reaches."""

TURNS = 2.0 * math.pi * 10.0
"""Ten turns [rad]."""

Values = Mapping[str, float]


def expected_words(name: str, values: Values, robot: Robot) -> str:
    """A sentence without its full stop; "" if there is nothing to compute.

    Values are by the effect's parameters; per-run parameters are NaN or absent.
    """
    words = _EXPECTED.get(re.sub("(left|right)_", "", name))
    if words is None or not all(map(math.isfinite, _needed(name, values))):
        return ""
    return f"expect {words(values, robot)}"


def _needed(name: str, values: Values) -> list[float]:
    """All values except phases and per-run parameters, which a manual check does not need."""
    effect = find(name)
    phase = None if effect.quadrature is None else effect.quadrature[1]
    items = effect.parameters
    places = [key for key, item in items.items() if item.per_run and item.tries]
    return [value for key, value in values.items() if key not in (phase, *places)]


def _length(metres: float) -> str:
    size = abs(metres)
    if size >= 1.0:
        return f"{size:.2f} m"
    return f"{100.0 * size:.0f} cm" if size >= 0.1 else f"{two_digits(1e3 * size)} mm"


def _angle(radians: float) -> str:
    size = math.degrees(abs(radians))
    return f"{size:.0f}°" if size >= 10.0 else f"{size:.2g}°"


def _base(values: Values, robot: Robot) -> str:
    short = TURNS * (1.0 - 1.0 / values["multiplier"])
    if abs(short) > TURNS:  # a base that was entered more than twice too wide: no spin is needed
        apart = values["multiplier"] * robot.wheel_separation
        return f"the contact points of the wheels {_length(apart)} apart by a ruler"
    return f"{_angle(short)} {'short of it' if short > 0.0 else 'beyond it'} after ten turns"


def _radii(values: Values, robot: Robot) -> str:
    aside = (values["ratio"] - 1.0) * 3.0**2 / (2.0 * robot.track)
    return f"{_length(aside)} to the {'left' if aside > 0.0 else 'right'} on 3 m"


def _track(values: Values, robot: Robot) -> str:
    sense, sharp = 2.0 * TURNS * values["sense"], TURNS * values["sharpness"]
    parts = []
    if sense:
        parts.append(f"{_angle(sense)} {_more(sense)} missing to the left than to the right")
    if sharp:
        parts.append(f"{_angle(sharp)} {_more(-sharp)} missing in ten turns of a wide circle")
    return " and ".join(parts)


def _more(value: float) -> str:
    return "more" if value > 0.0 else "less"


def _aside(angle: float) -> str:
    side = "left" if angle > 0.0 else "right"
    return f"{_angle(angle)}, {_length(5.0 * angle)} to the {side} on 5 m"


def _slope(values: Values, robot: Robot) -> str:
    seconds = 5.0 / FAST
    x = 5.0 * values["x"] + seconds * values["x_rate"]
    y = 5.0 * values["y"] + seconds * values["y_rate"]
    side = _angle(math.atan2(y, x)) + (" right" if y < 0.0 else " left")
    return f"{_length(math.hypot(x, y))} on 5 m at {FAST} m/s, towards {side} of the room's x"


def _kick(values: Values, robot: Robot) -> str:
    each = [values["angle"] + values["alternating"] * sign for sign in (1.0, -1.0)]
    words = " and ".join(f"{math.degrees(kick):+.2g}°" for kick in each)
    total = 5.0 * sum(each)
    return f"{words} at reversals to forwards and to backwards, {_angle(total)} in all after five"


def _arm(values: Values, robot: Robot) -> str:
    x, y = values["x"], values["y"]
    parts = [f"{_length(x)} {'ahead' if x > 0.0 else 'behind'}"] if x else []
    parts += [f"{_length(y)} to the {'left' if y > 0.0 else 'right'}"] if y else []
    return " and ".join(parts)


def _drift(values: Values, robot: Robot) -> str:
    share = 20.0 * values["per_metre"] + 60.0 * values["per_second"]
    longer = TURNS * robot.wheel_radius * share
    return f"{_length(longer)} {_more(longer)} after a drive of 20 m in a minute"


def _by_channel(values: Values, robot: Robot) -> str:
    parts = [
        f"{_length(TURNS * robot.wheel_radius * values[name] * 10.0)} "
        f"{_more(values[name])} at 10 {unit} more"
        for name, unit in (("temperature", "K"), ("payload", "kg"))
        if values[name]
    ]
    return " and ".join(parts)


def _squash(values: Values, robot: Robot) -> str:
    lost = 10.0 * values["coefficient"] * (FAST**2 - SLOW**2)
    return f"{_length(lost)} {_more(-lost)} at {FAST} m/s than at {SLOW} m/s"


def _transfer(values: Values, robot: Robot) -> str:
    short = TURNS * 2.0 * values["lateral"] * FAST**2 / robot.track
    return f"{_angle(short)} {_more(-short)} in ten laps at {FAST} m/s"


def _grain(values: Values, robot: Robot) -> str:
    gain = math.hypot(values["along_x"], values["diagonal"])
    along = math.degrees(0.5 * math.atan2(values["diagonal"], values["along_x"]))
    side = "left" if along >= 0.0 else "right"
    return (
        f"{_length(10.0 * gain)} more on 5 m along the grain than across, which lies "
        f"{abs(along):.0f}° {side} of the room's x"
    )


def _bump(height: float) -> str:
    return f"{_length(height)} {'less' if height > 0.0 else 'more'} there, on a sixth of the turn"


def _spun(values: Values, robot: Robot) -> str:
    hard = 2.0 * values["above"]
    lost = values["coefficient"] * 0.25 * FAST**2
    return f"{_length(lost)} at {FAST} m/s after a start of {hard:.2g} m/s^2"


def _missed(values: Values, robot: Robot) -> str:
    speed = f"above {values['above']:.2f} m/s"
    return f"{100.0 * values['fraction']:.2g} turns too few of a hundred {speed}"


_EXPECTED: dict[str, Callable[[Values, Robot], str]] = {
    "skid_steer": _base,
    "track_width": _base,
    "unequal_wheel_radii": _radii,
    "wheel_radius_scale": lambda values, robot: (
        f"{10.0 / values['multiplier']:.3f} m by the odometry on 10.000 m of tape"
    ),
    "turn_dependent_track": _track,
    "floor_slope": _slope,
    "castor_kick": _kick,
    "castor_swing": lambda values, robot: f"{_angle(math.pi * values['drag'])} to either side",
    "reference_delay": lambda values, robot: (
        f"{_length(2.0 * values['delay'] * FAST)} at {FAST} m/s"
    ),
    "reference_lever_arm": _arm,
    "radius_drift": _drift,
    "missed_ticks": _missed,
    "backlash": lambda values, robot: _length(values["travel"]),
    "eccentric_wheel": lambda values, robot: _length(2.0 * values["amplitude"]),
    "oval_wheel": lambda values, robot: _length(2.0 * values["amplitude"]),
    "tread_bump": lambda values, robot: _bump(values["height"]),
    "reference_clock_drift": lambda values, robot: (
        f"{1000.0 * 120.0 * values['rate']:.0f} ms after two minutes"
    ),
    "reference_gyro_drift": lambda values, robot: (
        f"{_angle(0.5 * values['rate'] * 120.0**2)} after two minutes' rest"
    ),
    "radius_by_channel": _by_channel,
    "tyre_squash": _squash,
    "load_transfer": _transfer,
    "anisotropic_floor": _grain,
    "longitudinal_slip": lambda values, robot: (
        f"{_length(0.5 * values['coefficient'] * FAST**2)} at {FAST} m/s"
    ),
    "coulomb_slip": _spun,
    "lateral_slip": lambda values, robot: (
        f"{_length(2.0 * values['creep'] * (FAST - SLOW))} between {SLOW} and {FAST} m/s"
    ),
    "sideways_drift": lambda values, robot: _aside(values["angle"]),
    "reference_yaw_offset": lambda values, robot: _angle(values["angle"]),
    "reference_scale": lambda values, robot: f"{3600.0 * values['multiplier']:.0f}° of 3600°",
    "reference_heading_delay": lambda values, robot: f"{_angle(2.0 * values['delay'])} at 1 rad/s",
    "encoder_skew": lambda values, robot: f"{_length(values['delay'] * FAST)} at {FAST} m/s",
}
