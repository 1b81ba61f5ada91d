# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Free parameters of a fit: multipliers, parameters of effects, and nuisance parameters of runs."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import cast

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference import rules
from werrimbi_odom.model.effect import Effect, Parameter
from werrimbi_odom.model.pose import Floats, wrap
from werrimbi_odom.model.robot import Robot

MULTIPLIERS = (
    "wheel_separation_multiplier",
    "left_wheel_radius_multiplier",
    "right_wheel_radius_multiplier",
)

START_YAW = "start_yaw"
"""Name of a run's heading at its first reference pose, where not measured [rad]."""

YAW_DRIFT = "yaw_drift"
"""Name of the drift rate of a run's reference heading, where that is from a gyro [rad/s]."""

NUISANCES = (START_YAW, YAW_DRIFT)

STEP = 0.2
"""Finite-difference step as a share of a parameter's usual size: small enough for laws to stay
linear, large enough for a reference delay to exceed one interval of the ticks."""


@dataclass(frozen=True, slots=True)
class FreeParameter:
    """A parameter that a fit may change."""

    name: str
    """A multiplier, ``effect.parameter``, or `START_YAW`."""
    unit: str
    """Its unit."""
    scale: float
    """Finite-difference step: small, yet well above rounding."""
    bounds: tuple[float, float]
    """Physical limits; a fit that ends at one is a finding of its own."""
    undetermined: float
    """Standard deviation above which the data add nothing to prior knowledge."""
    per_run: bool = False
    """Whether each run has its own value."""
    refines: bool = False
    """Whether it is free only where it pays its penalty (`Parameter.refines`)."""
    is_direction: bool = False
    """Whether its bounds are one and the same direction (`Parameter.is_direction`)."""

    def bounds_about(self, value: float) -> tuple[float, float]:
        """Bounds, widened to include a robot file's value beyond them; a direction has none."""
        if self.is_direction:
            return -math.inf, math.inf
        (low, high), reach = self.bounds, 0.5 * abs(value)
        return (low if value >= low else value - reach, high if value <= high else value + reach)

    def wrapped(self, value: float) -> float:
        """The value as it is told and written: a direction within its bounds, others as they are.

        A fit goes on across half a turn. What is no farther than that from the middle stays.
        """
        if not self.is_direction:
            return value
        low, high = self.bounds
        middle = 0.5 * (low + high)
        if abs(value - middle) > math.pi:
            value = middle + wrap(value - middle)
        return min(max(value, low), high)


CALIBRATION = tuple(
    FreeParameter(name, "", 1e-4, rules.CALIBRATION_BOUNDS, rules.CALIBRATION_KNOWN)
    for name in MULTIPLIERS
)

HEADING_AT_START = FreeParameter(START_YAW, "rad", 1e-4, (-1e9, 1e9), float("inf"), per_run=True)


DRIFT_OF_YAW = FreeParameter(YAW_DRIFT, "rad/s", 1e-4, (-10.0, 10.0), float("inf"), per_run=True)


def parameters_to_fit(effect: Effect, shared: Sequence[str] = ()) -> tuple[FreeParameter, ...]:
    """Free parameters of an effect.

    `effect`: the effect. `shared`: per-run parameters that are the same in all runs (a phase, where
    counters keep their zero).
    """
    return tuple(
        FreeParameter(
            f"{effect.name}.{name}",
            item.unit,
            STEP * item.scale,
            item.bounds,
            0.5 * (item.bounds[1] - item.bounds[0]),
            item.per_run and name not in shared,
            item.refines,
            item.is_direction,
        )
        for name, item in effect.parameters.items()
        if not item.as_base
    )


def is_determined(parameter: Parameter, value: float, std: float) -> bool:
    """Whether an estimate is informative.

    It is not if one standard deviation to either side covers the physical range. Nor is a length,
    or another scale of a law, if its deviation is as large as itself, as not even its order of
    magnitude is known then.
    """
    low, high = parameter.bounds
    scale = abs(value) if parameter.tries and low > 0.0 else math.inf
    return not std > min(0.5 * (high - low), scale)


def shared_of(numbers: Sequence[FreeParameter]) -> list[FreeParameter]:
    """Free parameters that all runs share."""
    return [number for number in numbers if not number.per_run]


