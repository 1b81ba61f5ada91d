# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Nonlinear least squares: Gauss-Newton with backtracking and, where that fails, damping."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import FreeParameter, Model
from werrimbi_odom.inference.fitting.identifiable import Directions
from werrimbi_odom.inference.fitting.prediction import predict_all, predicted_on_path, turns_over
from werrimbi_odom.inference.fitting.whitened_innovations import Design, Point, stacked, unexpected
from werrimbi_odom.inference.linear import solved
from werrimbi_odom.model.pose import Floats


def gauss_newton(
    runs: Concatenated, point: Point, numbers: Sequence[FreeParameter], ways: Directions
) -> tuple[Point, bool]:
    """Gauss-Newton with backtracking, then damping; also return whether the point moved."""
    prediction = predict_all(point.model, runs)
    best = np.inf
    for number in range(25):  # along a valley that bends (below) each step is short
        design = stacked(runs, point, numbers, prediction)
        best = min(best, float(np.sum(design.white**2)))
        step = step_within(design, ways)
        inside = _without_stopped(ways, point.model, design, step)
        if inside is not ways:
            step = step_within(design, inside)
        if is_small(design, step):
            return point, number > 0
        for shorter in _shorter_steps(design, inside, step):
            tried = replace(point, model=moved(point.model, design, shorter))
            ahead = replace(prediction, relative=predicted_on_path(tried.model, runs))
            if not turns_over(prediction.relative, ahead.relative):
                cost = float(np.sum(unexpected(runs, tried, ahead).whitened() ** 2))
                if cost < best:
                    break
        else:
            return point, number > 0
        point, prediction, gained = tried, ahead, best - cost
        if gained < 1e-3:
            return point, number > 0
    return point, True


def _without_stopped(ways: Directions, model: Model, design: Design, step: Floats) -> Directions:
    """The directions without parameters that are at a bound which the step would cross.

    Cut off at the bound, such a step is one of the others for a parameter that does not move: the
    fit crawls.
    """
    stopped = np.zeros(step.size, dtype=np.bool_)
    for index, ((number, run), move) in enumerate(zip(design.columns, step.tolist(), strict=True)):
        value = model.value(number, max(run, 0))
        low, high = number.bounds_about(value)
        stopped[index] = (value <= low and move < 0.0) or (value >= high and move > 0.0)
    alone = np.count_nonzero(ways.matrix, axis=0) == 1
    free = ~(alone & np.any(ways.matrix[stopped] != 0.0, axis=0))
    return ways if free.all() else replace(ways, matrix=ways.matrix[:, free])


def is_small(design: Design, step: Floats) -> bool:
    """Whether a step moves every parameter by a small part of its scale."""
    scales = np.array([number.scale for number, _ in design.columns])
    return bool(np.all(np.abs(step) < 1e-4 * scales))


def _shorter_steps(design: Design, ways: Directions, step: Floats) -> Iterator[Floats]:
    """A step, shares of it, and then damped ones (Levenberg and Marquardt).

    Along a direction that the data hardly determine the cost may be a valley that bends: of the
    lever arm of positions on a circle, and the heading at its start. Then every share of the step
    leads up its side.
    """
    for share in 0.3 ** np.arange(5):
        yield share * step
    matrix = design.flat()[1] @ ways.matrix
    norms = np.diag(np.linalg.norm(matrix, axis=0))
    target = np.concatenate([design.white.ravel(), np.zeros(len(norms))])
    for damping in (1e-3, 1e-1, 10.0):
        damped = np.concatenate([matrix, math.sqrt(damping) * norms])
        yield -ways.matrix @ solved(damped, target)


def step_within(design: Design, ways: Directions, weight: Floats | None = None) -> Floats:
    """Least-squares step of the columns, weighted by leg (m,), within the given directions."""
    root = np.sqrt(np.ones(design.white.shape[0]) if weight is None else weight)[:, None]
    matrix = (design.slopes * root[..., None]).reshape(design.white.size, len(design.columns))
    return -ways.matrix @ solved(matrix @ ways.matrix, (design.white * root).ravel())


def moved(model: Model, design: Design, step: Floats) -> Model:
    """Apply a step in the design's columns to the model."""
    shared: dict[str, float] = {}
    own: list[dict[str, float]] = [{} for _ in model.own]
    for (number, index), move in zip(design.columns, step.tolist(), strict=True):
        target = shared if index < 0 else own[index]
        now = model.value(number, max(index, 0))
        there = float(np.clip(now + move, *number.bounds_about(now)))
        target[number.name] = number.wrapped(there)
    return model.turned(shared, own)
