# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Forward selection of missing effects: score all, fit the best few, keep what pays its penalty."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from werrimbi_odom.effects.lookup import find
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.either_sign import cheapest_of
from werrimbi_odom.inference.diagnosis.evidence import Dependence, dependences, fall_of_cost
from werrimbi_odom.inference.diagnosis.fit_statistics import wald_test
from werrimbi_odom.inference.diagnosis.homogeneity import homogeneity_of_effect
from werrimbi_odom.inference.diagnosis.p_values import chance_of_score
from werrimbi_odom.inference.diagnosis.penalised_likelihood import (
    Fitted,
    fitted,
    refined,
)
from werrimbi_odom.inference.distributions import fisher_survival
from werrimbi_odom.inference.fitting.candidate import Candidate, names_with
from werrimbi_odom.inference.fitting.candidate_starts import (
    looked_for,
    looked_for_delay,
    started_as_nested,
    started_with,
)
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.fit import fit_model, start_point, without_jumps
from werrimbi_odom.inference.fitting.free_parameters import (
    CALIBRATION,
)
from werrimbi_odom.inference.fitting.run_phases import with_own_values
from werrimbi_odom.inference.fitting.score_tests import (
    Score,
    candidates,
    parameters_with,
    scores,
)
from werrimbi_odom.inference.fitting.whitened_innovations import Point
from werrimbi_odom.inference.legs.matched_run import at_edges
from werrimbi_odom.model.effect import Effect, always_twins
from werrimbi_odom.model.robot import Robot


@dataclass(frozen=True, slots=True)
class Round:
    """One round of forward selection."""

    before: Fitted
    scores: tuple[Score, ...]
    """The best score of each effect, best first."""
    tried: tuple[Fitted, ...]
    """Fits of the best few, cheapest first."""
    dependences: tuple[Dependence, ...]
    """The evidence map of `before`."""
    number: int
    """Number of candidates scored."""


def tried_with(rounds: Sequence[Round], name: str) -> list[Fitted]:
    """The fits in which an effect was the newest, round by round."""
    return [fit for this in rounds for fit in this.tried if fit.names[-1] == name]


def fit_calibration(
    runs: Concatenated, robot: Robot, options: EvaluationOptions = EvaluationOptions()
) -> Fitted:
    """Fit of the robot as given, with calibration."""
    point = start_point(runs, robot, options)
    point = replace(point, excluded=at_edges(runs.runs))
    point, numbers = with_own_values(runs, point)
    starts = [point]
    if options.reference_kind != "absolute":
        near = fit_model(runs, point, (*CALIBRATION, *numbers), rounds=0).point
        # With a gyro no leg is left out, so both starts can be compared. The given file may be
        # right but for an event, and a start with legs weighted by the event leads away from it.
        starts = [near, point] if runs.headings_alone else [near]
    fits = (fitted(runs, start, (), numbers, robot, rounds=3) for start in starts)
    return refined(runs, min(fits, key=lambda fit: fit.total), robot)


def refit_to_rest(runs: Concatenated, fit: Fitted, robot: Robot) -> Fitted:
    """Fit an accepted model again until its noise is that of itself, not of the model before.

    The jumps of the reference are found by the better model. Only a reference with correlated
    errors has jumps that stay. Where the errors of poses are independent, a bad pose costs two legs
    and no more.
    """
    point = fit.point
    if point.options.reference_kind != "absolute":
        jumps = zip(without_jumps(runs, point).excluded, at_edges(runs.runs), strict=True)
        point = replace(point, excluded=tuple(jumped | edge for jumped, edge in jumps))
    return fitted(runs, point, fit.names, fit.numbers, robot, rounds=4)


