# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Model selection by penalised likelihood: what models cost, and which parameters they need.

A model is the robot, some effects, and its multipliers. Its cost is minus two log-likelihood with
the noise fitted, plus a penalty for each free parameter (BIC, with a floor). Parameters that do not
pay their penalty are left out. All eight subsets of the three calibration effects are compared, by
the quadratic approximation of the likelihood at the fit, without new fits.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.calibration_parametrisation import sizes_of, std_as_effect
from werrimbi_odom.inference.diagnosis.fit_statistics import (
    covariance_of,
    grain_of,
    inflation_by_neighbours,
    residual_degrees_of,
    scatter_of,
    wald_statistic,
    wald_test,
)
from werrimbi_odom.inference.diagnosis.size_statistics import (
    calibration_rises,
    freedom_of_sizes,
    variance_inflation_of_sizes,
)
from werrimbi_odom.inference.fitting.clusters import widening
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.fit import fit_model
from werrimbi_odom.inference.fitting.free_parameters import (
    CALIBRATION,
    MULTIPLIERS,
    NUISANCES,
    FreeParameter,
    Model,
    changed,
    own_of,
    parameters_to_fit,
    shared_of,
)
from werrimbi_odom.inference.fitting.identifiable import CALIBRATED, determined
from werrimbi_odom.inference.fitting.whitened_innovations import Design, Point, stacked
from werrimbi_odom.inference.set_up.misentered_values import is_ordinary
from werrimbi_odom.model.effect import Effect, applied_of
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

RATIO = "unequal_wheel_radii.ratio"


@dataclass(frozen=True, slots=True)
class Fitted:
    """A model fitted to all runs, and its cost."""

    names: tuple[str, ...]
    """Effects of the model beyond those of the given robot."""
    point: Point
    numbers: tuple[FreeParameter, ...]
    """Fitted parameters."""
    cost: float
    """Minus two log-likelihood."""
    calibrated: tuple[str, ...]
    """Those of the three calibration effects that the model needs."""
    alternatives: tuple[tuple[str, ...], ...]
    """Other subsets of the same size that explain as much."""
    penalty: float
    """Penalty of all free parameters, without the needless calibration effects."""
    penalty_of_one: float
    """Penalty of one free parameter."""
    penalty_of_own: float
    """Penalty of one that each run has of its own."""
    paid: int
    """Number of free parameters in `penalty`, each run's own counted for itself."""
    scatter: float
    """Dispersion: factor by which costs are too large where few data determine the noise."""
    spare: float
    """Degrees of freedom of `scatter`; infinite where the noise was fitted."""
    neighbours: float
    """Factor by which the newest effect's gain is too large by chance, as legs that share a pose of
    an incremental reference err against one another; else 1."""
    needless_gain: float
    """Rise of the cost when needless calibration effects are reset to the given values."""
    at_bound: tuple[str, ...]
    """Free parameters at their physical bound; `RATIO` where the two wheels differ by more than
    those of any robot."""
    importance: dict[str, float]
    """Rise of the cost without an effect, by its name."""
    covariance: Floats
    """Covariance of the values of the design's columns, scaled up where the parts disagree by more
    than the noise."""
    widening: Floats
    """Factor of that on each standard deviation, (p,)."""
    freedom: dict[str, float]
    """Degrees of freedom in which the parts tell the scatter of each calibration effect."""
    moves: Floats
    """Step of the design's columns for a unit of each free direction; (p, q)."""
    design: Design
    held: tuple[str, ...]
    """Shared directions (of `CALIBRATED`, or parameters) that the runs do not determine: held as
    given."""
    or_else: Fitted | None = None
    """The newest effect of the other sign, where that fits as well: a flat for a bump."""

    @property
    def sizes_held(self) -> bool:
        """Whether the runs leave some of the calibration undetermined."""
        return bool(set(self.held) & set(CALIBRATED))

    @property
    def by_noise(self) -> Floats:
        """Covariance by the noise alone."""
        return self.covariance / np.outer(self.widening, self.widening)

    @property
    def doubts(self) -> dict[str, float]:
        """Factor by which the parts scaled the variance of each calibration effect."""
        return variance_inflation_of_sizes(
            self.design, self.by_noise, self.widening, self.point.model.robot
        )

    @property
    def squares(self) -> float:
        """Sum of the squared innovations."""
        return float(np.sum(self.design.white**2))

    @property
    def newest(self) -> Effect:
        """The last of its effects beyond those of the given robot."""
        return applied_of(self.point.model.robot.effects, self.names[-1]).effect

    @property
    def determined(self) -> bool:
        """Whether the runs determine the newest effect's parameters; otherwise it is no finding."""
        if not self.names or self.names[-1] in CALIBRATED:
            return True
        effect = self.newest
        own = [f"{effect.name}.{key}" for key, item in effect.parameters.items() if not item.tries]
        return any(key not in self.held for key in own)

    def std_of_size(self, name: str) -> float:
        """Standard deviation of the logarithm of a calibration effect."""
        where = [self.design.names.index(multiplier) for multiplier in MULTIPLIERS]
        spread = self.covariance[np.ix_(where, where)]
        return std_as_effect(name, self.point.model.robot, spread)

    def without(self, name: str) -> tuple[Point, tuple[FreeParameter, ...]]:
        """Point and parameters of the same model without one of its effects."""
        point = replace(self.point, model=self.point.model.without_effect(name))
        own = f"{name}."
        return point, tuple(each for each in self.numbers if not each.name.startswith(own))

    @property
    def total(self) -> float:
        """Cost with all penalties."""
        return self.cost + self.needless_gain + self.penalty * self.scatter


