# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters of an effect after a fit: values, standard deviations, and which stayed at null."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from typing import Literal, NamedTuple

import numpy as np

from werrimbi_odom.effects import find
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.calibration_parametrisation import (
    base_name,
    base_told,
    sizes_of,
)
from werrimbi_odom.inference.diagnosis.estimated_values import of_other_sign
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.fitting.free_parameters import (
    MULTIPLIERS,
    FreeParameter,
    Model,
    is_determined,
)
from werrimbi_odom.inference.fitting.identifiable import CALIBRATED
from werrimbi_odom.model.effect import AppliedEffect, Effect, Parameter
from werrimbi_odom.model.robot import Robot

Remark = Literal["fitted", "null", "undetermined", "bound", "per run"]


@dataclass(frozen=True, slots=True)
class FittedParameter:
    """A parameter of the added effect."""

    declared: Parameter
    value: float | None
    """None for a per-run parameter."""
    std: float | None
    """None where it was not fitted."""
    remark: Remark
    """null: kept at its null value, because the data show no other."""
    of_runs: tuple[float, ...] = ()
    """Values of the fitted runs, for a per-run parameter."""
    or_else: tuple[float, float] | None = None
    """Value and standard deviation of the other sign, where the drives do not tell which."""

    @property
    def written(self) -> bool:
        """Whether the value in the file was estimated from the drives."""
        return self.std is not None

    @property
    def significant(self) -> bool:
        """Whether it differs significantly from null."""
        if self.value is None or not self.std:
            return False
        return abs(self.value - self.declared.null) > rules.SIGNIFICANT * self.std


def parameters_of(effect: Effect, fit: Fitted, given: Robot) -> dict[str, FittedParameter]:
    """The effect's parameters after a fit, in the effect's order; none that it did not need."""
    if effect.name in CALIBRATED:
        return {next(iter(effect.parameters)): _calibrated(effect, fit, given)}
    model = fit.point.model
    applied = next(item for item in model.robot.effects if item.name == effect.name)
    numbers = {number.name: number for number in fit.numbers}
    found = {}
    for name, item in effect.parameters.items():
        key = f"{effect.name}.{name}"
        number = numbers.get(key)
        if number is None and item.refines:
            continue
        if item.as_base:
            found[name] = _as_base(applied, item, fit, given)
        elif number is None and item.tries:
            found[name] = FittedParameter(item, None, None, "undetermined")
        elif number is None:
            found[name] = FittedParameter(item, applied.values[name], None, "null")
        elif number.per_run:
            own = tuple(mine[key] for mine in model.own)
            found[name] = FittedParameter(item, None, None, "per run", own)
        else:
            std = std_of(fit, key)
            found[name] = FittedParameter(
                item, applied.values[name], std, _remark(applied.values[name], std, number, effect)
            )
    return found


def with_other_sign(
    found: Mapping[str, FittedParameter], name: str, fit: Fitted | None
) -> dict[str, FittedParameter]:
    """An effect's parameters with their values in the fit of the other sign, if there is one."""
    return {
        key: item
        if item.std is None or item.declared.tries
        else replace(item, or_else=of_other_sign(fit, name, key))
        for key, item in found.items()
    }


class Moved(NamedTuple):
    """A value of an effect that the robot file held before, which the fit moved."""

    name: str
    """EFFECT.NAME"""
    before: float
    now: FittedParameter


def moved_values(asked: Collection[str], fit: Fitted, given: Robot) -> tuple[Moved, ...]:
    """Values of the given file's other effects that moved by more than their standard deviation."""
    held = {item.name for item in fit.point.model.robot.effects}
    found = []
    for applied in given.effects:
        if applied.name in {*asked, *CALIBRATED} or applied.name not in held:
            continue
        for name, item in parameters_of(applied.effect, fit, given).items():
            before = applied.values[name]
            if item.std and item.value is not None and abs(item.value - before) > item.std:
                found.append(Moved(f"{applied.name}.{name}", before, item))
    return tuple(found)


def _remark(value: float, std: float, number: FreeParameter, effect: Effect) -> Remark:
    name = number.name.rpartition(".")[2]
    item = effect.parameters[name]
    if not is_determined(item, value, std):
        return "undetermined"
    free = item.is_direction or item.refines
    return "bound" if not free and _at_bound(value, item) else "fitted"


def _at_bound(value: float, item: Parameter) -> bool:
    """Whether a value is at a bound other than null."""
    low, high = item.bounds
    near = 1e-6 * (high - low)
    return min(value - low, high - value) <= near and abs(value - item.null) > near


