# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The fit that is reported, with the sizes that it tells and their standard deviations.

Which sizes may differ from the file is chosen to first order, and what is stated of them allows for
that choice. So a size may turn out to be within its own uncertainty of the file; then it is not
told.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import replace

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.calibration_parametrisation import name_of_base
from werrimbi_odom.inference.diagnosis.calibration_selection import (
    FreeSizes,
    sizes_needed,
    with_sizes,
)
from werrimbi_odom.inference.diagnosis.either_sign import variances_by_sign
from werrimbi_odom.inference.diagnosis.forward_selection import Round, tried_with
from werrimbi_odom.inference.diagnosis.p_values import deviations_from
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.diagnosis.uncertainty import (
    as_written,
    noises_of,
    with_spread,
)
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS, Model
from werrimbi_odom.inference.fitting.identifiable import CALIBRATED
from werrimbi_odom.model.effect import applied_of
from werrimbi_odom.model.robot import Robot


def as_told(
    fit: Fitted,
    given: Robot,
    found: Collection[str],
    laid: Concatenated,
    rounds: tuple[Round, ...],
) -> Fitted:
    """A fit with only the reported sizes changed, and the standard deviations that are stated.

    Sizes that no effect in `found` stands for stay as in the file if they are not significant, and
    if the fit, its penalty paid, is as good without them.
    """
    if not (fit.calibrated or fit.names):
        return replace(fit, point=replace(fit.point, model=plain(fit, given)))
    wanted = sizes_among(found, fit)

    def with_those(at_file: tuple[str, ...]) -> tuple[float, Fitted]:
        sizes = sizes_needed(fit, given, wanted, at_file)
        told = with_sizes(laid, fit, given, sizes)
        total = told.cost + fit.penalty_of_one * fit.scatter * sizes.free
        if not found:
            return total, told
        return total, _with_spread(told, sizes, given, wanted, laid, rounds)

    at_file: tuple[str, ...] = ()
    best, told = with_those(at_file)
    unsure = _doubted_sizes(told, given, wanted) if found else []
    while unsure:
        fewer = (*at_file, unsure.pop(0))
        total, without = with_those(fewer)
        as_good = total < best + rules.RIVAL * fit.scatter
        if as_good and _as_in(given, without, fewer):
            told, at_file = without, fewer
            unsure = _doubted_sizes(told, given, wanted)
    return told


def doubted_effects(told: Fitted, given: Robot, found: Collection[str]) -> list[str]:
    """Calibration effects in `found` that are unsure by what is stated of them, least sure first.

    `told`: the fit as told. `given`: the robot as its file has it.
    """
    names = sizes_among(found, told) - set(told.held)
    away = {name: deviations_from(given, told, name) for name in sorted(names)}
    unsure = [name for name in away if away[name] <= rules.SIGNIFICANT]
    base = name_of_base(told.point.model.robot)
    ordered = sorted(unsure, key=lambda name: away[name])
    return [base if name == "track_width" else name for name in ordered]


def goes_without(told: Fitted, given: Robot, name: str) -> bool:
    """Whether a fit leaves the size that a name stands for as in the file.

    A size may also be little known because another one would do as well. Then some size is needed.
    """
    return all(deviations_from(given, told, size) == 0.0 for size in sizes_among([name], told))


def sizes_among(found: Collection[str], fit: Fitted) -> set[str]:
    """Calibration effects among what was found; of a base that skids, its own name counts too."""
    base = name_of_base(fit.point.model.robot)
    return {"track_width" if name == base else name for name in found} & set(CALIBRATED)


def plain(fit: Fitted, given: Robot) -> Model:
    """A fitted model, with multipliers that it does not need as given."""
    if fit.calibrated or fit.names:
        return fit.point.model
    return fit.point.model.with_sizes_of(given)


def _as_in(given: Robot, told: Fitted, names: Collection[str]) -> bool:
    robot = told.point.model.robot
    return all(getattr(robot, name) == getattr(given, name) for name in names)


def _doubted_sizes(told: Fitted, given: Robot, wanted: Collection[str]) -> list[str]:
    """Multipliers that no wanted effect stands for and that are not significant, least sure first.

    The wheels go together: what is said of them by their ratio or mean is no less sure for being
    little known of each.
    """
    robot, names = told.point.model.robot, told.design.names
    away = {}
    for name in MULTIPLIERS:
        of_base = name == MULTIPLIERS[0]
        stood_for = any((each == "track_width") == of_base for each in wanted)
        now, before = float(getattr(robot, name)), float(getattr(given, name))
        if stood_for or now == before:
            continue
        where = names.index(name)
        std = math.sqrt(max(float(told.covariance[where, where]), 0.0)) / now
        away[name] = abs(math.log(now / before)) / max(std, 1e-12)
    unsure = [name for name in away if away[name] <= rules.SIGNIFICANT]
    return sorted(unsure, key=lambda name: away[name])


def _with_spread(
    told: Fitted,
    sizes: FreeSizes,
    given: Robot,
    wanted: Collection[str],
    laid: Concatenated,
    rounds: tuple[Round, ...],
) -> Fitted:
    """The reported fit with the standard deviations that are stated of what was found."""
    effects = [applied_of(told.point.model.robot.effects, name).effect for name in told.names]
    noises = noises_of(laid, as_written(laid, told, given))
    either = [fit for name in told.names for fit in tried_with(rounds, name)[-1:]]
    by_sign = variances_by_sign(laid, either, given, wanted)
    return with_spread(effects, laid, told, given, wanted, sizes, noises, by_sign)
