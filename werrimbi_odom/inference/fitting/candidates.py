# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Effects that a model might be missing, and the score test of each.

A score test asks what an effect would explain without fitting it: its derivative at the null value,
less what the model can turn already, against the innovations. So all effects of a library cost one
pass of the filter.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import product
from typing import NamedTuple

import numpy as np

from werrimbi_odom.inference.fitting.candidate import Candidate as Candidate
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.design import Point, stacked, unexpected
from werrimbi_odom.inference.fitting.free_parameters import (
    STEP,
    FreeParameter,
    Model,
    parameters_to_fit,
)
from werrimbi_odom.inference.fitting.identifiable import CALIBRATED as CALIBRATED
from werrimbi_odom.inference.fitting.placed import best_placed
from werrimbi_odom.inference.fitting.prediction import Prediction, legs_shown, predict_all
from werrimbi_odom.inference.linear import Nuisance, nuisance, score_test
from werrimbi_odom.model.effect import AppliedEffect, Effect
from werrimbi_odom.model.pose import Floats, wrap_all

BESIDE_POSITIONS = ("reference_heading_delay",)
"""Effects that are of headings against positions: of headings alone they are another effect."""

OF_THE_MEASUREMENT = ("reference_scale",)
"""Effects that all three multipliers together do as well: never tried beside them."""


@dataclass(frozen=True, slots=True)
class Score:
    """What a candidate would explain."""

    candidate: Candidate
    gain: float
    """Fall of the squared innovations, in their own variances: chi-squared when it is absent."""
    degrees: int
    coefficients: Floats
    """How far along its coordinates; (coordinates,) or (runs, coordinates)."""
    places: Floats | None = None
    """Of what lies in one place round a wheel, where: (1,) or (runs,) [rad]."""

    @property
    def excess(self) -> float:
        """Gain beyond what as many useless parameters would bring, in units of its scatter."""
        return (self.gain - self.degrees) / math.sqrt(2.0 * self.degrees)


def candidates(
    effects: Iterable[Effect],
    known: Iterable[str],
    channels: Iterable[str],
    runs: int,
    *,
    asked: bool = False,
    own_scale: bool = False,
) -> tuple[Candidate, ...]:
    """All that may be tried: a candidate for each set of shapes of each effect.

    Parameters
    ----------
    known
        Effects that the model holds already.
    channels
        Extra measured channels of the runs; effects that need others are left out.
    runs : int
        How many there are: of one run, nobody can say whether a phase stays.
    asked : bool
        The user asked for these effects. Else those that are the base by another name
        (`Parameter.as_base`) are left to the search of set-ups, which knows whose robots have them.
    own_scale : bool
        Nobody knows the reference's own metre, and the multipliers are not free.
    """
    there, measured = set(known), set(channels)
    found = []
    for effect in effects:
        if effect.is_mistake or effect.name in there or effect.name in CALIBRATED:
            continue
        if effect.name in OF_THE_MEASUREMENT and not (asked or own_scale):
            continue
        if effect.lacks(measured):
            continue
        if not asked and any(item.as_base for item in effect.parameters.values()):
            continue
        shapes = {
            name: item.tries
            for name, item in effect.parameters.items()
            if item.tries and not item.per_run
        }
        own = tuple(name for name, item in effect.parameters.items() if item.per_run)
        for values in product(*shapes.values()):
            shape = dict(zip(shapes, values, strict=True))
            if own and runs > 1:
                found.append(Candidate(effect, shape))
            found.append(Candidate(effect, shape, own))
    return tuple(found)


class Signature(NamedTuple):
    """What a candidate does to the innovations, each in units of its own noise."""

    candidate: Candidate
    flat: Floats
    """(n, coordinates), or (n, runs * coordinates) where each run has values of its own."""
    free: Floats
    """The same, less what the model can turn already."""


