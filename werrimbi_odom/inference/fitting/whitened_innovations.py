# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Whitened innovations of all legs, their cost (-2 log-likelihood), and their Jacobian."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import (
    HEADING_AT_START,
    MULTIPLIERS,
    START_YAW,
    YAW_DRIFT,
    FreeParameter,
    Model,
)
from werrimbi_odom.inference.fitting.likelihood import Innovations, Variances, innovations
from werrimbi_odom.inference.fitting.prediction import (
    Prediction,
    measures_lengths,
    predict_all,
    predicted_legs,
)
from werrimbi_odom.model.effect import view_of
from werrimbi_odom.model.pose import Floats


@dataclass(frozen=True, slots=True)
class Point:
    """Current state of a fit: model, noise variances, and excluded legs."""

    model: Model
    variances: Variances
    excluded: tuple[NDArray[np.bool_], ...]
    options: EvaluationOptions
    """What is known of the reference."""

    @property
    def skip(self) -> NDArray[np.bool_]:
        """Excluded legs of all runs, concatenated."""
        return np.concatenate(self.excluded)


@dataclass(frozen=True, slots=True)
class Design:
    """Whitened innovations (m, 3) and their Jacobian (m, 3, p)."""

    white: Floats
    slopes: Floats
    columns: tuple[tuple[FreeParameter, int], ...]
    """Parameter of each of the p columns; a per-run parameter has one column per run, with its
    index."""
    sized: bool = True
    """Whether lengths were measured (`measures_lengths`): else only their ratios are determined."""

    @property
    def names(self) -> list[str]:
        """Name of the parameter of each column."""
        return [number.name for number, _ in self.columns]

    def flat(self) -> tuple[Floats, Floats]:
        """Innovations and Jacobian as (3 m,) and (3 m, p)."""
        return self.white.ravel(), self.slopes.reshape(self.white.size, self.slopes.shape[-1])


def unexpected(
    runs: Concatenated, point: Point, prediction: Prediction | None = None
) -> Innovations:
    """Innovations of all runs; the latest are cached."""
    seen = prediction or predict_all(point.model, runs)
    return runs.cache.latest(
        (point, seen), lambda: Costs(runs, point).innovations(point.variances, seen)
    )


@dataclass(frozen=True, slots=True)
class Costs:
    """Minus two log-likelihood as a function of the variances, for a fixed model."""

    runs: Concatenated
    point: Point

    def prediction(self) -> Prediction:
        """Prediction of all runs."""
        return predict_all(self.point.model, self.runs)

    def innovations(self, sets: Variances, prediction: Prediction) -> Innovations:
        """Innovations for each set of variances."""
        model = self.point.model
        found = innovations(
            model.robot,
            self.runs,
            prediction,
            sets,
            self.point.options.reference_kind,
            excluded=self.point.skip,
            start_yaws=model.start_yaws,
        )
        if not _knows_drifts(self.runs, self.point):
            return found
        rate, unsure = self.runs.drifts_known
        side = -1.0 if view_of(model.robot.effects).mirrored else 1.0
        prior = np.zeros((self.runs.count, 3))
        prior[_slots_of_drifts(self.runs)] = (side * rate - model.drifts) / unsure
        return replace(found, prior=prior)

    def __call__(self, sets: Variances, prediction: Prediction | None = None) -> Floats:
        """Minus two log-likelihood of each set."""
        found = self.innovations(sets, prediction or self.prediction())
        return found.minus_two_log_likelihood()


def _knows_drifts(runs: Concatenated, point: Point) -> bool:
    """Whether rests tell how headings drift while the robot drives: those of a gyro do.

    Headings that are taken as absolute may be another sensor's, or corrected on the way.
    """
    return runs.headings_alone and point.options.reference_kind == "incremental"


def _slots_of_drifts(runs: Concatenated) -> tuple[NDArray[np.intp], int]:
    """Where the prior of each gyro's drift stands: a position, which headings alone leave empty."""
    return runs.legs[:-1], 0


def jacobian_of(runs: Concatenated, model: Model, numbers: Sequence[FreeParameter]) -> Floats:
    """Jacobian of the legs' relative poses, (m, 3, p), by central differences.

    A per-run parameter is moved in all runs at once, since a leg depends only on its own run.
    """
    moving = [number for number in numbers if number.name != YAW_DRIFT]
    sides = [(number, side) for number in moving for side in (number.scale, -number.scale)]
    works = [(key, partial(_legs_of_moved, runs, model, *key)) for key in sides]
    poses = runs.cache.each_of_model(model, works, runs.step_count)
    both = zip(moving, poses[::2], poses[1::2], strict=True)
    columns = {number: (one - other) / _width(model, number) for number, one, other in both}
    drift = np.outer(runs.duration, [0.0, 0.0, 1.0])
    parts = [columns.get(number, drift) for number in numbers]
    return np.stack(parts, axis=-1) if parts else np.zeros((runs.count, 3, 0))


def _legs_of_moved(runs: Concatenated, model: Model, number: FreeParameter, move: float) -> Floats:
    # Inputs of the effects hardly change with a radius; they are computed once, for the current
    # one.
    looked_at = model.robot if number.name in MULTIPLIERS else None
    return predicted_legs(model.moved_by(number, move), runs, looked_at)


def _width(model: Model, number: FreeParameter) -> float:
    """Distance between the two sides of a difference, which bounds may shorten."""
    if number.per_run:
        return 2.0 * number.scale
    ahead, behind = (model.moved_by(number, side) for side in (number.scale, -number.scale))
    return ahead.value(number) - behind.value(number)


def stacked(
    runs: Concatenated,
    point: Point,
    numbers: Sequence[FreeParameter],
    prediction: Prediction | None = None,
) -> Design:
    """Design of parameters at a point, with start headings that were not measured among them."""
    local = [number for number in numbers if number.name != START_YAW]
    found = unexpected(runs, point, prediction)
    marks = found.marks(jacobian_of(runs, point.model, local))
    return with_columns_per_run(runs, point, found.whitened(), marks, local)


def with_columns_per_run(
    runs: Concatenated, point: Point, white: Floats, slopes: Floats, local: Sequence[FreeParameter]
) -> Design:
    """Design with the columns of per-run parameters expanded to one for each run.

    `slopes` has one more column than `local`: that of the start headings.
    """
    columns: list[tuple[FreeParameter, int]] = []
    parts = []
    for column, number in zip(np.moveaxis(slopes, -1, 0), [*local, HEADING_AT_START], strict=True):
        if number.name == YAW_DRIFT and _knows_drifts(runs, point):
            column[_slots_of_drifts(runs)] = -1.0 / runs.drifts_known[1]
        if not number.per_run:
            columns.append((number, -1))
            parts.append(column)
            continue
        for index, own in enumerate(point.model.own):
            if number.name in own:
                columns.append((number, index))
                parts.append(column * (runs.run_of_leg == index)[:, None])
    wide = np.stack(parts, axis=-1) if parts else np.zeros((runs.count, 3, 0))
    # Once for these runs: a step of a fit does without a whole prediction.
    sized = runs.cache.known(
        "sized", lambda: measures_lengths(runs, predict_all(point.model, runs))
    )
    return Design(white, wide, tuple(columns), sized)
