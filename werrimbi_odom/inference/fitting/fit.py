# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Maximum-likelihood fit of calibration, effects and noise from any driving with a reference.

Two nearly independent blocks of parameters are fitted in turn: model parameters (multipliers,
parameters of effects, nuisance parameters of runs) by Gauss-Newton on the whitened innovations, and
variances (`noise`) by their likelihood. Parameters that the driving does not excite keep their
values.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import (
    CALIBRATION,
    START_YAW,
    YAW_DRIFT,
    FreeParameter,
    Model,
    shared_of,
)
from werrimbi_odom.inference.fitting.gauss_newton import gauss_newton, is_small, moved, step_within
from werrimbi_odom.inference.fitting.identifiable import (
    CALIBRATED,
    Directions,
    determined,
    with_held_as_given,
)
from werrimbi_odom.inference.fitting.likelihood import Variances
from werrimbi_odom.inference.fitting.noise import map_variances, posterior_cost, with_known_noise
from werrimbi_odom.inference.fitting.start_headings import (
    first_heading,
    only_first_heading,
    turned_to_all_sides,
)
from werrimbi_odom.inference.fitting.whitened_innovations import Costs, Point, stacked, unexpected
from werrimbi_odom.inference.legs.matched_run import MatchedRun
from werrimbi_odom.model.effect import view_of
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

_MEDIAN_CHI2_3 = 2.366
_TAIL = 4.0  # degrees of freedom of the Student-t weights until jumps are known


@dataclass(frozen=True, slots=True)
class ModelFit:
    """Result of a fit."""

    point: Point
    free: tuple[FreeParameter, ...]
    """Shared parameters that the driving determines, and that were fitted."""
    covariance: Floats
    """Covariance of the values of `free`; singular where they exceed the identifiable `numbers`."""
    not_identifiable: tuple[FreeParameter, ...]
    """Shared parameters that are not identifiable; left unchanged."""
    directions: Directions
    """Identifiable directions, in the columns of the design."""
    at_bound: tuple[FreeParameter, ...]
    """Fitted parameters that ended at a physical bound."""
    minus_two_log_likelihood: float
    """Minus two log posterior: includes the prior on the noise (`noise.posterior_cost`)."""

    @property
    def held(self) -> tuple[str, ...]:
        """Directions that are not identifiable (of `CALIBRATED`, or parameters): kept as given."""
        return self.directions.held

    @property
    def numbers(self) -> int:
        """Number of shared parameters that the data determine (rank)."""
        return len(self.directions.shared)

    @property
    def robot(self) -> Robot:
        """Robot with all fitted values."""
        return self.point.model.robot


def start_point(
    runs: Concatenated, robot: Robot, options: EvaluationOptions = EvaluationOptions()
) -> Point:
    """Start of a fit: the robot as given, no leg excluded, start headings from the first legs."""
    guess = (
        max(robot.left_wheel_noise, rules.LEAST_WHEEL_NOISE),
        max(robot.right_wheel_noise, rules.LEAST_WHEEL_NOISE),
        options.sigma_xy or rules.MOTION_CAPTURE_XY,
        options.sigma_yaw or rules.MOTION_CAPTURE_YAW,
        rules.TYPICAL_STAMP_NOISE,
        *rules.TYPICAL_WALK,
    )
    if runs.headings_alone and options.sigma_yaw is None:
        guess = (*guess[:3], rules.TYPICAL_GYRO_WALK, *guess[4:])
    own = tuple(_nuisances(robot, run, options) for run in runs.runs)
    return Point(
        Model(robot, own),
        Variances(*(np.array([value**2]) for value in guess)),
        tuple(np.zeros(run.legs, dtype=np.bool_) for run in runs.runs),
        options,
    )


def fit_model(
    runs: Concatenated,
    point: Point,
    numbers: Sequence[FreeParameter] = CALIBRATION,
    *,
    given: Model | None = None,
    find_jumps: bool = True,
    rounds: int = 3,
) -> ModelFit:
    """Fit parameters and noise to all runs at once.

    `runs`: runs to fit. `point`: start of the fit. `numbers`: parameters that may change, including
    per-run ones. `given`: values of what the driving does not determine. Those of the start, if not
    given. `find_jumps`: find the legs on which the reference jumped. Do this once for a set of
    runs: fits that are compared must exclude the same legs. `rounds`: largest number of
    alternations between noise and model parameters.
    """
    given = given or point.model
    if find_jumps:
        noise = point.variances
        point = _robustly(runs, point, numbers)
        if not runs.tells_noise:
            point = replace(point, variances=noise)
    point = replace(point, variances=with_known_noise(point.variances, point.options))
    if rounds > 0:
        point = turned_to_all_sides(runs, point)
    directions: Directions | None = None
    moved, start = False, point.model.robot
    for _ in range(rounds):
        point = _with_fitted_noise(runs, point)
        design = stacked(runs, point, numbers)
        held = directions.held if directions else ()
        directions = determined(design, point.model.robot, held)
        model = point.model
        if moved and any(name in CALIBRATED and name not in held for name in directions.held):
            model = model.with_sizes_of(start)  # the others moved with it, and stay where they are
        model = with_held_as_given(model, given, directions.held, shared_of(numbers))
        point, moved = gauss_newton(runs, replace(point, model=model), numbers, directions)
        if not moved:
            break
    if directions is None:
        design = stacked(runs, point, numbers)
        directions = determined(design, point.model.robot)
    elif moved:  # to the last: the noise is that of the model before
        point = _with_fitted_noise(runs, point)
        design = stacked(runs, point, numbers)
        directions = directions.that_move(design.flat()[1])
        model = with_held_as_given(point.model, given, directions.held, shared_of(numbers))
        point = replace(point, model=model)
    covariance = directions.covariance(design.flat()[1])
    moves = directions.matrix[:, directions.shared].any(axis=1)
    where = np.flatnonzero(moves)
    free = [design.columns[index][0] for index in where]
    costs = Costs(runs, point)
    return ModelFit(
        point,
        tuple(free),
        covariance[np.ix_(where, where)],
        tuple(number for number in shared_of(numbers) if number not in free),
        directions,
        tuple(number for number in free if _at_bound(point.model.value(number), number)),
        float(posterior_cost(costs, point.variances)[0]),
    )


