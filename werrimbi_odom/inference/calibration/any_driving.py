# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Calibration from any driving: what is determined, what is not, and whether the model fits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.evidence import Dependence, dependences
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.fit import ModelFit, fit_model, start_point
from werrimbi_odom.inference.fitting.free_parameters import CALIBRATION, MULTIPLIERS
from werrimbi_odom.inference.fitting.likelihood import errors_between
from werrimbi_odom.inference.fitting.noise import (
    NoiseEstimate,
    beyond_wheel_noise,
    noise_estimates,
    with_noise,
)
from werrimbi_odom.inference.fitting.precision import Precision
from werrimbi_odom.inference.fitting.prediction import predict, right_handed
from werrimbi_odom.inference.fitting.run_phases import own_parameters, with_own_values
from werrimbi_odom.inference.fitting.whitened_innovations import Costs
from werrimbi_odom.inference.legs.matched_run import MatchedRun
from werrimbi_odom.model.effect import view_of
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot


@dataclass(frozen=True, slots=True)
class Multiplier:
    """A calibration multiplier before and after."""

    before: float
    value: float
    std: float | None
    """Standard deviation; None if not identifiable, or if the model does not fit."""
    determined: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Calibration:
    """Result of a fit of calibration and noise."""

    robot: Robot
    """Robot with all determined values, except a noise too large for a wheel."""
    multipliers: dict[str, Multiplier]
    noises: dict[str, NoiseEstimate]
    changes: dict[str, float]
    """Parameters to write to the robot file."""
    correlation: Floats
    """Correlation of the determined multipliers, in the order of `fit.free`."""
    misfit: tuple[Dependence, ...]
    """What the residuals still depend on; empty if the model explains them."""
    strange: tuple[str, ...]
    """Sentences about implausible results."""
    excluded: tuple[NDArray[np.bool_], ...]
    """Mask of the legs of each run on which the reference jumped."""
    fit: ModelFit

    @property
    def twin(self) -> dict[str, float]:
        """Equivalent multipliers where only two are identifiable: given base, other radii."""
        if self.fit.held != ("wheel_radius_scale",):
            return {}
        base, left, right = (self.multipliers[name] for name in MULTIPLIERS)
        share = base.before / base.value
        return dict(
            zip(MULTIPLIERS, (base.before, share * left.value, share * right.value), strict=True)
        )

    @property
    def trusted(self) -> bool:
        """Whether the model explains the data, so that standard deviations are valid."""
        return not self.misfit and not self.strange


def calibrate(
    runs: Sequence[MatchedRun], robot: Robot, options: EvaluationOptions = EvaluationOptions()
) -> Calibration:
    """Fit base, radii and noise to all runs at once, and test the result.

    `runs`: runs cut into legs. `options`: what is known of the reference.
    """
    laid = concatenated(runs)
    begin, _ = with_own_values(laid, start_point(laid, robot, options))
    numbers = (*CALIBRATION, *own_parameters(begin), *begin.model.nuisance_parameters)
    fit = fit_model(laid, begin, numbers)
    held = options.sigmas_known
    precision = Precision.of(laid, fit.point, numbers, fit.directions.matrix)
    noises = noise_estimates(
        Costs(laid, fit.point), fit.point.variances, held, precision.information
    )
    turned = [number for number in numbers if number.per_run or number in fit.free]
    found = dependences(laid, fit.point, turned)
    misfit = tuple(item for item in found if item.p_value < rules.VERY_SURE)
    strange = _strange(fit, noises)
    names = [number.name for number in fit.free]
    usual = np.sqrt(np.diag(fit.covariance))
    spread = usual * precision.widening(noises, names)
    multipliers = {}
    for name in MULTIPLIERS:
        determined = name in names
        honest = determined and not misfit and not strange
        multipliers[name] = Multiplier(
            float(getattr(robot, name)),
            float(getattr(fit.robot, name)),
            float(spread[names.index(name)]) if honest else None,
            determined,
        )
    wheels = {
        name: noises[name]
        for name in ("left_wheel_noise", "right_wheel_noise")
        if noises[name].determined and not beyond_wheel_noise(noises[name])
    }
    changes = {name: item.value for name, item in multipliers.items() if item.determined}
    return Calibration(
        robot=with_noise(fit.robot, wheels),
        multipliers=multipliers,
        noises=noises,
        changes=changes | {name: item.value for name, item in wheels.items()},
        correlation=fit.covariance / np.outer(usual, usual),
        misfit=misfit,
        strange=strange,
        excluded=fit.point.excluded,
        fit=fit,
    )


def _strange(fit: ModelFit, noises: dict[str, NoiseEstimate]) -> tuple[str, ...]:
    said = [f"{number.name} ran against what is possible" for number in fit.at_bound]
    for name in ("left_wheel_noise", "right_wheel_noise"):
        if beyond_wheel_noise(noises[name]):
            said.append(
                f"{name} would have to be {rules.STRANGE_NOISE:g} m^0.5 or more, "
                "which is no rolling wheel's noise"
            )
    return tuple(said)


def errors_of_legs(
    robot: Robot, runs: Sequence[MatchedRun], headings: Sequence[float | None]
) -> Floats:
    """Measured minus predicted (along, sideways, heading) of all legs of all runs, shape (m, 3).

    NaN where the reference gives no relative pose.
    """
    view, found = view_of(robot.effects), []
    for run, heading in zip(runs, headings, strict=True):
        legs = concatenated([run])
        start, finish = (right_handed(poses, view) for poses in (legs.start, legs.finish))
        found.append(errors_between(start, finish, predict(robot, run, heading)))
    return np.concatenate(found)