def search_round(
    runs: Concatenated, before: Fitted, effects: Sequence[Effect], given: Robot
) -> Round:
    """Score all candidates once more and fit the best few."""
    point = before.point
    held = {applied.name for applied in point.model.robot.effects}
    looked_at = candidates(effects, held, runs.channels, len(runs.runs))
    turned = (*CALIBRATION, *before.numbers)
    found = scores(runs, point, turned, looked_at)
    ordered = best_of_each(found)
    instead = _scores_in_place_of_sizes(runs, before, given, looked_at)

    def fitted_from(runs: Concatenated, start: Point, score: Score) -> Fitted:
        return fitted_beside(runs, before, start, score, given)

    wanders = point.options.reference_kind == "local_map"

    def worth_it(score: Score) -> bool:
        # Beside a wander, or without the calibration, a score tells too little of the fit.
        blind = wanders or score.candidate.name in instead
        return blind or may_pay(score, before, runs.data)

    def best_fit(score: Score, runs: Concatenated) -> list[Fitted]:
        variants = {
            other.variant: other
            for other in sorted(found, key=lambda other: other.gain)
            if other.candidate.name == score.candidate.name
            and other.variant != score.variant
            and other.gain > rules.SAME_BY_RUN * score.gain
            and worth_it(other)
        }
        options = [(point, each) for each in (score, *variants.values())]
        if score.candidate.name in instead:
            options.append((as_given(point, given), instead[score.candidate.name]))
        starts = [(started_with(runs, begin, option), option) for begin, option in options]
        fits = [fit for fit in (fitted_from(runs, *start) for start in starts) if fit.determined]
        return [cheapest_of(fits)] if fits else []

    tried = []
    floor = rules.SCORE_FLOOR_BESIDE_WANDER if wanders else rules.SCORE_FLOOR
    chosen = [score for score in worth_fitting(ordered, floor) if worth_it(score)]
    any_seen = any(chance_of_score(score, before, len(looked_at)) < rules.SURE for score in ordered)
    for score in ordered:
        looked = [] if score in chosen else [looked_for(runs, point, score)]
        for start in (*looked, looked_for_delay(runs, point, score, any_seen=any_seen)):
            fit = None if start is None else fitted_from(runs, start, score)
            tried += [fit] if fit is not None and fit.determined else []
    works: list[Callable[[Concatenated], Any]] = [partial(best_fit, score) for score in chosen]
    cells, *best = runs.side_by_side([lambda runs: dependences(runs, point, turned), *works])
    tried += [fit for fits in best for fit in fits]
    cheapest = cheapest_of_each(tried)
    for score in ordered:
        nested = cheapest.get(score.candidate.effect.extends)
        wider = cheapest.get(score.candidate.name)
        if nested is not None and wider is not None and nested.total < wider.total:
            tried.append(fitted_from(runs, started_as_nested(nested.point, score), score))
    tried = without_nested(runs, list(cheapest_of_each(tried).values()))
    return Round(
        before,
        tuple(ordered),
        tuple(sensor_first(tried)),
        cells,
        len(looked_at),
    )


def fitted_beside(
    runs: Concatenated, before: Fitted, start: Point, score: Score, given: Robot
) -> Fitted:
    """Fit of a model and one more effect, from a start that holds both."""
    numbers = parameters_with(before.numbers, score.candidate)
    names = names_with(before.names, score.candidate)
    return refined(runs, fitted(runs, start, names, numbers, given), given)


def as_given(point: Point, given: Robot) -> Point:
    """A point with the multipliers of the given robot."""
    return replace(point, model=point.model.with_sizes_of(given))


def _scores_in_place_of_sizes(
    runs: Concatenated, before: Fitted, given: Robot, looked_at: Sequence[Candidate]
) -> dict[str, Score]:
    """Best score of each effect without the calibration, where not all of it is determined.

    On one circle a lever arm does what a radius, the ratio and a mount askew do together. A fit
    that starts with these stays with them. So it does where they stood in for the lever arm without
    being needed: spins on the spot took the ratio to 1.2, and from there the fit went astray.
    """
    if not before.sizes_held:
        return {}
    point = as_given(before.point, given)
    numbers = (*before.numbers, *point.model.nuisance_parameters)
    best = best_of_each(scores(runs, point, numbers, looked_at))
    return {score.candidate.name: score for score in best}