def own_of(numbers: Sequence[FreeParameter]) -> list[FreeParameter]:
    """Free parameters with a value for each run."""
    return [number for number in numbers if number.per_run]


@dataclass(frozen=True, slots=True)
class Model:
    """A robot, and the values that belong to each run (`NUISANCES`, phases, ...)."""

    robot: Robot
    own: tuple[Mapping[str, float], ...]

    def of_run(self, index: int) -> Robot:
        """Robot with a run's own values in its effects."""
        own = self.own[index]
        return changed(self.robot, {name: own[name] for name in own if name not in NUISANCES})

    def start_yaw(self, index: int) -> float | None:
        """Fitted heading at a run's first reference pose, if it was not measured [rad]."""
        return self.own[index].get(START_YAW)

    @property
    def start_yaws(self) -> list[float | None]:
        """Fitted start headings of all runs."""
        return [own.get(START_YAW) for own in self.own]

    @property
    def drifts(self) -> Floats:
        """Drift rate of the reference's heading in each run [rad/s]."""
        return np.array([own.get(YAW_DRIFT, 0.0) for own in self.own])

    @property
    def nuisance_parameters(self) -> list[FreeParameter]:
        """Nuisance parameters of the references, but for the start headings.

        `whitened_innovations.stacked` adds those itself.
        """
        return [DRIFT_OF_YAW] if any(YAW_DRIFT in own for own in self.own) else []

    def without_nuisances(self) -> Model:
        """Model without the nuisance parameters of the references."""
        own = tuple(
            {name: value for name, value in mine.items() if name not in NUISANCES}
            for mine in self.own
        )
        return Model(self.robot, own)

    def without_effect(self, name: str) -> Model:
        """Model without one of its effects."""
        effects = tuple(item for item in self.robot.effects if item.name != name)
        own = tuple(
            {key: value for key, value in mine.items() if not key.startswith(f"{name}.")}
            for mine in self.own
        )
        return Model(replace(self.robot, effects=effects), own)

    def laid_out(self, steps: NDArray[np.intp]) -> Robot:
        """Robot with per-run values as arrays over the steps of all runs, (n,).

        `steps` (runs + 1,): first step of each run, and the number of all steps.
        """
        first = self.own[0] if self.own else {}
        names = [name for name in first if name not in NUISANCES]
        if not names:
            return self.robot
        sizes = np.diff(steps)
        values = {name: np.repeat([own[name] for own in self.own], sizes) for name in names}
        return changed(self.robot, cast("Mapping[str, float]", values))

    def value(self, number: FreeParameter, index: int = 0) -> float:
        """Current value of a parameter."""
        return self.own[index][number.name] if number.per_run else value_of(self.robot, number.name)

    def turned(self, changes: Mapping[str, float], own: Sequence[Mapping[str, float]]) -> Model:
        """Model with shared and per-run values replaced."""
        merged = tuple({**before, **after} for before, after in zip(self.own, own, strict=True))
        return Model(changed(self.robot, changes), merged)

    def moved_by(self, number: FreeParameter, move: float) -> Model:
        """Model with one parameter moved within bounds; a per-run one in all runs that have it."""
        if not number.per_run:
            now = value_of(self.robot, number.name)
            low, high = number.bounds_about(now)
            return Model(
                changed(self.robot, {number.name: min(max(now + move, low), high)}), self.own
            )
        own = tuple(
            {**mine, number.name: mine[number.name] + move} if number.name in mine else mine
            for mine in self.own
        )
        return Model(self.robot, own)

    def with_sizes_of(self, robot: Robot) -> Model:
        """The same model, with the multipliers of another robot."""
        return Model(
            changed(self.robot, {name: value_of(robot, name) for name in MULTIPLIERS}), self.own
        )


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
    """Robot with multipliers and parameters of its effects replaced."""
    plain = {name: value for name, value in changes.items() if "." not in name}
    effects = robot.effects
    for name, value in changes.items():
        effect, _, parameter = name.rpartition(".")
        if effect:
            effects = tuple(
                replace(
                    item,
                    values={**item.values, parameter: value},
                    unknown=tuple(name for name in item.unknown if name != parameter),
                )
                if item.name == effect
                else item
                for item in effects
            )
    if not plain and effects is robot.effects:
        return robot
    return replace(robot, effects=effects, **plain)  # type: ignore[arg-type]