def signatures(
    runs: Concatenated, point: Point, numbers: Sequence[FreeParameter], tried: Sequence[Candidate]
) -> tuple[Floats, Iterator[Signature]]:
    """Innovations (n,) that `numbers` cannot explain, and what each candidate does to them."""
    if runs.headings_alone:
        tried = [candidate for candidate in tried if candidate.name not in BESIDE_POSITIONS]
    prediction = predict_all(point.model, runs)
    columns, owners = [], []
    for number, candidate in enumerate(tried):
        for coordinate in candidate.round_the_wheel or candidate.coordinates:
            columns.append(
                runs.of_model(
                    point.model,
                    (candidate.effect.apply, *coordinate.items()),
                    partial(_slope, runs, point.model, candidate, coordinate, prediction),
                )
            )
            owners.append(number)
    if not columns:
        return np.zeros(0), iter(())
    change = np.stack(columns, axis=-1)
    marks = unexpected(runs, point, prediction).marks(change)[..., :-1]
    frame, rest = unexplained(runs, point, numbers, prediction)
    owned = np.array(owners)

    def each() -> Iterator[Signature]:
        for number, candidate in enumerate(tried):
            own = marks[..., owned == number]
            if candidate.per_run:
                own = of_each_run(runs, own)
            flat = own.reshape(rest.size, -1)
            yield Signature(candidate, flat, frame.residual(flat))

    return rest, each()


def unexplained(
    runs: Concatenated, point: Point, numbers: Sequence[FreeParameter], prediction: Prediction
) -> tuple[Nuisance, Floats]:
    """What `numbers` can turn, and the innovations (n,) clear of it."""
    white, basis = stacked(runs, point, numbers, prediction).flat()
    frame = nuisance(basis)
    return frame, frame.residual(white)


def of_each_run(runs: Concatenated, marks: Floats) -> Floats:
    """Columns (m, 3, k) once for each run, and zero in the others: (m, 3, runs * k)."""
    here = (runs.run_of_leg == run for run in range(len(runs.runs)))
    return np.concatenate([marks * legs[:, None, None] for legs in here], axis=-1)


def scores(
    runs: Concatenated, point: Point, numbers: Sequence[FreeParameter], tried: Sequence[Candidate]
) -> tuple[Score, ...]:
    """Score of each candidate beside what `numbers` can turn; those without any effect left out."""
    rest, found = signatures(runs, point, numbers, tried)
    results: list[Score] = []
    for candidate, flat, free in found:
        if candidate.place is not None:
            results += _scores_of_places(candidate, len(runs.runs), free, rest)
            continue
        test = score_test(flat, free, rest)
        if test is None:
            continue
        solution = test.coefficients
        if candidate.per_run:
            solution = solution.reshape(len(runs.runs), -1)
        results.append(Score(candidate, test.gain, test.degrees, solution))
    return tuple(results)


def _scores_of_places(
    candidate: Candidate, runs: int, free: Floats, rest: Floats
) -> Iterator[Score]:
    """Of what lies in one place round a wheel: the best bump, and the best flat."""
    assert candidate.place is not None
    tries = np.array(candidate.effect.parameters[candidate.place].tries)
    blocks = runs if candidate.per_run else 1
    for found in best_placed(tries, free, rest, blocks):
        size = np.array([found.size])
        yield Score(candidate, found.gain, 1 + blocks, size, found.places)


def _slope(
    runs: Concatenated,
    model: Model,
    candidate: Candidate,
    coordinate: Mapping[str, float],
    prediction: Prediction,
) -> Floats:
    """Change of the legs for one coordinate's step, (m, 3)."""
    poses: list[Floats] = []
    for factor in (1.0, -1.0):
        applied = candidate.with_value(coordinate, factor)
        # One side alone at a bound; and of a law that is a line in its size, at many places.
        one_sided = candidate.place is not None
        one_sided |= applied.values == candidate.with_value(coordinate, 0.0).values
        if factor < 0.0 and one_sided:
            return np.asarray(poses[0] - prediction.relative)
        robot = replace(model.robot, effects=(*model.robot.effects, applied))
        poses.append(legs_shown(replace(model, robot=robot), runs))
    return np.asarray(0.5 * (poses[0] - poses[1]))


def put_in(model: Model, score: Score) -> Model:
    """The model with a candidate at the values that its score suggests."""
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
    robot = replace(model.robot, effects=(*model.robot.effects, AppliedEffect(effect, start)))
    return Model(robot, tuple(own))


def parameters_of_candidate(candidate: Candidate) -> tuple[FreeParameter, ...]:
    """What a fit may turn of it."""
    return parameters_to_fit(candidate.effect, candidate.shared)