def std_of(fit: Fitted, name: str) -> float:
    """Standard deviation of a shared parameter of a fit."""
    names = fit.design.names
    index = names.index(name)
    return float(np.sqrt(max(fit.covariance[index, index], 0.0)))


def _calibrated(effect: Effect, fit: Fitted, given: Robot) -> FittedParameter:
    """A calibration effect's value, relative to the given robot file."""
    value = sizes_of(fit.point.model.robot).over(sizes_of(given)).as_effects[effect.name]
    std = value * fit.std_of_size(effect.name)
    declared = next(iter(effect.parameters.values()))
    return FittedParameter(
        declared, value, std, "fitted" if std < rules.CALIBRATION_KNOWN * value else "undetermined"
    )


def _as_base(applied: AppliedEffect, item: Parameter, fit: Fitted, given: Robot) -> FittedParameter:
    """The wheel base, as the parameter of an effect that stands for it."""
    value = base_told(applied, fit.point.model.robot, given)
    base = _calibrated(find("track_width"), fit, given)
    std = None if base.value is None or base.std is None else base.std / base.value * value
    return FittedParameter(item, value, std, base.remark)


def undetermined(effect: Effect, found: Mapping[str, FittedParameter]) -> str | None:
    """A length or threshold of a law that the drives do not determine; or None."""
    return next(
        (
            name
            for name, item in found.items()
            if item.remark == "undetermined" and item.written and effect.parameters[name].tries
        ),
        None,
    )


def to_write(model: Model, given: Robot) -> Robot:
    """The robot for a file: sizes as multipliers, per-run parameters left unknown.

    A calibration effect in the given file stays as it is there.
    """
    held = {item.name: item for item in given.effects if item.name in CALIBRATED}
    own = set(model.own[0]) if model.own else set()
    effects, in_effects = [], 1.0
    for applied in model.robot.effects:
        if applied.name in CALIBRATED:
            if applied.name in held:
                effects.append(held[applied.name])
            continue
        name = base_name(applied.effect)
        if name is not None:
            value = base_told(applied, model.robot, given)
            before = next((item for item in given.effects if item.name == applied.name), None)
            in_effects *= value if before is None else value / before.values[name]
            applied = replace(applied, values={**applied.values, name: value})
        effects.append(_forgotten(applied, own))
    effects = [
        replace(item, values={name: rounded(value) for name, value in item.values.items()})
        for item in effects
    ]
    relative = sizes_of(model.robot).over(sizes_of(given))
    relative = relative._replace(base=relative.base / in_effects)
    multipliers = {
        name: rounded(float(getattr(given, name)) * share)
        for name, share in zip(MULTIPLIERS, relative, strict=True)
    }
    return replace(
        model.robot,
        effects=tuple(effects),
        wheel_separation_multiplier=multipliers[MULTIPLIERS[0]],
        left_wheel_radius_multiplier=multipliers[MULTIPLIERS[1]],
        right_wheel_radius_multiplier=multipliers[MULTIPLIERS[2]],
    )


def rounded(value: float) -> float:
    """Nine digits: more than any drive determines, and still readable."""
    return float(f"{value:.9g}")


def _forgotten(applied: AppliedEffect, own: set[str]) -> AppliedEffect:
    names = tuple(name for name in applied.effect.parameters if f"{applied.name}.{name}" in own)
    if not names:
        return applied
    values = {**applied.values, **{name: applied.effect.nulls[name] for name in names}}
    return AppliedEffect(applied.effect, values, names)


def weakest(effect: Effect, found: Mapping[str, FittedParameter], limit: float) -> str | None:
    """The parameter that the data show least, if others remain without it; or None.

    `limit` is in standard deviations. Of two that the drives hardly tell apart (drift with distance
    and drift with time) the weaker goes first, and the other then stands alone. What stands for the
    wheel base stays, as the base is in every fit.
    """
    phases = effect.quadrature or ()
    free = {
        name: item
        for name, item in found.items()
        if item.std is not None and not item.declared.tries and name not in phases
    }
    if len(free) < 2:
        return None
    doubt = {
        name: abs((item.value or 0.0) - item.declared.null) / max(item.std or 0.0, 1e-300)
        for name, item in free.items()
        if not item.declared.as_base
    }
    name = min(doubt, key=lambda key: doubt[key])
    return name if doubt[name] < limit else None
