# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Where the fit of a candidate effect starts: at the values that its score test suggests."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from werrimbi_odom.effects.lookup import find
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.fitting.candidate import usual_view
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import STEP, Model
from werrimbi_odom.inference.fitting.prediction import predict_all, turns_over
from werrimbi_odom.inference.fitting.score_tests import Score
from werrimbi_odom.inference.fitting.start_headings import (
    ALL_ROUND,
    squares_of_runs,
    starts_unmeasured,
    turned_to_the_first_legs,
)
from werrimbi_odom.inference.fitting.whitened_innovations import Point
from werrimbi_odom.model.effect import AppliedEffect, Parameter
from werrimbi_odom.model.pose import Floats, wrap_all
from werrimbi_odom.model.reference_view import View

_SHARES = np.array([1.0, 0.5, 0.25])
"""Distances at which a measured point is looked for, relative to what its score suggests."""


def started_with(runs: Concatenated, point: Point, score: Score) -> Point:
    """Add a candidate to a point, at the values that its score suggests or at a share of them.

    A score is linear; far from zero an effect's formula may predict nonsense.
    """
    before = predict_all(point.model, runs).relative
    for share in (1.0, 0.3, 0.1, 0.03):
        less = replace(score, coefficients=share * score.coefficients)
        model = with_candidate(point.model, less)
        if not turns_over(before, predict_all(model, runs).relative):
            break
    if starts_unmeasured(model) and _is_of_a_point(score):
        return _turned_with_the_headings(runs, point, less)
    return replace(point, model=model)


def looked_for(runs: Concatenated, point: Point, score: Score) -> Point | None:
    """Start with the measured point at usual distances, where its score at null is blind; or None.

    Positions of a drive on one circle do not tell ahead from behind: with the heading free, its
    radius goes with the square of the distance, and the derivative at null is none.
    """
    if not (starts_unmeasured(point.model) and _is_of_a_point(score)):
        return None
    items = score.candidate.effect.parameters.values()
    far = max(item.typical / (STEP * item.scale) for item in items)
    return _turned_with_the_headings(
        runs, point, replace(score, coefficients=np.array([2.0 * far, 0.0]))
    )


def looked_for_delay(
    runs: Concatenated, point: Point, score: Score, *, any_seen: bool = True
) -> Point | None:
    """Start with the best of some delays, where a score at null is no guide to it; or None.

    Noise that was fitted without the delay has taken most of it, and between the steps of a coarse
    counter the likelihood has minima of its own. So where `any_seen` effect might be named instead,
    it is looked for, and in each run where each has its own. Where the jitter of the stamps was
    found to be large, the delay may stand behind it: the jitter is then typical.
    """
    jitter = math.sqrt(float(point.variances.stamp.max()))
    behind_jitter = runs.has_stamp_noise and jitter > rules.MOST_STAMP_NOISE
    item = _delay_of(score)
    if item is None or not (any_seen or behind_jitter):
        return None
    if behind_jitter:
        usual = np.full_like(point.variances.stamp, rules.TYPICAL_STAMP_NOISE**2)
        point = replace(point, variances=replace(point.variances, stamp=usual))
    tried = rules.DELAYS_TRIED[:: 1 if runs.has_coarse_counters else 2]
    steps = np.concatenate([-tried, [0.0], tried]) / (STEP * item.scale)

    def started(delays: Floats) -> Point:
        """With delays in steps: one for all, or of each run."""
        coefficients = np.zeros_like(score.coefficients)
        coefficients[..., 0] = delays
        return replace(
            point, model=with_candidate(point.model, replace(score, coefficients=coefficients))
        )

    squares = np.array([squares_of_runs(runs, started(delay)) for delay in steps])
    if score.coefficients.ndim < 2:
        squares = squares.sum(axis=1, keepdims=True)
    chosen = steps[np.argmin(squares, axis=0)]
    best = started(chosen if chosen.size > 1 else chosen[0])
    if behind_jitter:
        return best
    told = (point, started_with(runs, point, score))
    least = min(np.sum(squares_of_runs(runs, each)) for each in told)
    return best if squares.min(axis=0).sum() < least - rules.RIVAL else None


