# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Maximum a posteriori estimates of the noise variances, and their precision.

The variances are those of both wheels, the reference's position and heading, the stamps of gyros
and scans, and the slowly varying error of a reference that localises on a map.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.distributions import NORMAL_95, upper_part
from werrimbi_odom.inference.fitting.fisher_scoring import hessian, minimum
from werrimbi_odom.inference.fitting.likelihood import Variances
from werrimbi_odom.inference.fitting.prediction import Prediction
from werrimbi_odom.inference.fitting.whitened_innovations import Costs
from werrimbi_odom.inference.linear import inverse_root
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

NOISES = ("left_wheel_noise", "right_wheel_noise", "reference_sigma_xy", "reference_sigma_yaw")

STAMP_NOISE = "reference_sigma_stamp"
"""Additional noise of a gyro or of scans [s]."""

WALK = ("reference_walk_xy", "reference_walk_yaw", "reference_reversion")
"""Additional noise of a reference on a local map [m/s^0.5, rad/s^0.5, 1/s]."""

_ALL = (*NOISES, STAMP_NOISE, *WALK)

_LOWEST = np.log(1e-14)
_HIGHEST = np.log([rules.STRANGE_NOISE**2] * 2 + [10.0] * 6)
"""Bounds of the log variances; the wheels' one is physical."""

LARGEST_NOISE = dict(zip(_ALL, np.exp(0.5 * _HIGHEST).tolist(), strict=True))
"""The largest standard deviation of each that a fit allows: to be below it says nothing."""


@dataclass(frozen=True, slots=True)
class NoiseEstimate:
    """Estimated standard deviation of a noise; `determined` tells if it is identifiable."""

    value: float
    share: float
    """Standard deviation of its logarithm, in which the likelihood of a scale is nearly normal."""
    determined: bool

    @property
    def interval(self) -> tuple[float, float]:
        """95 % confidence interval."""
        factor = float(np.exp(NORMAL_95 * self.share))
        return self.value / factor, self.value * factor

    @property
    def std(self) -> float:
        """Standard deviation to report with the value (`upper_part`)."""
        return upper_part(self.value, self.share)


def beyond_wheel_noise(noise: NoiseEstimate) -> bool:
    """Whether a wheel's noise is at its upper bound, so that it is no wheel noise."""
    return noise.determined and bool(np.isclose(noise.value, rules.STRANGE_NOISE))


def with_noise(robot: Robot, noises: Mapping[str, NoiseEstimate]) -> Robot:
    """Robot with the wheel noise that was determined."""
    wheels = ("left_wheel_noise", "right_wheel_noise")
    found = {
        name: noises[name].value for name in wheels if name in noises and noises[name].determined
    }
    return replace(robot, **found)  # type: ignore[arg-type]


def with_noises(variances: Variances, sigmas: Mapping[str, float]) -> Variances:
    """Variances with some standard deviations replaced, by their names in `NOISES`."""
    parts = zip(_ALL, _each(variances), strict=True)
    return Variances(
        *(np.array([sigmas[name] ** 2]) if name in sigmas else part for name, part in parts)
    )


def with_known_noise(variances: Variances, options: EvaluationOptions) -> Variances:
    """Variances with the known noise of the reference put in."""
    if options.sigma_xy is not None:
        variances = replace(variances, xy=np.array([options.sigma_xy**2]))
    if options.sigma_yaw is not None:
        variances = replace(variances, yaw=np.array([options.sigma_yaw**2]))
    return variances


def map_variances(
    costs: Costs, start: Variances, held: tuple[bool, bool], prediction: Prediction | None = None
) -> Variances:
    """Maximum a posteriori variances for a fixed model or prediction (`fisher_scoring`)."""
    prediction = prediction or costs.prediction()
    moving = _moving(costs, held)
    logs = minimum(
        lambda logs: _scored(costs, prediction, start, moving, logs),
        np.log(_row(start)[moving]),
        lowest=_LOWEST,
        highest=_HIGHEST[moving],
    )
    return _variances(start, moving, logs[None, :])


