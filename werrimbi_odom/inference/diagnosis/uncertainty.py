# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Uncertainty of a model with effects: its noise, and all standard deviations that are stated."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.calibration_parametrisation import with_sizes_in_multipliers
from werrimbi_odom.inference.diagnosis.calibration_selection import (
    FreeSizes,
)
from werrimbi_odom.inference.diagnosis.fit_statistics import grain_of
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.diagnosis.post_selection import Law, model_averaged_covariance
from werrimbi_odom.inference.distributions import upper_part
from werrimbi_odom.inference.fitting.between_counts import variances_between_counts
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import (
    CALIBRATION,
    MULTIPLIERS,
    START_YAW,
    FreeParameter,
    Model,
    own_of,
    parameters_to_fit,
    shared_of,
    value_of,
)
from werrimbi_odom.inference.fitting.noise import NoiseEstimate, map_variances, noise_estimates
from werrimbi_odom.inference.fitting.precision import Precision
from werrimbi_odom.inference.fitting.whitened_innovations import Costs, stacked
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.model.robot import Robot


def noises_of(runs: Concatenated, fit: Fitted) -> dict[str, NoiseEstimate]:
    """Noise of a model as its file has it (`as_written`)."""
    costs = Costs(runs, fit.point)
    information = _precision(runs, fit).information
    return noise_estimates(costs, fit.point.variances, fit.point.options.sigmas_known, information)


def as_written(runs: Concatenated, fit: Fitted, given: Robot) -> Fitted:
    """The fit with its sizes as multipliers, and the noise fitted to that.

    A size that a search put in as an effect corrects the motion, but the covariance still uses the
    file's size. So the wheel noise with a base in millimetres differs from that with a corrected
    base.
    """
    model = fit.point.model
    robot = with_sizes_in_multipliers(model.robot, given)
    if robot is model.robot:
        return fit
    point = replace(fit.point, model=Model(robot, model.own))
    variances = map_variances(Costs(runs, point), point.variances, fit.point.options.sigmas_known)
    return replace(fit, point=replace(point, variances=variances))


def with_spread(
    effects: Sequence[Effect],
    runs: Concatenated,
    fit: Fitted,
    given: Robot,
    wanted: Collection[str],
    sizes: FreeSizes,
    noises: Mapping[str, NoiseEstimate],
    by_sign: Mapping[str, float],
) -> Fitted:
    """The fit with standard deviations that allow for all choices made on the same drives.

    These are which sizes differ from the file's, which parameters effects need
    (`model_averaged_covariance`), which sign an effect has (`variances_by_sign`), and the noise
    (`Precision.widening`). No value is more precise than its law (`grain_of`), nor a delay than the
    counts that it is told by (`variances_between_counts`). Lengths have the uncertainty of their
    logarithm, as scale parameters do.
    """
    laws = [law for effect in effects if len(law := _optional(effect)) > 1]
    columns = fit.design.columns
    lacking = {name for law in laws for name in law} - {number.name for number, _ in columns}
    design = fit.design
    if lacking:
        more = [
            number
            for effect in effects
            for number in parameters_to_fit(effect)
            if number.name in lacking
        ]
        design = stacked(runs, fit.point, [*_local(fit), *more])
    model = fit.point.model
    now = np.array([[value_of(model.robot, name)] for name in MULTIPLIERS])
    moved = fit.moves[[fit.design.names.index(name) for name in MULTIPLIERS]] / now
    moved = moved[:, moved.any(axis=0)]
    if moved.shape[1] != sizes.free:  # the other sizes could not be reset (`with_sizes`)
        sizes = FreeSizes(("as fitted", "as fitted"), moved)
    shared, averaged = model_averaged_covariance(fit, given, wanted, sizes, laws, design)
    told = [index for index, (_, run) in enumerate(columns) if run < 0 and fit.moves[index].any()]
    names = [columns[index][0].name for index in told]
    wide = _precision(runs, as_written(runs, fit, given)).widening(noises, names)
    where = [shared.index(name) for name in names]
    within = averaged[np.ix_(where, where)] * np.outer(wide, wide)
    within += np.diag(grain_of(fit.design, fit.point.model.robot)[told])
    within += np.diag([by_sign.get(name, 0.0) for name in names])
    numbers = [number for number, _ in columns]
    by_counts = variances_between_counts(runs, fit.point, numbers, fit.moves)
    within += np.diag([by_counts.get(name, 0.0) for name in names])
    variances = np.diag(within).copy()
    scales = {
        f"{effect.name}.{name}"
        for effect in effects
        for name, item in effect.parameters.items()
        if item.tries and item.bounds[0] > 0.0
    }
    for index, name in enumerate(names):
        if name in scales:
            value = value_of(fit.point.model.robot, name)
            share = min(math.sqrt(variances[index]) / value, rules.NOISE_TOLD)
            variances[index] = max(variances[index], upper_part(value, share) ** 2)
    size = np.ones(len(columns))
    size[told] = np.sqrt(variances / np.diag(fit.covariance)[told])
    covariance = fit.covariance * np.outer(size, size)
    wider = np.sqrt(variances / np.diag(within))
    covariance[np.ix_(told, told)] = within * np.outer(wider, wider)
    radii = [fit.design.names.index(name) for name in MULTIPLIERS[1:]]
    if len(own := [index for index in radii if index in told]) == 1:
        # Of one wheel that is told, the other is as little known: their ratio is not.
        (other,) = set(radii) - set(own)
        its = shared.index(columns[other][0].name)
        factor = wide * wider
        alike = factor[told.index(own[0])]
        covariance[other, told] = covariance[told, other] = averaged[its, where] * factor * alike
        covariance[other, other] = averaged[its, its] * alike**2
    return replace(fit, covariance=covariance)


def _optional(effect: Effect) -> Law:
    """Optional parameters of an effect: neither shapes, phases nor per-run parameters."""
    phases = effect.quadrature or ()
    return {
        f"{effect.name}.{name}": item.null
        for name, item in effect.parameters.items()
        if not (item.tries or item.per_run or item.as_base or name in phases)
    }


def _local(fit: Fitted) -> list[FreeParameter]:
    """Parameters of the fit's design, except start headings."""
    numbers = (*fit.numbers, *fit.point.model.nuisance_parameters)
    return [*CALIBRATION, *own_of(numbers), *shared_of(fit.numbers)]


def _precision(runs: Concatenated, fit: Fitted) -> Precision:
    local = [number for number in _local(fit) if number.name != START_YAW]
    return Precision.of(runs, fit.point, local, fit.moves)
