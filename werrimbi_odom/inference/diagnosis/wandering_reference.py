# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Whether the error of a reference that is taken as absolute wanders, as a localiser's does.

The poses of a localiser (AMCL, SLAM, visual odometry) err alike for seconds. Taken as independent,
such errors are put down to whatever of the robot resembles them: a floor, a delay, a lever arm. So
when everything is found that can be found, the same model is judged once more with a reference on a
local map. A sound reference gains nothing by that, whatever is hidden in the robot.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.evidence import Dependence, fall_of_cost
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.diagnosis.what_is_left import neighbours_are_alike
from werrimbi_odom.inference.distributions import chi2_survival
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.likelihood import Variances
from werrimbi_odom.inference.fitting.noise import WALK, map_variances, prior_cost, with_known_noise
from werrimbi_odom.inference.fitting.whitened_innovations import Costs


@dataclass(frozen=True, slots=True)
class Wander:
    """Slowly varying error of a reference: standard deviations of its change, and of itself."""

    place_in_a_second: float
    """[m]"""
    heading_in_a_second: float
    """[rad]"""
    place: float
    """In the long run [m]."""
    heading: float
    seconds: float
    """For how long it stays alike (correlation time) [s]. Short drives tell it, and the size in the
    long run, much less well than the change in a second."""


def wander_of(variances: Variances) -> Wander:
    """The wander of a reference on a local map."""
    place, _, heading = np.sqrt(variances.wandered()[0])
    walk = np.sqrt([variances.walk_xy[0], variances.walk_yaw[0]])
    seconds = 1.0 / np.sqrt(variances.reversion[0])
    return Wander(*map(float, (*walk, place, heading, seconds)))


def error_may_wander(runs: Concatenated, fit: Fitted, competing: Sequence[Dependence]) -> bool:
    """Whether a wandering reference explains some of what a model of everything found leaves.

    Scans are left alone, as the noise of each is known from its match, and headings alone, whose
    walk is a gyro's. `fit`: the final model, with independent errors of the poses. `competing`:
    cells of its evidence map; none where nothing is missing otherwise.
    """
    point = fit.point
    independent = point.options.reference_kind == "absolute"
    if not independent or runs.has_stamp_noise or runs.data < rules.NOISE_NUMBERS:
        return False
    options = replace(point.options, reference_kind="local_map")
    costs = Costs(runs, replace(point, options=options))
    some = _typical(point.variances)
    # One pass over a few typical localisers: with a sound reference all of them are far worse. So
    # they are beside motion capture, whose wander is small; but it makes neighbouring legs alike,
    # as does what the library lacks, so that counts only where no dependence competes.
    trial = costs(some) + prior_cost(costs, some)
    best = int(np.argmin(trial))
    if trial[best] > fit.cost and (competing or not neighbours_are_alike(runs, point)):
        return False
    start = with_known_noise(_chosen(some, best), options)
    found = map_variances(costs, start, options.sigmas_known)
    gain = fit.cost - float((costs(found) + prior_cost(costs, found))[0])
    return chi2_survival(gain, len(WALK)) < rules.VERY_SURE


def explains_more(
    runs: Concatenated, fit: Fitted, wandering: Fitted, competing: Sequence[Dependence]
) -> bool:
    """Whether a wandering reference explains more than an effect that the library does not hold.

    Such an effect is a dependence on a variable, of those `competing` with the model `fit`. With
    the wander goes what was found beside it, as the final model `wandering` of a diagnosis: its
    gain is over the same legs, and pays for what it has more.
    """
    costs = Costs(runs, replace(wandering.point, excluded=fit.point.excluded))
    variances = wandering.point.variances
    gain = fit.total - float((costs(variances) + prior_cost(costs, variances))[0])
    most = max((fall_of_cost(cell.gain, runs.data) for cell in competing), default=0.0)
    worth = gain - wandering.penalty - rules.WANDER_OVER_DEPENDENCE * most
    return chi2_survival(worth, len(WALK)) < rules.VERY_SURE


def _typical(fitted: Variances) -> Variances:
    """Localisers about the middle of their prior, each with typical wheels and two noises."""
    sides = (-1.0, 0.0, 1.0)
    noises = ((fitted.xy[0], fitted.yaw[0]), np.square(rules.TYPICAL_MATCH))
    wheels = np.full(2, rules.TYPICAL_WHEEL_NOISE**2)
    rows = []
    for noise, size, rate in product(noises, sides, sides):
        walk = np.array(rules.TYPICAL_WALK) * np.exp(rules.WALK_SPREAD * [size, size, rate])
        rows.append(np.concatenate([wheels, noise, fitted.stamp, np.square(walk)]))
    return Variances(*np.stack(rows, axis=-1))


def _chosen(sets: Variances, index: int) -> Variances:
    return Variances(*(getattr(sets, name)[[index]] for name in Variances.__slots__))
