# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Fits of a model with several effects: with none of them, with all, and with all but one."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from werrimbi_odom.errors import InputError
from werrimbi_odom.inference.adding.fitted_parameters import (
    parameters_of,
    undetermined,
    weakest,
)
from werrimbi_odom.inference.adding.start_values import (
    FitDrives,
    Start,
    parameters_held,
    start_of_held,
    starts,
)
from werrimbi_odom.inference.diagnosis.calibration_selection import sizes_needed, with_sizes
from werrimbi_odom.inference.diagnosis.either_sign import cheapest_of
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted, refined
from werrimbi_odom.inference.fitting.fit import without_jumps
from werrimbi_odom.inference.fitting.free_parameters import Model, changed
from werrimbi_odom.inference.fitting.identifiable import CALIBRATED
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.progress import Show


@dataclass(frozen=True, slots=True)
class Fits:
    """The fit with all effects, and the fits that it is compared with."""

    none: Fitted
    """Everything fitted but the effects; the same fit if these are calibration effects."""
    all: Fitted
    without: dict[str, Fitted]
    """With all but one of several effects; empty for a single effect."""
    either: dict[str, Fitted]
    """By the name of an effect, a fit with it in which another sign fits as well (`or_else`)."""


def fits_without_jumps(
    effects: Sequence[Effect],
    drives: FitDrives,
    begun: Robot,
    given: Robot,
    also: tuple[str, ...],
    show: Show,
) -> tuple[FitDrives, Fits]:
    """The fits, and the drives without the legs on which the reference jumped.

    As in `diagnose`, a better model finds more jumps where a reference has correlated errors: one
    failed match within the travel of its interval passes for noise of all the others.
    """
    fits = fits_of(effects, drives, begun, given, also, show)
    if drives.options.reference_kind == "absolute":
        return drives, fits
    found = without_jumps(drives.laid, fits.all.point).excluded
    skipped = tuple(old | new for old, new in zip(drives.skipped, found, strict=True))
    if all(np.array_equal(*pair) for pair in zip(skipped, drives.skipped, strict=True)):
        return drives, fits
    drives = replace(drives, skipped=skipped)
    return drives, fits_of(effects, drives, begun, given, also, show)


def fits_of(
    effects: Sequence[Effect],
    drives: FitDrives,
    begun: Robot,
    given: Robot,
    also: tuple[str, ...],
    show: Show,
) -> Fits:
    """Models with none of the effects, with all, and with all but one.

    Set-up mistakes start together, at the result of the set-up search. Then effects are added one
    after the other, the one with the highest score first, and all earlier ones are fitted again
    with it. `begun`: Robot at which fits start. `also`: those of its effects that are set-up
    mistakes just found. InputError when the drives do not determine an effect at all.
    """
    sought = [effect for effect in effects if effect.name not in CALIBRATED]
    if not sought:
        start = start_of_held(drives, begun, also)
        fit = drives.fit(start.point, also, start.numbers, given)
        return Fits(fit, fit, {}, {})
    names = {effect.name for effect in sought}
    others = tuple(item for item in begun.effects if item.name not in (*names, *also))
    bare = replace(begun if not also else given, effects=others)
    start = start_of_held(drives, bare, ())
    none = fit = drives.fit(start.point, (), start.numbers, given)
    show(0.3, sought[0].name)
    mended = [effect for effect in sought if effect.is_mistake and effect.name not in also]
    if also or mended:
        robot = bare
        if also:
            rest = tuple(
                item for item in begun.effects if item.name in also or item.name not in names
            )
            robot = replace(begun, effects=rest)
        for effect in mended:  # a mistake comes before all other effects
            robot = replace(robot, effects=(effect.using(), *robot.effects))
        start = start_of_held(drives, robot, (*also, *(effect.name for effect in mended)))
        numbers = start.numbers
        for effect in sought:
            numbers = parameters_held(robot, numbers, effect)
        fit = _well(drives, replace(start, numbers=numbers), given)
    waiting = [effect for effect in sought if effect not in mended and effect.name not in also]
    count = len(waiting)
    either: dict[str, Fitted] = {}
    while waiting:
        show(0.65 - 0.3 * len(waiting) / count, ", ".join(effect.name for effect in waiting))
        options = {
            effect.name: starts(drives, fit, effect, fit.numbers, given) for effect in waiting
        }
        gains = {
            name: max((start.gain for start in each), default=-1.0)
            for name, each in options.items()
        }
        best = max(waiting, key=lambda effect: gains[effect.name])
        if not options[best.name]:
            raise InputError(
                f"these drives do not show {best.name} at all: what it looks at never happens in "
                "them, or is the same to them as calibration"
            )
        fits = [_well(drives, option, given) for option in options[best.name]]
        fit = cheapest_of(fits)
        if fit.or_else is not None:
            either[best.name] = fit
        waiting.remove(best)
    show(0.65, "pruning")
    for effect in sought:
        fit = _pruned(effect, drives, fit, given)
    if len(sought) == 1 and (not also or sought[0].name in also):
        return Fits(none, fit, {}, either)
    tested = [effect for effect in sought if effect.name not in also]
    without = {effect.name: _without(effect, drives, fit, given) for effect in tested}
    return Fits(none, fit, without, either)


def _without(effect: Effect, drives: FitDrives, fit: Fitted, given: Robot) -> Fitted:
    """Fit the model without one of its effects."""
    point, numbers = fit.without(effect.name)
    names = tuple(name for name in fit.names if name != effect.name)
    return drives.fit(point, names, numbers, given)


def _well(drives: FitDrives, start: Start, given: Robot) -> Fitted:
    """A fit from a start, refined."""
    fit = drives.fit(start.point, start.names, start.numbers, given)
    return refined(drives.laid, fit, given)


def _pruned(effect: Effect, drives: FitDrives, fit: Fitted, given: Robot) -> Fitted:
    """Backward elimination of parameters that do not pay the penalty.

    A length or threshold that the drives do not determine stays at its typical value. Where sizes
    are not determined, they would stand in for a parameter: it is weighed beside those sizes alone
    that the drives need.
    """
    limit = math.sqrt(fit.penalty_of_one)
    while True:
        found = parameters_of(effect, _with_needed_sizes(drives, fit, given), given)
        name = undetermined(effect, found) or weakest(effect, found, limit)
        if name is None:
            return fit
        key = f"{effect.name}.{name}"
        model = fit.point.model
        at_null = changed(model.robot, {key: effect.parameters[name].null})
        numbers = tuple(number for number in fit.numbers if number.name != key)
        point = replace(fit.point, model=Model(at_null, model.own))
        fit = drives.fit(point, fit.names, numbers, given)


def _with_needed_sizes(drives: FitDrives, fit: Fitted, given: Robot) -> Fitted:
    if not fit.sizes_held:
        return fit
    return with_sizes(drives.laid, fit, given, sizes_needed(fit, given, ()))