def _with_fitted_noise(runs: Concatenated, point: Point) -> Point:
    """The point with the noise that its model leaves, where data are enough to tell it."""
    if not runs.tells_noise:
        return point
    found = map_variances(Costs(runs, point), point.variances, point.options.sigmas_known)
    return replace(point, variances=found)


def _at_bound(value: float, number: FreeParameter) -> bool:
    if number.is_direction:
        return False
    low, high = number.bounds_about(value)
    margin = 1e-6 * (high - low)
    return value <= low + margin or value >= high - margin


def _robustly(runs: Concatenated, point: Point, numbers: Sequence[FreeParameter]) -> Point:
    """Iteratively reweighted least squares with Student-t weights, then detection of jumps."""
    for _ in range(12):
        design = stacked(runs, point, numbers)
        deviation = np.sum(design.white**2, axis=-1)
        counted = deviation > 0.0
        scale = float(np.median(deviation[counted])) / _MEDIAN_CHI2_3 if counted.any() else 1.0
        point = replace(point, variances=_scaled(point.variances, max(scale, 1e-6)))
        weight = (_TAIL + 3.0) / (_TAIL + deviation / scale)
        step = step_within(design, determined(design, point.model.robot), weight)
        point = replace(point, model=moved(point.model, design, step))
        if is_small(design, step):
            break
    return replace(point, excluded=_jumps(runs, point))


def without_jumps(runs: Concatenated, point: Point) -> Point:
    """Exclude the legs whose innovations are outliers under the point's model."""
    return replace(point, excluded=_jumps(runs, point))


def _jumps(runs: Concatenated, point: Point) -> tuple[NDArray[np.bool_], ...]:
    """Legs of each run whose whitened innovations are outliers."""
    nothing = tuple(np.zeros(size, dtype=np.bool_) for size in np.diff(runs.legs))
    if runs.headings_alone:
        return nothing  # a gyro does not jump: outliers are legs with turns
    white = unexpected(runs, replace(point, excluded=nothing)).whitened()
    deviation = np.sum(white**2, axis=-1)
    found = []
    for first, last in zip(runs.legs[:-1], runs.legs[1:], strict=True):
        own = deviation[first:last]
        usual = max(float(np.median(own)) / _MEDIAN_CHI2_3, 1.0)
        found.append(own > rules.JUMP_OF_A_LEG * usual)
    if point.options.reference_kind == "local_map":
        return _jumps_put_aside(runs, replace(point, excluded=tuple(found)))
    return tuple(found)


def _jumps_put_aside(runs: Concatenated, point: Point) -> tuple[NDArray[np.bool_], ...]:
    """The legs excluded, and the parts put aside for judging in which the reference jumped.

    Its error reverts to zero, so legs after a part tell whether it was as usual there.
    """

    def cost_of_runs(excluded: tuple[NDArray[np.bool_], ...]) -> Floats:
        legs = unexpected(runs, replace(point, excluded=excluded)).cost_of_legs()[0]
        return np.add.reduceat(legs, runs.legs[:-1])

    kept = runs.gap & ~runs.lost
    if not kept.any():
        return point.excluded
    aside = [np.flatnonzero(kept[first:last]) for first, last in pairwise(runs.legs.tolist())]
    usual, found = cost_of_runs(point.excluded), [own.copy() for own in point.excluded]
    for number in range(max(map(len, aside))):
        asked = [own.copy() for own in point.excluded]
        for own, legs in zip(asked, aside, strict=True):
            own[legs[number : number + 1]] = True
        jumped = usual - cost_of_runs(tuple(asked)) > rules.JUMP_PUT_ASIDE
        for own, legs, here in zip(found, aside, jumped, strict=True):
            own[legs[number : number + 1]] |= here
    return tuple(found)


def _scaled(variances: Variances, factor: float) -> Variances:
    parts = {item.name: getattr(variances, item.name) for item in fields(variances)}
    scaled = {name: part * factor for name, part in parts.items() if name != "reversion"}
    return replace(variances, **scaled)


def _nuisances(robot: Robot, run: MatchedRun, options: EvaluationOptions) -> dict[str, float]:
    """Nuisance parameters of a run: what its reference does not measure, or nobody knows how well.

    The noise of one heading cannot be estimated. Positions tell the heading better than a guess.
    """
    heading = first_heading(robot, run)
    if options.sigma_yaw is None and only_first_heading(run):
        heading = float(run.measured.yaw[0])
        heading = -heading if view_of(robot.effects).mirrored else heading
    own = {} if heading is None else {START_YAW: heading}
    if not run.measured.has_position.any():
        own[YAW_DRIFT] = 0.0  # a reference of headings only is a gyro, and gyros drift
    return own
