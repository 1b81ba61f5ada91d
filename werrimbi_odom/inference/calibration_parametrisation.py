# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Wheel base and both wheel radii, as multipliers and as effects.

A robot file holds them as UMBmark's multipliers C_B, C_L and C_R. The library holds them as the
effects `track_width`, `unequal_wheel_radii` (E_d) and `wheel_radius_scale`, which a file may hold
as well. The base has a third name where an effect has it as a parameter of its own
(`Parameter.as_base`), as `skid_steer` does.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS, changed
from werrimbi_odom.model.effect import AppliedEffect, Effect
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

LOGARITHMS = {
    "track_width": (1.0, 0.0, 0.0),
    "unequal_wheel_radii": (0.0, -1.0, 1.0),
    "wheel_radius_scale": (0.0, 0.5, 0.5),
}
"""The logarithm of each calibration effect as a linear combination of those of the three
multipliers."""


class Sizes(NamedTuple):
    """Ratio of true to nominal base, left radius and right radius."""

    base: float
    left: float
    right: float

    def over(self, others: Sizes) -> Sizes:
        """Return the ratio of these sizes to others."""
        return Sizes(*(one / other for one, other in zip(self, others, strict=True)))

    @property
    def as_effects(self) -> dict[str, float]:
        """The equivalent value of each calibration effect."""
        return {
            "track_width": self.base,
            "unequal_wheel_radii": self.right / self.left,
            "wheel_radius_scale": 0.5 * (self.left + self.right),
        }


def sizes_of(robot: Robot) -> Sizes:
    """Multipliers of a robot, including the calibration effects that it holds."""
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


def effective_track(robot: Robot) -> float:
    """Wheel base of a robot, including its effects [m]."""
    return robot.wheel_separation * sizes_of(robot).base


def with_sizes_in_multipliers(robot: Robot, given: Robot) -> Robot:
    """Move calibration effects that the given file does not hold into the robot's multipliers."""
    held = {item.name for item in given.effects}
    moved = [item for item in robot.effects if item.name in LOGARITHMS and item.name not in held]
    if not moved:
        return robot
    effects = tuple(item for item in robot.effects if item not in moved)
    sizes = sizes_of(replace(robot, effects=tuple(moved)))
    return changed(replace(robot, effects=effects), dict(zip(MULTIPLIERS, sizes, strict=True)))


def robot_for_cutting(robot: Robot, given: Robot) -> Robot:
    """Choose the robot whose travel cuts the legs: the given file's, unless its sizes are far off.

    `robot`: the robot after the search for set-up mistakes. `given`: the robot as its file has it.
    """
    found = with_sizes_in_multipliers(robot, given)
    off = max(abs(math.log(one)) for one in sizes_of(found).over(sizes_of(given)))
    return found if off > math.log(rules.CUT_ANEW) else robot


def base_name(effect: Effect) -> str | None:
    """Name of an effect's parameter that stands for the wheel base; None if it has none."""
    return next((name for name, item in effect.parameters.items() if item.as_base), None)


def name_of_base(robot: Robot) -> str:
    """Name of the effect that stands for a robot's wheel base."""
    named = (item.name for item in robot.effects if base_name(item.effect) is not None)
    return next(named, "track_width")


def skids_in_turns(robot: Robot) -> bool:
    """Whether a robot skids in turns: several wheels a side, or such an effect in its file."""
    return robot.wheels_a_side > 1 or name_of_base(robot) != "track_width"


def base_told(applied: AppliedEffect, robot: Robot, given: Robot) -> float:
    """Value of an effect's own base parameter that accounts for the whole deviation of the base.

    `applied`: an effect with a parameter that stands for the base. `robot`: the robot that holds
    `applied`. `given`: the robot as its file has it; its multiplier stays as it is.
    """
    name = base_name(applied.effect)
    assert name is not None
    before = next((item for item in given.effects if item.name == applied.name), None)
    value = sizes_of(robot).base / sizes_of(given).base
    value *= 1.0 if before is None else before.values[name]
    low, high = applied.effect.parameters[name].bounds
    return min(max(value, low), high)


def calibration_deviation(robot: Robot, given: Robot) -> Floats:
    """Log ratios (3,) of base, radius ratio and mean radius to the given ones."""
    relative = sizes_of(robot).over(sizes_of(given))
    return np.asarray(np.array(list(LOGARITHMS.values())) @ np.log(relative))


def std_as_effect(name: str, robot: Robot, covariance: Floats) -> float:
    """Standard deviation of a calibration effect's logarithm, by the multipliers' covariance.

    `name`: name of the calibration effect. `robot`: Robot with the fitted multipliers. `covariance`
    (3, 3): their covariance, in the order of `MULTIPLIERS`.
    """
    row = np.array(LOGARITHMS[name]) / [getattr(robot, multiplier) for multiplier in MULTIPLIERS]
    return float(np.sqrt(max(row @ covariance @ row, 0.0)))
