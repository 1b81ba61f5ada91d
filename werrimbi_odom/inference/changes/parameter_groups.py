# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters that may change on a robot, in groups that change together by one cause."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.fitting.free_parameters import (
    CALIBRATION,
    MULTIPLIERS,
    FreeParameter,
    parameters_to_fit,
    value_of,
)
from werrimbi_odom.inference.fitting.identifiable import CALIBRATED
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

YAW, ARM, DELAY = "reference_yaw_offset", "reference_lever_arm", "reference_delay"
MOUNT = (YAW, ARM)
"""Effects of the reference's mount, which may be changed even if the file does not hold them."""

OVER_BASE = "wheels_over_base"
"""What headings alone know of the sizes, beside the ratio of the radii."""

PARTS = ("left_wheel", "right_wheel", "wheel_base", "both_wheels", OVER_BASE, "mount", DELAY)
"""Groups that are sizes of parts, or how two clocks stand, not parameters of an effect's law."""


@dataclass(frozen=True, slots=True)
class NumberGroup:
    """Parameters that change together: one cause on the robot."""

    what: str
    """One of `PARTS`, or an effect."""
    numbers: tuple[str, ...]
    """Names of the parameters that change."""
    directions: Floats
    """Changes of all parameters for a unit of each free direction, (s, d)."""


def numbers_of(robot: Robot, mounts: Sequence[Effect]) -> tuple[FreeParameter, ...]:
    """All parameters of a robot that may change: calibration, mount, sizes of the effects it holds.

    `mounts`: effects of the reference that it can show and the robot does not hold.
    """
    held = [applied.effect for applied in robot.effects if not applied.effect.is_mistake]
    return (*CALIBRATION, *(number for effect in (*held, *mounts) for number in sizes_of(effect)))


def sizes_of(effect: Effect) -> tuple[FreeParameter, ...]:
    """Parameters of an effect that are sizes: neither shape nor per-run parameters."""
    if effect.name in CALIBRATED:
        return ()  # equivalent to the calibration
    return tuple(
        number
        for number in parameters_to_fit(effect)
        if not number.per_run and not effect.parameters[number.name.rpartition(".")[2]].tries
    )


def value_at(robot: Robot, name: str, nulls: Mapping[str, float]) -> float:
    """Value of a robot's parameter; the null value if the robot does not hold its effect."""
    try:
        return value_of(robot, name)
    except KeyError:
        return nulls.get(name, 0.0)


def tell_the_scale(information: Floats, names: Sequence[str], values: Floats) -> bool:
    """Whether any drive tells a robot from one of another scale: headings alone do not.

    `information` (R, s, s): of each drive about the s parameters, which have these `names` and
    `values`.
    """
    scale = np.where(np.isin(names, MULTIPLIERS), values, 0.0)
    return bool(np.sum(scale @ information @ scale) > rules.CALIBRATION_KNOWN**-2)


def groups_of(
    names: Sequence[str], values: Floats, size: int, *, sized: bool = True
) -> tuple[NumberGroup, ...]:
    """Groups of parameters that may change by one cause, the simplest first.

    `names`: names of the parameters that may change, the first of all. `values` (s,): their values:
    both wheels change by the same share. `size`: number of all parameters, s. `sized`: whether the
    drives tell the robot's scale.
    """
    found = []
    columns = np.eye(size)
    base, left, right = (names.index(name) for name in MULTIPLIERS)
    bases = ("wheel_base" if sized else OVER_BASE, base)
    for what, index in (("left_wheel", left), ("right_wheel", right), bases):
        found.append(NumberGroup(what, (names[index],), columns[:, [index]]))
    if sized:
        alike = columns[:, [left]] * values[left] + columns[:, [right]] * values[right]
        found.append(NumberGroup("both_wheels", (names[left], names[right]), alike))
    effects = dict.fromkeys(name.rpartition(".")[0] for name in names if "." in name)
    for effect in effects:
        own = [index for index, name in enumerate(names) if name.rpartition(".")[0] == effect]
        what = "mount" if effect in MOUNT else effect
        found.append(NumberGroup(what, tuple(names[index] for index in own), columns[:, own]))
    mount = [index for index, name in enumerate(names) if name.rpartition(".")[0] in MOUNT]
    if len({names[index].rpartition(".")[0] for index in mount}) > 1:
        found.append(
            NumberGroup("mount", tuple(names[index] for index in mount), columns[:, mount])
        )
    return tuple(found)
