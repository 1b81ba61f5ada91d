# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Results of a diagnosis: values with standard deviations, sizes, values outside bounds."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from werrimbi_odom.effects import find
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.calibration_parametrisation import (
    base_name,
    base_told,
    sizes_of,
)
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.diagnosis.forward_selection import tried_with
from werrimbi_odom.inference.diagnosis.p_values import chance
from werrimbi_odom.inference.diagnosis.penalised_likelihood import RATIO, Fitted
from werrimbi_odom.inference.diagnosis.ranking import Ranked
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS, is_determined
from werrimbi_odom.inference.fitting.identifiable import CALIBRATED
from werrimbi_odom.inference.set_up.findings import IN_DEGREES, SetUpFinding
from werrimbi_odom.model.effect import applied_of


@dataclass(frozen=True, slots=True)
class Value:
    """Estimated parameter of an effect that was found."""

    value: float
    """NaN for a per-run parameter."""
    std: float
    """NaN where it is not known."""
    unit: str
    says: str
    null: float
    per_run: bool = False
    is_shape: bool = False
    """Whether it is a length or a threshold of the law, which has no null value."""
    determined: bool = True
    """Whether the drives determine it; otherwise its fitted value means nothing."""
    of_runs: tuple[float, ...] = ()
    """Value in each fitted drive, of a per-run parameter that has a null value: no phase."""
    or_else: tuple[float, float] | None = None
    """Value and standard deviation of the other sign, where the drives do not tell which."""

    @property
    def reported(self) -> bool:
        """Whether there is one value for all drives to report."""
        return self.determined and not self.per_run


def values_of(diagnosis: Diagnosis, name: str) -> Mapping[str, Value]:
    """Parameters of an effect that was found; empty for a set-up mistake, which has none."""
    if name == IN_DEGREES:
        return {}
    if name in CALIBRATED:
        if name not in diagnosis.found and not diagnosis.told.design.sized:
            return _as_twin(diagnosis, name)
        if name not in (*diagnosis.found, *diagnosis.told.calibrated):
            return {}  # a rival with a fit of its own, whose other sizes are not these
        value = _calibrated(diagnosis, name)
        if math.isclose(value.value, value.null, rel_tol=1e-6):  # a rival that is not in the model
            return {}
        return {next(iter(find(name).parameters)): value}
    fit = _fit_with(diagnosis, name)
    if fit is None:
        return _as_twin(diagnosis, name) if diagnosis.runs.headings_alone else {}
    model = fit.point.model
    applied = applied_of(model.robot.effects, name)
    spread = _spreads(fit)
    anew = set(model.own[0]) if model.own else set()
    found = {}
    for parameter, item in applied.effect.parameters.items():
        if item.as_base:
            size = base_told(applied, diagnosis.robot, diagnosis.given)
            base = _calibrated(diagnosis, "track_width")
            std = base.std / base.value * size
            found[parameter] = Value(size, std, item.unit, item.says, item.null)
            continue
        if item.refines and f"{name}.{parameter}" not in spread:
            continue
        per_run = f"{name}.{parameter}" in anew
        untold = f"{name}.{parameter}" in fit.held
        std = math.nan if per_run else spread.get(f"{name}.{parameter}", math.nan)
        found[parameter] = Value(
            math.nan if per_run else float(applied.values[parameter]),
            math.nan if untold else std,
            item.unit,
            item.says,
            item.null,
            per_run,
            bool(item.tries),
            not untold and is_determined(item, float(applied.values[parameter]), std),
            tuple(own[f"{name}.{parameter}"] for own in model.own)
            if per_run and applied.effect.has_null(parameter)
            else (),
            _other_sign(diagnosis, name, parameter) if applied.effect.has_null(parameter) else None,
        )
    return found


def _other_sign(diagnosis: Diagnosis, name: str, parameter: str) -> tuple[float, float] | None:
    """Value and standard deviation of a parameter in the fit of the other sign, if there is one."""
    tried = tried_with(diagnosis.rounds, name)
    return of_other_sign(tried[-1] if tried else None, name, parameter)


def ranked_of(diagnosis: Diagnosis, name: str) -> Ranked | None:
    """The effect's row in the ranking."""
    return next((item for item in diagnosis.ranking if item.effect == name), None)


def _calibrated(diagnosis: Diagnosis, name: str) -> Value:
    """A calibration effect's value, from the set-up search and the fit together."""
    effect = find(name)
    item = next(iter(effect.parameters.values()))
    size = sizes_of(diagnosis.robot).over(sizes_of(diagnosis.given)).as_effects[name]
    told = diagnosis.told
    std = math.nan if name in told.held else size * told.std_of_size(name)
    return Value(size, std, item.unit, item.says, item.null)


def _as_twin(diagnosis: Diagnosis, name: str) -> dict[str, Value]:
    """Values of an unfitted effect from its fitted observational equivalent; else empty."""
    for found in set(diagnosis.found) & set(CALIBRATED):
        twin = next(
            (item for item in find(found).indistinguishable_from if item.name == name), None
        )
        if twin is None or not twin.values:
            continue
        values = values_of(diagnosis, found)
        same = twin.same_as({own: item.value for own, item in values.items()})
        parameters = find(name).parameters
        return {
            parameter: Value(
                value,
                abs(value / values[own].value) * values[own].std,
                parameters[parameter].unit,
                parameters[parameter].says,
                parameters[parameter].null,
            )
            for (parameter, value), (own, _) in zip(same.items(), twin.values.values(), strict=True)
        }
    return {}


def _fit_with(diagnosis: Diagnosis, name: str) -> Fitted | None:
    """The reported fit if it has the effect, else the cheapest fit that was tried with it."""
    return next(
        (
            fit
            for fit in (diagnosis.told, *tried_with(diagnosis.rounds, name))
            if any(item.name == name for item in fit.point.model.robot.effects)
        ),
        None,
    )


