# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What the engine's peculiarities are in the parameters of the library's effects."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from typing import Any

from werrimbi_odom.effects import find
from werrimbi_odom.effects.library import LIBRARY

Given = Mapping[str, Any]

GRAVITY = 9.81
"""[m/s^2]"""

SIXTH = math.pi / 3.0
"""Of a turn [rad]: for that the library tells how high a bump is. Drives hold height by width."""

_VALUES: dict[str, Callable[[Given], dict[str, float]]] = {
    "eccentric_left_wheel": lambda it: {"amplitude": it["amplitude"]},
    "eccentric_right_wheel": lambda it: {"amplitude": it["amplitude"]},
    "turn_dependent_track": lambda it: {
        name: it["coefficient"] * (it["on"] == name) for name in ("sharpness", "sense")
    },
    "floor_slope": lambda it: {
        "x": it["creep"] * math.cos(it["downhill"]),
        "y": it["creep"] * math.sin(it["downhill"]),
    },
    "castor_kick": lambda it: {
        "angle": it["angle"] * (not it["alternating"]),
        "alternating": it["angle"] * it["alternating"],
        "length": it["trail"],
    },
    "castor_swing": lambda it: {"drag": -math.copysign(it["drag"], it["drag"] * it["pivot"])},
    "radius_drift": lambda it: {
        name: it["rate"] * (it["per"] == per)
        for name, per in (("per_metre", "metre"), ("per_second", "second"))
    },
    "reference_yaw_offset": lambda it: {"angle": it["yaw"]},
    "reference_heading_delay": lambda it: {"delay": it["heading_delay"]},
    "oval_left_wheel": lambda it: {"amplitude": it["amplitude"]},
    "oval_right_wheel": lambda it: {"amplitude": it["amplitude"]},
    "left_tread_bump": lambda it: {"height": it["thickness"] * it["around"] / SIXTH},
    "right_tread_bump": lambda it: {"height": it["thickness"] * it["around"] / SIXTH},
    "radius_by_channel": lambda it: {
        "temperature": it.get("expansion", 0.0),
        "payload": -it.get("yielding", 0.0),
    },
    "tyre_squash": lambda it: {"coefficient": it["loss"]},
    "load_transfer": lambda it: {
        "lateral": it["softness"] * it["height"] / GRAVITY,
        "longitudinal": it["softness"] * it["length"] / GRAVITY,
    },
    "anisotropic_floor": lambda it: {
        "along_x": it["gain"] * math.cos(2.0 * it["grain"]),
        "diagonal": it["gain"] * math.sin(2.0 * it["grain"]),
    },
}


def values_of(effect: str, peculiarity: Given) -> dict[str, float]:
    """Parameters of a library effect that say what the engine did; empty where nobody knows.

    Where nothing is written here, those that are called the same on both sides.

    Parameters
    ----------
    peculiarity
        As truth.json has it under `parameters`.
    """
    if effect in _VALUES:
        return {name: float(value) for name, value in _VALUES[effect](peculiarity).items()}
    if effect not in {known.name for known in LIBRARY}:
        return {}
    return {
        name: float(peculiarity[name])
        for name in find(effect).parameters
        if isinstance(peculiarity.get(name), (int, float))
    }


def multipliers_of(truth: Given) -> dict[str, float]:
    """The robot file's multipliers that are right for a set, by its truth.json."""
    robot = truth["robot_before_hiding"]
    nominal = robot["nominal"]
    base = robot["wheel_separation"] / nominal["wheel_separation"]
    left = robot["left_wheel_radius"] / nominal["wheel_radius"]
    right = robot["right_wheel_radius"] / nominal["wheel_radius"]
    for hidden in truth["hidden"]:
        name, it = hidden["effect"], hidden["parameters"]
        if name == "track_width":
            base *= it["multiplier"]
        elif name == "wheel_radius_scale":
            left, right = left * it["multiplier"], right * it["multiplier"]
        elif name == "unequal_wheel_radii":
            left, right = left * 2 / (1 + it["ratio"]), right * 2 * it["ratio"] / (1 + it["ratio"])
    for key, factor in truth["entered"]:
        if key == "wheel_separation":
            base /= factor
        elif key == "wheel_radius":
            left, right = left / factor, right / factor
    return {
        "wheel_separation_multiplier": base,
        "left_wheel_radius_multiplier": left,
        "right_wheel_radius_multiplier": right,
    }


def noises_of(truth: Given, said: Collection[str] = ()) -> dict[str, float]:
    """The wheels' noise [m^0.5] that the engine made, of the wheels that a model calls so.

    None where a poorer reference was made of poses that had noise of their own, each for itself,
    and is used as one whose noise adds up: what of it does not grow with time passes for wheels'.
    Not that of a wheel which errs by chance in another way, too: where a wheel stands in its play
    as a drive begins nobody knows, nor at which of two speeds close by counts are lost. Made by the
    engine without any noise of the wheels, k of a wheel with a play of 5 mm is 6.7e-4, and of one
    that loses counts 2.6e-4 to 4.0e-4, of which no truth.json knows.

    Parameters
    ----------
    said
        Effects of the model. Wheels exchanged and a mirrored reference are twins; by the name of
        the other one left is right.
    """
    if truth["seen"] in ("scan_matcher", "gyro"):
        return {}
    robot = truth["robot_before_hiding"]
    names = [hidden["effect"] for hidden in truth["hidden"]]
    exchanged = bool(_EXCHANGING & set(names)) and not _EXCHANGING & set(names) & set(said)
    noisy = {name.partition("_")[0] for name in names if name.endswith(("_backlash", "_ticks"))}
    sides = {"left": "right", "right": "left"} if exchanged and said else {}
    return {
        f"{side}_wheel_noise": float(robot[f"{sides.get(side, side)}_wheel_noise"])
        for side in ("left", "right")
        if side not in noisy
    }


_EXCHANGING = {"wheels_swapped", "reference_mirrored"}

GIVES_WAY = (
    "left_backlash.travel",
    "right_backlash.travel",
    "castor_swing.drag",
)
"""The hidden castor has other lengths than the law's. And the engine's stops of a play are springs:
of a play of 1, 2 or 5 mm the robot feels 0.22 mm more while it drives steadily, and less of that
while it brakes. So the true ones are not known to within what a fit states."""