def cheapest_of_each(tried: Sequence[Fitted]) -> dict[str, Fitted]:
    """The cheapest fit of each effect, by its name, the cheapest effect first."""
    cheapest: dict[str, Fitted] = {}
    for fit in sorted(tried, key=lambda fit: fit.total):
        cheapest.setdefault(fit.names[-1], fit)
    return cheapest


def without_nested(runs: Concatenated, tried: Sequence[Fitted]) -> list[Fitted]:
    """Of an effect and one that extends it, the one that the data ask for.

    Nested models are no rivals: both hold. The wider is taken where what it has beyond the other is
    beyond chance, by the noise and by the parts of the drives, whatever both explain together;
    beside the other, in a model that holds it, too. It costs more only where its fit ended at a
    minimum of its own.
    """
    kept = list(tried)
    for wider in tried:
        if extended := wider.newest.extends:
            nested = [fit.total for fit in tried if fit.names[-1] == extended]
            dearer = wider.total > min(nested, default=math.inf)
            name = wider.names[-1]
            needless = (
                dearer
                or extension_p_value(wider, wider.newest) > rules.SURE
                or homogeneity_of_effect(runs, wider, name, find(extended).parameters) > rules.SURE
            )
            name = name if needless else extended
            kept = [fit for fit in kept if fit.names[-1] != name]
    return kept


def extension_p_value(fit: Fitted, effect: Effect) -> float:
    """P-value of what an effect of a model has beyond the one that it extends (Wald)."""
    nested = find(effect.extends).parameters
    freed = [key for key in effect.parameters if key not in nested]
    rise, degrees = wald_test(effect, freed, fit.design, fit.covariance, fit.point)
    return fisher_survival(rise / max(degrees, 1), max(degrees, 1), fit.spare)


def sensor_first(tried: Sequence[Fitted]) -> Sequence[Fitted]:
    """Order fits by cost, with a sensor effect first among observational equivalents.

    A marker or a lidar that was mounted by hand is askew more often than an axle, and what is put
    in for it leaves the path that is published as it is.
    """
    for fit in tried[1:]:
        twin = always_twins(fit.newest, tried[0].newest)
        if fit.newest.stage == "reference" and twin and near_to(tried[0], fit):
            return [fit, *(other for other in tried if other is not fit)]
    return tried


def near_to(best: Fitted, other: Fitted) -> bool:
    """Whether data that ask for one fit do not exclude the other.

    What twins of one number each differ by is due to what is still missing beside them: where a
    lidar's place was taken off in axes that are askew with it, an axle that is askew led by 13.
    """
    one, another = best.newest, other.newest
    alike = len(one.parameters) == len(another.parameters) and always_twins(one, another)
    return alike or other.total - best.total < rules.RIVAL * best.scatter


def best_of_each(found: Sequence[Score]) -> list[Score]:
    """The best candidate of each effect, best effect first."""
    best: dict[str, Score] = {}
    for score in sorted(found, key=lambda score: -score.excess):
        best.setdefault(score.candidate.name, score)
    return list(best.values())


def worth_fitting(
    ordered: Sequence[Score], floor: float = rules.SCORE_FLOOR, most: int = rules.REFITTED
) -> list[Score]:
    """The few that may turn out best after a full fit."""
    if not ordered:
        return []
    top = ordered[0].gain
    return [
        score
        for score in ordered[: rules.SHORTLISTED]
        if score.gain > rules.WORTH_A_FIT * top and score.gain > score.degrees + floor
    ][:most]


def may_pay(score: Score, before: Fitted, data: int) -> bool:
    """Whether a fit may pay for its numbers, though it gain some times its score (`HALF_PAID`)."""
    of_one = before.penalty_of_own if score.candidate.per_run else before.penalty_of_one
    gain = fall_of_cost(score.gain, data, before.squares)
    return gain > rules.HALF_PAID * score.degrees * of_one