def unequal_beyond_physics(robot: Robot, given: Robot) -> bool:
    """Whether a model has wheels that differ more than two wheels of one robot can.

    Such a model explains something else: a robot that slides past its gyro turns as little as one
    with a wheel of half the size, and then any law of the wheels lowers the error.
    """
    ratio = sizes_of(robot).over(sizes_of(given)).as_effects["unequal_wheel_radii"]
    return not is_ordinary(ratio)


def penalty_of_one(runs: Concatenated, *, own: bool = False) -> float:
    """Penalty of one free parameter: the logarithm of the number of data (BIC), or its floor.

    `own`: each run has its own value (a phase, a rate): of the data, only those of one run tell it.
    """
    data = runs.data / len(runs.runs) if own else runs.data
    return max(rules.PENALTY_FLOOR, math.log(max(data, 2)))


def fitted(
    runs: Concatenated,
    point: Point,
    names: Sequence[str],
    numbers: Sequence[FreeParameter],
    given: Robot,
    *,
    rounds: int = 2,
) -> Fitted:
    """Fit a model with its calibration, and select the calibration effects that it needs."""
    every = (*CALIBRATION, *numbers, *point.model.nuisance_parameters)
    nothing = _without_sizes(point.model, given)
    result = fit_model(runs, point, every, given=nothing, find_jumps=False, rounds=rounds)
    design = stacked(runs, result.point, [*CALIBRATION, *own_of(every), *shared_of(numbers)])
    ways = determined(design, result.robot, result.held)
    penalty, of_own = penalty_of_one(runs), penalty_of_one(runs, own=True)
    scatter = scatter_of(runs, design)
    rises = calibration_rises(design, result.robot, given, ways.held)
    totals = {each.kept: each.rise / scatter + penalty * len(each.kept) for each in rises}
    kept, rise, *_ = min(
        (each for each in rises if each.fitted), key=lambda each: totals[each.kept]
    )
    by_increments = point.options.reference_kind == "incremental" and not runs.headings_alone
    wide = widening(*design.flat(), ways.matrix, runs)
    covariance = covariance_of(design, ways)
    doubt = variance_inflation_of_sizes(design, covariance, wide, result.robot)
    covariance = covariance * np.outer(wide, wide)
    importance = {name: wald_statistic(name, design, covariance, result.point) for name in names}
    for name in kept:
        without = tuple(other for other in kept if other != name)
        rest = next(each.rise for each in rises if each.kept == without)
        importance[name] = (rest - rise) / max(scatter, doubt[name])
    counted = [
        run
        for number, run in design.columns
        if number.name not in MULTIPLIERS and number.name not in NUISANCES
    ]
    shared = len(kept) + sum(run < 0 for run in counted)
    owned = sum(run >= 0 for run in counted)
    return Fitted(
        tuple(names),
        result.point,
        tuple(numbers),
        result.minus_two_log_likelihood,
        kept,
        tuple(
            each.kept
            for each in rises
            if each.kept != kept
            and len(each.kept) == len(kept)
            and totals[each.kept] - totals[kept] < rules.RIVAL
            and each.believed
        ),
        penalty * shared + of_own * owned,
        penalty,
        of_own,
        shared + owned,
        scatter,
        residual_degrees_of(runs, design),
        inflation_by_neighbours(runs, design, names[-1]) if by_increments and names else 1.0,
        rise,
        (
            *(
                number.name
                for number in result.at_bound
                if number.name not in MULTIPLIERS and not number.refines
            ),
            *([RATIO] if unequal_beyond_physics(result.robot, given) else []),
        ),
        importance,
        covariance + np.diag(grain_of(design, result.robot)),
        wide,
        freedom_of_sizes(runs, design, result.robot),
        ways.matrix,
        design,
        ways.held,
    )


def refined(runs: Concatenated, fit: Fitted, given: Robot) -> Fitted:
    """A fit with what refines its newest law free (`Parameter.refines`), where that pays.

    Of a fit of the given robot, with what refines the laws that it holds. Also by its own
    deviation, as in `add`: a freer fit may be cheaper because it ended in another minimum.
    """
    there = {number.name for number in fit.numbers}
    held = [applied.effect for applied in fit.point.model.robot.effects]
    freed = [
        (effect, [number for number in parameters_to_fit(effect) if number.refines])
        for effect in ([fit.newest] if fit.names else held)
    ]
    more = [number for _, own in freed for number in own if number.name not in there]
    if not more:
        return fit
    wider = fitted(runs, fit.point, fit.names, (*fit.numbers, *more), given)
    rise = 0.0
    for effect, own in freed:
        asked = [number.name.rpartition(".")[2] for number in own if number in more]
        rise += wald_test(effect, asked, wider.design, wider.covariance, wider.point)[0]
    pays = rise > wider.penalty_of_one * len(more) and wider.total < fit.total
    return wider if pays else fit


def _without_sizes(model: Model, given: Robot) -> Model:
    """A model with the sizes of all effects beyond the given robot's at null.

    A score of drives that do not determine a size suggests a start far away: on lines and spins
    alone a base that grows with sharpness, beside a base that makes up for it.
    """
    own = {item.name for item in given.effects}
    nulls = {
        f"{item.name}.{name}": null
        for item in model.robot.effects
        if item.name not in own
        for name, null in item.effect.nulls.items()
        if item.effect.has_null(name)
    }
    return Model(changed(model.robot, nulls), model.own)