def of_other_sign(fit: Fitted | None, name: str, parameter: str) -> tuple[float, float] | None:
    """Value and standard deviation of a shared parameter of an effect in `or_else` of a fit."""
    other = None if fit is None else fit.or_else
    std = _spreads(other).get(f"{name}.{parameter}") if other is not None else None
    if other is None or std is None:
        return None
    return float(applied_of(other.point.model.robot.effects, name).values[parameter]), std


def _spreads(fit: Fitted) -> dict[str, float]:
    """Standard deviations of all shared parameters of a fit."""
    return {
        number.name: math.sqrt(max(float(fit.covariance[index, index]), 0.0))
        for index, (number, run) in enumerate(fit.design.columns)
        if run < 0
    }


def widest(diagnosis: Diagnosis) -> float:
    """Largest factor by which the scatter of the parts widened a reported standard deviation.

    1 where the parts agree to within the noise, or where nothing is reported.
    """
    fit, found = diagnosis.final, set(diagnosis.found)
    sizes = bool({*CALIBRATED, *fit.calibrated} & found)
    told = [
        index
        for index, (number, run) in enumerate(fit.design.columns)
        if run < 0
        and (sizes if number.name in MULTIPLIERS else number.name.rpartition(".")[0] in found)
    ]
    return float(np.max(fit.widening[told], initial=1.0))


def mistakes(diagnosis: Diagnosis) -> dict[str, SetUpFinding]:
    """Set-up mistakes, by name."""
    return {finding.effect: finding for finding in diagnosis.set_up.findings}


def best_sizes(diagnosis: Diagnosis) -> Mapping[str, tuple[float, float | None]]:
    """Wheel base and radii of the best model, as multipliers with standard deviations.

    The given ones where sizes are among the set-up mistakes, since all are reported with these.
    """
    wrong = mistakes(diagnosis)
    if wrong and not any(_is_size(name) for name in wrong):
        return _beside_mistakes(diagnosis)
    if wrong:
        return {name: (getattr(diagnosis.given, name), None) for name in MULTIPLIERS}
    robot, spread = diagnosis.robot, _spreads(diagnosis.told)
    same = {name for name in MULTIPLIERS if getattr(robot, name) == getattr(diagnosis.given, name)}
    return {
        name: (getattr(robot, name), 0.0 if name in same else spread[name]) for name in MULTIPLIERS
    }


def _is_size(mistake: str) -> bool:
    """Whether a set-up mistake is one of sizes, or of the unit that they are measured by."""
    return mistake == IN_DEGREES or mistake in CALIBRATED or base_name(find(mistake)) is not None


def _beside_mistakes(diagnosis: Diagnosis) -> dict[str, tuple[float, float]]:
    """Sizes beside exchanged wires or a mount: those that differ from the file beyond their std.

    The set-up search puts the few percent that they are off by into the robot that the fits start
    with, so a fit may leave them there. How well they are known, the fit with all sizes free tells.
    """
    robot, spread = diagnosis.final.point.model.robot, _spreads(diagnosis.final)
    sizes = {}
    for name in MULTIPLIERS:
        value, given = float(getattr(robot, name)), float(getattr(diagnosis.given, name))
        std = spread.get(name, math.inf)
        seen = abs(value - given) > rules.SIGNIFICANT * std
        sizes[name] = (value, std) if seen else (given, 0.0)
    return sizes


def one_wheel(diagnosis: Diagnosis) -> str | None:
    """The one wheel whose size is off, where both a ratio and a scale of the radii were found.

    On the robot these two effects are then one cause.
    """
    found = set(diagnosis.found) & set(CALIBRATED)
    if mistakes(diagnosis) or not {"unequal_wheel_radii", "wheel_radius_scale"} <= found:
        return None
    sizes = best_sizes(diagnosis)
    left, right = (
        abs(math.log(sizes[name][0] / getattr(diagnosis.given, name))) for name in MULTIPLIERS[1:]
    )
    if min(left, right) > rules.ONE_WHEEL * max(left, right):
        return None
    return "left" if left > right else "right"


def at_bounds(diagnosis: Diagnosis) -> dict[str, tuple[str, float, str]]:
    """Effects that would help, but only at a value outside the physical bounds.

    By name: the parameter at its bound, its value, its unit. Of the last round alone: an effect
    that helps beside less may stand in for what is found later.
    """
    found: dict[str, tuple[str, float, str]] = {}
    this = diagnosis.rounds[-1]
    for fit in this.tried:
        name = fit.names[-1]
        helps = fit.total < this.before.total and chance(fit, this.before, this.number) < rules.SURE
        wild = [number for number in fit.at_bound if number.startswith(f"{name}.")]
        if not helps or name in diagnosis.found:
            continue
        if wild:
            parameter = wild[0].rpartition(".")[2]
            applied = fit.point.model.robot.effects[-1]
            unit = applied.effect.parameters[parameter].unit
            found.setdefault(name, (parameter, applied.values[parameter], unit))
        elif RATIO in fit.at_bound:
            sizes = sizes_of(fit.point.model.robot).over(sizes_of(diagnosis.given))
            ratio = sizes.as_effects["unequal_wheel_radii"]
            found.setdefault(name, (RATIO, ratio, ""))
    return found


def reference_wanders(diagnosis: Diagnosis) -> bool:
    """Whether errors depend on something beyond chance although no effect is missing.

    Such errors are correlated over seconds, and follow no law on which all parts of the drives
    agree.
    """
    sure = any(cell.p_value < rules.VERY_SURE for cell in diagnosis.depends_on)
    return sure and diagnosis.verdict == "none" and diagnosis.misfit is None