def prior_cost(costs: Costs, variances: Variances) -> Floats:
    """Minus two log prior density of the noise; shape (g,).

    Priors are log-normal (`rules`), on k_L and k_R, on a gyro's random walk and stamps, and on a
    localiser. They keep a few legs from explaining a wrong base or a delay as noise, and are
    negligible against an hour of data.
    """
    middle, spread = _prior(costs)
    rows = np.stack(_each(variances), axis=-1)
    return np.asarray(np.sum(((0.5 * np.log(rows) - middle) / spread) ** 2, axis=-1))


def posterior_cost(
    costs: Costs, variances: Variances, prediction: Prediction | None = None
) -> Floats:
    """Minus two log posterior of a fixed model, or of another prediction; shape (g,)."""
    return costs(variances, prediction) + prior_cost(costs, variances)


def _prior(costs: Costs) -> tuple[Floats, Floats]:
    """Log means of the prior standard deviations, and their spread; infinite where unknown."""
    runs = costs.runs
    wheel, stamp = rules.TYPICAL_WHEEL_NOISE, rules.TYPICAL_STAMP_NOISE
    middle = np.array([wheel, wheel, 1.0, 1.0, stamp, *rules.TYPICAL_WALK])
    spread = np.full(len(_ALL), np.inf)
    spread[:2], spread[4] = rules.WHEEL_NOISE_SPREAD, rules.STAMP_NOISE_SPREAD
    if costs.point.options.reference_kind == "local_map":
        middle[2:4], spread[2:4] = rules.TYPICAL_MATCH, rules.MATCH_SPREAD
        spread[5:] = rules.WALK_SPREAD
    if costs.point.options.reference_kind == "incremental" and runs.headings_alone:
        seconds = float(runs.duration.sum() / runs.intervals.sum())
        middle[3], spread[3] = rules.TYPICAL_GYRO_WALK * np.sqrt(seconds), rules.GYRO_WALK_SPREAD
    return np.log(middle), spread


def _scored(
    costs: Costs, prediction: Prediction, base: Variances, moving: NDArray[np.bool_], logs: Floats
) -> tuple[float, Floats, Floats]:
    """Cost at log variances, its gradient and its expected Hessian (Fisher information).

    Derivatives of the innovations come from one pass of the filter over all sets.
    """
    step = 1e-4
    sets = _variances(base, moving, np.concatenate([logs[None], logs + step * np.eye(logs.size)]))
    found = costs.innovations(sets, prediction)
    cost = found.minus_two_log_likelihood() + prior_cost(costs, sets)
    counted = found.known.any(axis=-1)
    try:
        root = inverse_root(found.covariance[0, counted])
    except np.linalg.LinAlgError:  # beside a leg that may end anywhere all digits are lost
        return np.inf, np.zeros(logs.size), np.eye(logs.size)
    of_covariance = (found.covariance[1:, counted] - found.covariance[0, counted]) / step
    of_value = (found.value[1:, counted] - found.value[0, counted]) / step
    spread = (root @ of_covariance @ root.swapaxes(-1, -2)).reshape(logs.size, -1)
    shift = (root @ of_value[..., None]).reshape(logs.size, -1)
    curvature = spread @ spread.T + 2.0 * shift @ shift.T
    curvature += np.diag(0.5 / _prior(costs)[1][moving] ** 2)
    return float(cost[0]), (cost[1:] - cost[0]) / step, curvature


