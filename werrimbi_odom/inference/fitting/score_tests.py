# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Effects that a model may lack, and the score test of each.

A score test (Rao) asks what an effect would explain without fitting it. The derivative of the
whitened innovations at the null value, with the fitted parameters projected out, is compared with
the innovations. So all effects of a library together cost one pass of the filter.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import product
from typing import NamedTuple

import numpy as np

from werrimbi_odom.inference.fitting.angle_score import best_angles
from werrimbi_odom.inference.fitting.candidate import Candidate as Candidate
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import FreeParameter, Model, parameters_to_fit
from werrimbi_odom.inference.fitting.identifiable import CALIBRATED as CALIBRATED
from werrimbi_odom.inference.fitting.prediction import Prediction, predict_all, predicted_legs
from werrimbi_odom.inference.fitting.whitened_innovations import Point, stacked, unexpected
from werrimbi_odom.inference.linear import Nuisance, nuisance, score_test, within_reach
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.model.pose import Floats

BESIDE_POSITIONS = ("reference_heading_delay",)
"""Effects that relate headings to positions; for headings alone they equal another effect."""

OF_THE_MEASUREMENT = ("reference_scale",)
"""Effects equivalent to scaling all three multipliers together: never tried with these free."""


@dataclass(frozen=True, slots=True)
class Score:
    """Result of the score test of a candidate."""

    candidate: Candidate
    gain: float
    """Test statistic: fall of the whitened squared innovations; chi-squared under the null
    hypothesis."""
    degrees: int
    coefficients: Floats
    """Step along each coordinate; (coordinates,) or (runs, coordinates)."""
    places: Floats | None = None
    """Angle round the wheel of a local effect, (1,) or (runs,) [rad]; else None."""

    @property
    def variant(self) -> tuple[bool, bool]:
        """Which of the variants of its effect: values of each run or not; a bump or a flat.

        A flat across from a bump is the same once a turn, beside a radius that is larger by a third
        of its depth; so each is fitted.
        """
        return self.candidate.per_run, self.places is not None and self.coefficients[0] < 0.0

    @property
    def excess(self) -> float:
        """Gain above its null expectation, in units of its null standard deviation."""
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
    """All candidates: one for each combination of trial shapes of each effect.

    `effects`: library of effects. `known`: effects that the model already has. `channels`: extra
    measured channels of the runs; effects that need others are left out. `runs`: number of runs:
    with one run nobody can tell whether a phase is the same in each. `asked`: the user asked for
    these effects. Otherwise those that stand for the wheel base (`Parameter.as_base`) are left to
    the set-up search, which knows which robots have them. `own_scale`: the metric scale of the
    reference is unknown and the multipliers are not free.
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
    """Derivative of the whitened innovations in a candidate's parameters."""

    candidate: Candidate
    flat: Floats
    """Shape (n, coordinates), or (n, runs * coordinates) where each run has its own values."""
    free: Floats
    """The same with the nuisances projected out."""


def signatures(
    runs: Concatenated, point: Point, numbers: Sequence[FreeParameter], tried: Sequence[Candidate]
) -> tuple[Floats, Iterator[Signature]]:
    """Innovations (n,) with `numbers` projected out, and the signature of each candidate."""
    if runs.headings_alone:
        tried = [candidate for candidate in tried if candidate.name not in BESIDE_POSITIONS]
    prediction = predict_all(point.model, runs)
    works, owners = [], []
    for number, candidate in enumerate(tried):
        for coordinate in candidate.round_the_wheel or candidate.coordinates:
            key = (candidate.effect.apply, *coordinate.items())
            works.append(
                (key, partial(_slope, runs, point.model, candidate, coordinate, prediction))
            )
            owners.append(number)
    if not works:
        return np.zeros(0), iter(())
    change = np.stack(runs.cache.each_of_model(point.model, works, runs.step_count), axis=-1)
    marks = unexpected(runs, point, prediction).marks(change)[..., :-1]
    frame, rest = residual_innovations(runs, point, numbers, prediction)
    owned = np.array(owners)

    def each() -> Iterator[Signature]:
        for number, candidate in enumerate(tried):
            own = marks[..., owned == number]
            if candidate.per_run:
                own = of_each_run(runs, own)
            flat = own.reshape(rest.size, -1)
            yield Signature(candidate, flat, frame.residual(flat))

    return rest, each()


