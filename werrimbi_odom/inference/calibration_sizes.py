# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Three multipliers, three effects: base and both radii of a robot under two names.

A robot file has them as multipliers, UMBmark's C_B, C_L and C_R; the library as effects,
`track_width`, `unequal_wheel_radii` (E_d) and `wheel_radius_scale`, which a file may hold as well.
The base goes by a third name where it is an effect's own parameter (`Parameter.as_base`): that of
`skid_steer`.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS, changed
from werrimbi_odom.inference.rules import CUT_ANEW
from werrimbi_odom.model.effect import AppliedEffect, Effect
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

LOGARITHMS = {
    "track_width": (1.0, 0.0, 0.0),
    "unequal_wheel_radii": (0.0, -1.0, 1.0),
    "wheel_radius_scale": (0.0, 0.5, 0.5),
}
"""How the logarithm of each calibration effect is made of those of the three multipliers."""


class Sizes(NamedTuple):
    """True over nominal base, left and right radius."""

    base: float
    left: float
    right: float

    def over(self, others: Sizes) -> Sizes:
        """These over others."""
        return Sizes(*(one / other for one, other in zip(self, others, strict=True)))

    @property
    def as_effects(self) -> dict[str, float]:
        """The number of each calibration effect that does the same."""
        return {
            "track_width": self.base,
            "unequal_wheel_radii": self.right / self.left,
            "wheel_radius_scale": 0.5 * (self.left + self.right),
        }


def sizes_of(robot: Robot) -> Sizes:
    """A robot's multipliers, with the calibration effects that it holds."""
    base, left, right = (float(getattr(robot, name)) for name in MULTIPLIERS)
    for applied in robot.effects:
        key = base_name(applied.effect)
        if key is not None:
            base *= applied.values[key]
        elif applied.name == "track_width":
            base *= applied.values["multiplier"]
        elif applied.name == "wheel_radius_scale":
            left, right = (side * applied.values["multiplier"] for side in (left, right))
        elif applied.name == "unequal_wheel_radii":
            ratio = applied.values["ratio"]
            left, right = left * 2.0 / (1.0 + ratio), right * 2.0 * ratio / (1.0 + ratio)
    return Sizes(base, left, right)


def with_sizes_in_multipliers(robot: Robot, given: Robot) -> Robot:
    """The robot with the calibration effects that the given file does not hold as multipliers."""
    held = {item.name for item in given.effects}
    moved = [item for item in robot.effects if item.name in LOGARITHMS and item.name not in held]
    if not moved:
        return robot
    effects = tuple(item for item in robot.effects if item not in moved)
    sizes = sizes_of(replace(robot, effects=tuple(moved)))
    return changed(replace(robot, effects=effects), dict(zip(MULTIPLIERS, sizes, strict=True)))


def to_cut_by(robot: Robot, given: Robot) -> Robot:
    """By whose travel a fit cuts its legs: the given file's, unless its sizes are far off.

    Parameters
    ----------
    robot
        With what the search for set-up mistakes found.
    """
    found = with_sizes_in_multipliers(robot, given)
    off = max(abs(math.log(one)) for one in sizes_of(found).over(sizes_of(given)))
    return found if off > math.log(CUT_ANEW) else robot


def base_name(effect: Effect) -> str | None:
    """The parameter of an effect that is the base by another name; None where there is none."""
    return next((name for name, item in effect.parameters.items() if item.as_base), None)


def name_of_base(robot: Robot) -> str:
    """The effect by whose name a robot's base is told."""
    named = (item.name for item in robot.effects if base_name(item.effect) is not None)
    return next(named, "track_width")


def skidding(robot: Robot) -> bool:
    """Whether a robot is known to skid as it turns: wheels on a side, or an effect in its file."""
    return robot.wheels_a_side > 1 or name_of_base(robot) != "track_width"


def base_told(applied: AppliedEffect, robot: Robot, given: Robot) -> float:
    """What an effect's own name of the base comes to: all that the base differs by, it says.

    Parameters
    ----------
    robot : Robot
        It holds `applied`.
    given : Robot
        The file, whose multiplier stays as it stands there.
    """
    name = base_name(applied.effect)
    assert name is not None
    before = next((item for item in given.effects if item.name == applied.name), None)
    value = sizes_of(robot).base / sizes_of(given).base
    value *= 1.0 if before is None else before.values[name]
    low, high = applied.effect.parameters[name].bounds
    return min(max(value, low), high)


def calibration_deviation(robot: Robot, given: Robot) -> Floats:
    """How far base, radii's ratio and radii's mean are from the given ones, in logarithms."""
    relative = sizes_of(robot).over(sizes_of(given))
    return np.asarray(np.array(list(LOGARITHMS.values())) @ np.log(relative))


def std_as_effect(name: str, robot: Robot, covariance: Floats) -> float:
    """Standard deviation of a calibration effect's logarithm, from the multipliers' covariance.

    Parameters
    ----------
    covariance : ndarray, shape (3, 3)
        Of the multipliers of the `robot`, in the order of `MULTIPLIERS`.
    """
    row = np.array(LOGARITHMS[name]) / [getattr(robot, multiplier) for multiplier in MULTIPLIERS]
    return float(np.sqrt(max(row @ covariance @ row, 0.0)))