def started_as_nested(nested: Point, score: Score) -> Point:
    """Start a candidate at the fit of the effect that it extends, which is the last of the model.

    What it has beyond that one is null, so the fit cannot end dearer: in the steps of a coarse
    counter the likelihood of a clock's rate has minima of its own, the farther the more of them.
    """
    (*others, held) = nested.model.robot.effects
    effect = score.candidate.effect
    values = {**effect.nulls, **score.candidate.shape, **held.values}
    anew = {
        f"{effect.name}.{name}": values[name]
        for name, item in effect.parameters.items()
        if item.per_run and name not in score.candidate.shared
    }
    robot = replace(nested.model.robot, effects=(*others, AppliedEffect(effect, values)))
    return replace(nested, model=Model(robot, tuple({**mine, **anew} for mine in nested.model.own)))


def _delay_of(score: Score) -> Parameter | None:
    """The delay of the reference's stamps, if an effect is that or extends it: its first number."""
    effect = score.candidate.effect
    nested = find(effect.extends) if effect.extends else effect
    if nested.stage != "reference":
        return None
    view = usual_view(nested)
    late = view != View() and view._replace(delay=0.0) == View()
    return next(iter(effect.parameters.values())) if late else None


def _is_of_a_point(score: Score) -> bool:
    """Whether the coordinates are those of the measured point, in the robot's axes."""
    return score.candidate.effect.stage == "reference" and score.coefficients.shape == (2,)


def _turned_with_the_headings(runs: Concatenated, point: Point, score: Score) -> Point:
    """Start with the measured point where it fits best, in trial directions and distances.

    In a drive that spins on the spot, positions do not tell the heading until the measured point is
    known: any heading fits as well, with that point turned by as much. On one circle the distance
    goes with the wheels' radii. The score takes headings and radii as they are, so it may be far
    off in both.
    """
    starts = []
    around = np.outer(_SHARES, np.exp(1j * ALL_ROUND)).ravel()
    for place in complex(*score.coefficients) * around:
        there = replace(score, coefficients=np.array([place.real, place.imag]))
        model = with_candidate(point.model, there)
        starts.append(turned_to_the_first_legs(runs, replace(point, model=model)))
    return min(starts, key=lambda start: start[1])[0]


def with_candidate(model: Model, score: Score) -> Model:
    """Add a candidate to the model, at the values that its score suggests.

    It takes the place of an effect that it extends, with that one's values.
    """
    candidate = score.candidate
    effect = candidate.effect
    start = dict(effect.nulls) | dict(candidate.shape)
    own: list[dict[str, float]] = [dict(mine) for mine in model.own]
    if effect.quadrature is not None:
        amplitude, phase = effect.quadrature
        size = STEP * effect.parameters[amplitude].scale
        pairs = size * np.atleast_2d(score.coefficients)
        sizes, angles = np.hypot(*pairs.T), np.arctan2(pairs[:, 1], pairs[:, 0])
        start[amplitude] = float(np.clip(np.median(sizes), *effect.parameters[amplitude].bounds))
        start[phase] = float(angles[0])
        if candidate.per_run:
            for mine, angle in zip(own, angles.tolist(), strict=True):
                mine[f"{effect.name}.{phase}"] = angle
    else:
        moving = [
            name for name, item in effect.parameters.items() if not item.tries and not item.as_base
        ]
        anew = candidate.per_run and score.places is None
        for name, sizes in zip(moving, np.atleast_2d(score.coefficients).T, strict=False):
            item = effect.parameters[name]
            values = np.clip(start[name] + sizes * STEP * item.scale, *item.bounds)
            start[name] = float(np.median(values))
            if anew:
                for mine, value in zip(own, values.tolist(), strict=True):
                    mine[f"{effect.name}.{name}"] = value
        if candidate.place is not None and score.places is not None:
            places = wrap_all(score.places)
            start[candidate.place] = float(places[0])
            if candidate.per_run:
                for mine, place in zip(own, places.tolist(), strict=True):
                    mine[f"{effect.name}.{candidate.place}"] = place
    others = []
    for held in model.robot.effects:
        if held.name != effect.extends:
            others.append(held)
            continue
        for values, prefix in ((start, ""), *((mine, f"{effect.name}.") for mine in own)):
            for name, value in held.values.items():
                if prefix + name in values:
                    values[prefix + name] += value - effect.nulls[name]
    robot = replace(model.robot, effects=(*others, AppliedEffect(effect, start)))
    return Model(robot, tuple(own))