def residual_innovations(
    runs: Concatenated, point: Point, numbers: Sequence[FreeParameter], prediction: Prediction
) -> tuple[Nuisance, Floats]:
    """Span of the derivatives in `numbers`, and the innovations (n,) with it projected out."""
    white, basis = stacked(runs, point, numbers, prediction).flat()
    frame = nuisance(basis)
    return frame, frame.residual(white)


def of_each_run(runs: Concatenated, marks: Floats) -> Floats:
    """Expand columns (m, 3, k) to one copy per run, zero in other runs: (m, 3, runs * k)."""
    here = (runs.run_of_leg == run for run in range(len(runs.runs)))
    return np.concatenate([marks * legs[:, None, None] for legs in here], axis=-1)


def scores(
    runs: Concatenated, point: Point, numbers: Sequence[FreeParameter], tried: Sequence[Candidate]
) -> tuple[Score, ...]:
    """Score test of each candidate, with `numbers` as nuisances; undetermined ones left out."""
    rest, found = signatures(runs, point, numbers, tried)
    results: list[Score] = []
    for candidate, flat, free in found:
        if candidate.place is not None:
            results += _scores_of_places(candidate, len(runs.runs), free, rest)
            continue
        test = score_test(flat, free, rest)
        if test is None:
            continue
        copies = len(runs.runs) if candidate.per_run else 1
        solution, reach = test.coefficients, np.tile(candidate.reach, copies)
        if (np.abs(solution) > reach).any():
            solution = within_reach(free, rest, reach)
        if candidate.per_run:
            solution = solution.reshape(copies, -1)
        results.append(Score(candidate, test.gain, test.degrees, solution))
    return tuple(results)


def _scores_of_places(
    candidate: Candidate, runs: int, free: Floats, rest: Floats
) -> Iterator[Score]:
    """Scores of an effect local to an angle round the wheel: the best bump and the best flat."""
    assert candidate.place is not None
    tries = np.array(candidate.effect.parameters[candidate.place].tries)
    blocks = runs if candidate.per_run else 1
    for found in best_angles(tries, free, rest, blocks):
        size = np.array([found.size])
        yield Score(candidate, found.gain, 1 + blocks, size, found.places)


def _slope(
    runs: Concatenated,
    model: Model,
    candidate: Candidate,
    coordinate: Mapping[str, float],
    prediction: Prediction,
) -> Floats:
    """Derivative of the legs in one coordinate, per step, (m, 3)."""
    poses: list[Floats] = []
    for factor in (1.0, -1.0):
        applied = candidate.with_value(coordinate, factor)
        # One-sided at a bound, and for laws linear in their size, which are evaluated at many
        # angles.
        one_sided = candidate.place is not None
        one_sided |= applied.values == candidate.with_value(coordinate, 0.0).values
        if factor < 0.0 and one_sided:
            return np.asarray(poses[0] - prediction.relative)
        robot = replace(model.robot, effects=(*model.robot.effects, applied))
        poses.append(predicted_legs(replace(model, robot=robot), runs))
    return np.asarray(0.5 * (poses[0] - poses[1]))


def parameters_with(
    numbers: Sequence[FreeParameter], candidate: Candidate
) -> tuple[FreeParameter, ...]:
    """Parameters that a fit may change, with those of a candidate in place of what it extends.

    What refines its law is freed later, where it pays (`refined`).
    """
    replaced = candidate.effect.extends
    others = [each for each in numbers if each.name.rpartition(".")[0] != replaced]
    own = parameters_to_fit(candidate.effect, candidate.shared)
    return (*others, *(each for each in own if not each.refines))