def noise_estimates(
    costs: Costs,
    variances: Variances,
    held: tuple[bool, bool],
    information: Callable[[Variances], float] | None = None,
) -> dict[str, NoiseEstimate]:
    """Noise estimates [m^0.5, m^0.5, m, rad] (and [s] for stamps) with standard deviations.

    Noises of what the reference does not measure are left out. Standard deviations are from the
    observed information. `costs`: likelihood at the fitted model. `variances`: maximum a posteriori
    variances. `held`: whether the reference's noise in position and in heading is known.
    `information`: log determinant of the information on the fitted model parameters, as a function
    of the variances. Fitting these absorbs noise. With it the estimates are those of restricted
    maximum likelihood (Patterson and Thompson, Biometrika 58, 1971), by one Newton step.
    """
    moving = _moving(costs, held)
    prediction = costs.prediction()

    def function(logs: Floats) -> Floats:
        return posterior_cost(costs, _variances(variances, moving, logs), prediction)

    sigmas = np.sqrt(_row(variances))
    logs = 2.0 * np.log(sigmas[moving])
    curved, highest = hessian(function, logs), _HIGHEST[moving]
    untold = np.diag(curved) < rules.NOISE_UNTOLD
    rising = untold & np.isclose(logs, highest)  # stopped by its bound, beyond which it is likelier
    rest = np.ix_(~rising, ~rising)
    covariance = np.zeros_like(curved)
    covariance[rest] = 2.0 * _inverse(curved[rest])
    most = {
        index: 0.5 * _highest(function, logs, index)
        for index in np.flatnonzero(untold & ~rising).tolist()
    }
    if information is not None:
        step = 0.1
        sides = logs + step * np.concatenate([np.eye(logs.size), -np.eye(logs.size)])
        found = [information(_variances(variances, moving, row[None])) for row in sides]
        gradient = np.subtract(*np.split(np.array(found), 2)) / (2.0 * step)
        shift = np.clip(-0.5 * covariance @ gradient, -1.0, 1.0)
        logs = np.where(np.isclose(logs, highest), logs, np.minimum(logs + shift, highest))
        sigmas[moving] = np.exp(0.5 * logs)
    share = np.zeros(len(_ALL))
    shares = 0.5 * np.sqrt(np.maximum(np.diag(covariance), 0.0))
    for index, log in most.items():  # so that the interval reaches that far
        shares[index] = (log - np.log(sigmas[moving][index])) / NORMAL_95
    share[moving] = shares
    told = moving | np.isin(
        _ALL, [name for name, known in zip(NOISES[2:], held, strict=True) if known]
    )
    return {
        name: NoiseEstimate(float(sigma), float(part), bool(part < rules.NOISE_TOLD))
        for name, sigma, part, tell in zip(_ALL, sigmas, share, told, strict=True)
        if tell
    }


def _inverse(information: Floats) -> Floats:
    """Inverse of an information matrix; of what nothing tells the variance is large, and not zero.

    A noise that is far below all others has none, or a little less than none by rounding.
    """
    values, ways = np.linalg.eigh(information)
    return np.asarray((ways / np.maximum(values, rules.NOISE_UNTOLD)) @ ways.T)


def _highest(function: Callable[[Floats], Floats], logs: Floats, index: int) -> float:
    """Log variance from which on one is contradicted at 95 %, the others as they are."""
    row = logs.copy()
    limit = float(function(row[None])[0]) + NORMAL_95**2
    while row[index] < _HIGHEST.max() and float(function(row[None])[0]) < limit:
        row[index] += np.log(2.0)
    return float(row[index])


def _moving(costs: Costs, held: tuple[bool, bool]) -> NDArray[np.bool_]:
    """Mask of the variances to estimate: those of what is measured and not known."""
    runs = costs.runs
    measured = np.isfinite(runs.finish)
    places, headings = bool(measured[:, :2].any()), bool(measured[:, 2].any())
    wanders = costs.point.options.reference_kind == "local_map"
    return np.array(
        [
            True,
            True,
            not held[0] and places,
            not held[1] and headings,
            runs.has_stamp_noise,
            wanders and places,
            wanders and headings,
            wanders,
        ]
    )


def _each(variances: Variances) -> tuple[Floats, ...]:
    """Variances in the order of `_ALL`."""
    return tuple(getattr(variances, item.name) for item in fields(variances))


def _row(variances: Variances) -> Floats:
    return np.array([part[0] for part in _each(variances)])


def _variances(base: Variances, moving: NDArray[np.bool_], logs: Floats) -> Variances:
    """Variances from rows of log values, shape (g, free)."""
    table = np.tile(_row(base), (logs.shape[0], 1))
    table[:, moving] = np.exp(logs)
    return Variances(*table.T)
