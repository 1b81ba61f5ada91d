# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What a fit may turn: multipliers, parameters of effects, and nuisances of each run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from werrimbi_odom.model.effect import AppliedEffect, Effect
from werrimbi_odom.model.robot import Robot

MULTIPLIERS = (
    "wheel_separation_multiplier",
    "left_wheel_radius_multiplier",
    "right_wheel_radius_multiplier",
)

START_YAW = "start_yaw"
"""Name of a run's heading at its first reference pose, where that was not measured [rad]."""


@dataclass(frozen=True, slots=True)
class Knob:
    """One number that a fit may change.

    Parameters
    ----------
    name : str
        A multiplier, ``effect.parameter``, or `START_YAW`.
    scale : float
        A change that is small and yet well above rounding; derivatives are taken over it.
    bounds : (float, float)
        What is physically possible; a fit that ends there is a finding of its own.
    undetermined : float
        Standard deviation above which the data say less than is known beforehand.
    per_run : bool
        Each run has its own value.
    """

    name: str
    unit: str
    scale: float
    bounds: tuple[float, float]
    undetermined: float
    per_run: bool = False


CALIBRATION = tuple(Knob(name, "", 1e-4, (0.5, 2.0), 0.05) for name in MULTIPLIERS)

HEADING_AT_START = Knob(START_YAW, "rad", 1e-4, (-1e9, 1e9), float("inf"), per_run=True)


def knobs_of(effect: Effect) -> tuple[Knob, ...]:
    """The parameters of an effect as knobs."""
    return tuple(
        Knob(
            f"{effect.name}.{name}",
            item.unit,
            0.01 * abs(item.typical),
            item.bounds,
            0.5 * (item.bounds[1] - item.bounds[0]),
            item.per_run,
        )
        for name, item in effect.parameters.items()
    )


@dataclass(frozen=True, slots=True)
class Model:
    """A robot, and what each run has of its own (`START_YAW`, phases ...)."""

    robot: Robot
    own: tuple[Mapping[str, float], ...]

    def of_run(self, index: int) -> Robot:
        """The robot with the run's own values in its effects."""
        values = {name: value for name, value in self.own[index].items() if name != START_YAW}
        return changed(self.robot, values)

    def start_yaw(self, index: int) -> float | None:
        """Fitted heading at the first reference pose of a run, if it was not measured [rad]."""
        return self.own[index].get(START_YAW)

    def value(self, knob: Knob, index: int = 0) -> float:
        """Where a knob stands."""
        return self.own[index][knob.name] if knob.per_run else value_of(self.robot, knob.name)

    def turned(self, changes: Mapping[str, float], own: Sequence[Mapping[str, float]]) -> Model:
        """The model with shared values and the runs' own values changed."""
        merged = tuple({**before, **after} for before, after in zip(self.own, own, strict=True))
        return Model(changed(self.robot, changes), merged)


def value_of(robot: Robot, name: str) -> float:
    """Value of a multiplier, or of ``effect.parameter``."""
    effect, _, parameter = name.rpartition(".")
    if not effect:
        return float(getattr(robot, name))
    for applied in robot.effects:
        if applied.name == effect:
            return applied.values[parameter]
    raise KeyError(name)


def changed(robot: Robot, changes: Mapping[str, float]) -> Robot:
    """A robot with multipliers and parameters of its effects changed."""
    plain = {name: value for name, value in changes.items() if "." not in name}
    effects = robot.effects
    for name, value in changes.items():
        effect, _, parameter = name.rpartition(".")
        if effect:
            effects = tuple(
                AppliedEffect(item.effect, {**item.values, parameter: value})
                if item.name == effect
                else item
                for item in effects
            )
    if not plain and effects is robot.effects:
        return robot
    return replace(robot, effects=effects, **plain)  # type: ignore[arg-type]
