# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Whether the error of a reference that is taken as absolute wanders, as a localiser's does.

The poses of a localiser (AMCL, SLAM, visual odometry) err alike for seconds. Taken as independent,
such errors are put down to whatever of the robot resembles them: a floor, a delay, a lever arm. So
when everything is found that can be found, all is judged once more with a reference on a local map.
A sound reference gains nothing by that, or less than what is hidden in the robot explains.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.evidence import Dependence, fall_of_cost
from werrimbi_odom.inference.diagnosis.homogeneity import change_of
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.diagnosis.what_is_left import neighbours_are_alike
from werrimbi_odom.inference.distributions import bonferroni, chi2_survival
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import CALIBRATION
from werrimbi_odom.inference.fitting.likelihood import Variances
from werrimbi_odom.inference.fitting.noise import (
    WALK,
    map_variances,
    posterior_cost,
    with_known_noise,
)
from werrimbi_odom.inference.fitting.prediction import predict_all
from werrimbi_odom.inference.fitting.score_tests import of_each_run
from werrimbi_odom.inference.fitting.whitened_innovations import Costs, Point, jacobian_of
from werrimbi_odom.inference.linear import DETERMINED, solved
from werrimbi_odom.model.pose import Floats


@dataclass(frozen=True, slots=True)
class Wander:
    """Slowly varying error of a reference: standard deviations of its change, and of itself."""

    place_in_a_second: float
    """[m]"""
    heading_in_a_second: float | None
    """[rad]; None where no heading was measured, as of `heading`."""
    place: float
    """In the long run [m]."""
    heading: float | None
    seconds: float
    """For how long it stays alike (correlation time) [s]. Short drives tell it, and the size in the
    long run, much less well than the change in a second."""


def wander_of(variances: Variances, *, positions_alone: bool = False) -> Wander:
    """The wander of a reference on a local map.

    `positions_alone`: whether no heading was measured. The variances of one are then the prior's.
    """
    place, _, heading = np.sqrt(variances.wandered()[0])
    walk = np.sqrt([variances.walk_xy[0], variances.walk_yaw[0]])
    seconds = 1.0 / np.sqrt(variances.reversion[0])
    found = Wander(*map(float, (*walk, place, heading, seconds)))
    return replace(found, heading_in_a_second=None, heading=None) if positions_alone else found


def wanders_far(variances: Variances) -> bool:
    """Whether a reference wanders as localisers do, and no camera system."""
    return bool(variances.wandered()[0].max() > rules.SMALL_WANDER**2)


def error_may_wander(runs: Concatenated, fit: Fitted) -> bool:
    """Whether a wandering reference explains some of what a model of everything found leaves.

    Scans are left alone, as the noise of each is known from its match, and headings alone, whose
    walk is a gyro's. `fit`: the final model, with independent errors of the poses.
    """
    point = fit.point
    independent = point.options.reference_kind == "absolute"
    if not independent or runs.has_stamp_noise or not runs.tells_noise:
        return False
    options = replace(point.options, reference_kind="local_map")
    costs = Costs(runs, replace(point, options=options))
    some = _typical(point.variances)
    # One pass over a few typical localisers: with a sound reference all of them are far worse. So
    # they are beside motion capture, whose wander is small; but it makes neighbouring legs alike.
    trial = posterior_cost(costs, some)
    best = int(np.argmin(trial))
    small = trial[best] > fit.cost
    if small and not neighbours_are_alike(runs, point):
        return False
    start = with_known_noise(_chosen(some, best), options)
    found = map_variances(costs, start, options.sigmas_known)
    gain = fit.cost - float(posterior_cost(costs, found)[0])
    if small and wanders_far(found):
        return False
    return chi2_survival(gain, len(WALK)) < rules.VERY_SURE


def explains_all(
    runs: Concatenated,
    fit: Fitted,
    wandering: Fitted,
    competing: Sequence[Dependence],
    *,
    of_a_law: bool,
) -> bool:
    """Whether a wandering reference explains what an effect that the library does not hold might.

    Such an effect is a dependence on a variable, of those `competing` with the model `fit`. With
    the wander goes what was found beside it, the final model `wandering` of a diagnosis. Over the
    same legs, with what it has more paid for, that must explain more than independent errors do.
    And it must explain far more than any dependence, or none may be needed beside it: a wander that
    an effect was taken for becomes smaller beside it. `of_a_law`: whether the dependence is what a
    law of the model leaves, and so has a cause already.
    """
    point = replace(wandering.point, excluded=fit.point.excluded)
    costs = Costs(runs, point)
    cost = float(posterior_cost(costs, point.variances)[0])
    gain = fit.total - wandering.penalty - cost
    most = max((fall_of_cost(cell.gain, runs.data) for cell in competing), default=0.0)
    if chi2_survival(gain, len(WALK)) > rules.VERY_SURE:
        return False
    if chi2_survival(gain - rules.WANDER_OVER_DEPENDENCE * most, len(WALK)) < rules.VERY_SURE:
        return True
    if of_a_law:
        return False
    numbers = [number for number in (*CALIBRATION, *wandering.numbers) if not number.per_run]
    of_numbers = jacobian_of(runs, point.model, numbers)
    for cell in competing[: rules.CELLS_ASKED]:
        fall = cost - _cost_beside(runs, point, cell, of_numbers)
        if bonferroni(len(competing), chi2_survival(fall, cell.degrees)) < rules.SURE:
            return False
    return True


def _cost_beside(runs: Concatenated, point: Point, cell: Dependence, of_numbers: Floats) -> float:
    """Cost of a wander and a dependence together, with the noise and all numbers fitted anew.

    `of_numbers` (m, 3, p): change of the legs for the numbers that all runs share.
    """
    change = change_of(runs, point, cell)
    if cell.variable.per_run:
        change = of_each_run(runs, change)
    slopes = np.concatenate([change, of_numbers], axis=-1)
    costs, before = Costs(runs, point), predict_all(point.model, runs)
    variances, seen = point.variances, before
    for _ in range(rules.BESIDE_ROUNDS):
        told = costs.innovations(variances, before)
        marks = told.marks(slopes)[..., :-1].reshape(3 * runs.count, -1)
        moved = solved(marks, -told.whitened().ravel(), DETERMINED)
        seen = replace(before, relative=before.relative + slopes @ moved)
        variances = map_variances(costs, variances, point.options.sigmas_known, seen)
    return float(posterior_cost(costs, variances, seen)[0])


def _typical(fitted: Variances) -> Variances:
    """Localisers about the middle of their prior, each with typical wheels and two noises."""
    sides = (-1.0, 0.0, 1.0)
    noises = ((fitted.xy[0], fitted.yaw[0]), np.square(rules.TYPICAL_MATCH))
    wheels = np.full(2, rules.TYPICAL_WHEEL_NOISE**2)
    rows = []
    for noise, size, rate in product(noises, rules.WANDERS_TRIED, sides):
        walk = np.array(rules.TYPICAL_WALK) * np.exp(rules.WALK_SPREAD * [size, size, rate])
        rows.append(np.concatenate([wheels, noise, fitted.stamp, np.square(walk)]))
    return Variances(*np.stack(rows, axis=-1))


def _chosen(sets: Variances, index: int) -> Variances:
    return Variances(*(getattr(sets, name)[[index]] for name in Variances.__slots__))
