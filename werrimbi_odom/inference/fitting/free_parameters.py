# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What a fit may turn: multipliers, parameters of effects, and nuisances of each run."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import cast

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference.rules import CALIBRATION_BOUNDS, CALIBRATION_KNOWN
from werrimbi_odom.model.effect import Effect, Parameter
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

MULTIPLIERS = (
    "wheel_separation_multiplier",
    "left_wheel_radius_multiplier",
    "right_wheel_radius_multiplier",
)

START_YAW = "start_yaw"
"""Name of a run's heading at its first reference pose, where that was not measured [rad]."""

YAW_DRIFT = "yaw_drift"
"""Name of a run's drift of the reference's heading, where that is a gyro's alone [rad/s]."""

NUISANCES = (START_YAW, YAW_DRIFT)

STEP = 0.2
"""Share of a parameter's usual size over which its derivative is taken: less than what bends a law,
more than what a reference delay needs to feel beyond one interval of the ticks."""


@dataclass(frozen=True, slots=True)
class FreeParameter:
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

    def bounds_about(self, value: float) -> tuple[float, float]:
        """The bounds, wider where a robot file is beyond them: a factor that was mended there."""
        (low, high), reach = self.bounds, 0.5 * abs(value)
        return (low if value >= low else value - reach, high if value <= high else value + reach)


CALIBRATION = tuple(
    FreeParameter(name, "", 1e-4, CALIBRATION_BOUNDS, CALIBRATION_KNOWN) for name in MULTIPLIERS
)

HEADING_AT_START = FreeParameter(START_YAW, "rad", 1e-4, (-1e9, 1e9), float("inf"), per_run=True)


DRIFT_OF_YAW = FreeParameter(YAW_DRIFT, "rad/s", 1e-4, (-10.0, 10.0), float("inf"), per_run=True)


def parameters_to_fit(effect: Effect, shared: Sequence[str] = ()) -> tuple[FreeParameter, ...]:
    """The parameters of an effect as numbers.

    Parameters
    ----------
    shared
        Parameters that are the same in all runs, although each run could have its own (a phase,
        where counters keep their zero).
    """
    return tuple(
        FreeParameter(
            f"{effect.name}.{name}",
            item.unit,
            STEP * item.scale,
            item.bounds,
            0.5 * (item.bounds[1] - item.bounds[0]),
            item.per_run and name not in shared,
        )
        for name, item in effect.parameters.items()
        if not item.as_base
    )


def is_determined(parameter: Parameter, value: float, std: float) -> bool:
    """Whether a fit says anything of a parameter.

    It does not where one deviation to either side is all that physics allows; nor of a length or
    another scale of a law where one deviation is as much as itself, for then not even its order of
    magnitude is known.
    """
    low, high = parameter.bounds
    scale = abs(value) if parameter.tries and low > 0.0 else math.inf
    return not std > min(0.5 * (high - low), scale)


def shared_of(numbers: Sequence[FreeParameter]) -> list[FreeParameter]:
    """Free parameters that all runs have in common."""
    return [number for number in numbers if not number.per_run]


def own_of(numbers: Sequence[FreeParameter]) -> list[FreeParameter]:
    """Free parameters of which each run has its own."""
    return [number for number in numbers if number.per_run]


@dataclass(frozen=True, slots=True)
class Model:
    """A robot, and what each run has of its own (`NUISANCES`, phases ...)."""

    robot: Robot
    own: tuple[Mapping[str, float], ...]

    def of_run(self, index: int) -> Robot:
        """The robot with the run's own values in its effects."""
        own = self.own[index]
        return changed(self.robot, {name: own[name] for name in own if name not in NUISANCES})

    def start_yaw(self, index: int) -> float | None:
        """Fitted heading at the first reference pose of a run, if it was not measured [rad]."""
        return self.own[index].get(START_YAW)

    @property
    def start_yaws(self) -> list[float | None]:
        """The same for all runs."""
        return [own.get(START_YAW) for own in self.own]

    @property
    def drifts(self) -> Floats:
        """Drift of the reference's heading in each run [rad/s]."""
        return np.array([own.get(YAW_DRIFT, 0.0) for own in self.own])

    @property
    def nuisance_parameters(self) -> list[FreeParameter]:
        """What is turned because of the references; start headings `design.stacked` adds itself."""
        return [DRIFT_OF_YAW] if any(YAW_DRIFT in own for own in self.own) else []

    def without_nuisances(self) -> Model:
        """The model without what belongs to the references alone."""
        own = tuple(
            {name: value for name, value in mine.items() if name not in NUISANCES}
            for mine in self.own
        )
        return Model(self.robot, own)

    def laid_out(self, steps: NDArray[np.intp]) -> Robot:
        """The robot with the runs' own values as arrays over the steps of all runs, (n,).

        Parameters
        ----------
        steps
            First step of each run, and the number of all; shape (runs + 1,).
        """
        first = self.own[0] if self.own else {}
        names = [name for name in first if name not in NUISANCES]
        if not names:
            return self.robot
        sizes = np.diff(steps)
        values = {name: np.repeat([own[name] for own in self.own], sizes) for name in names}
        return changed(self.robot, cast("Mapping[str, float]", values))

    def value(self, number: FreeParameter, index: int = 0) -> float:
        """Where a number stands."""
        return self.own[index][number.name] if number.per_run else value_of(self.robot, number.name)

    def turned(self, changes: Mapping[str, float], own: Sequence[Mapping[str, float]]) -> Model:
        """The model with shared values and the runs' own values changed."""
        merged = tuple({**before, **after} for before, after in zip(self.own, own, strict=True))
        return Model(changed(self.robot, changes), merged)

    def moved_by(self, number: FreeParameter, move: float) -> Model:
        """One number moved, a run's own in all runs that have it; bounds are kept."""
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
