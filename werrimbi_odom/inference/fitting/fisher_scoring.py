# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Minimum of minus two log-likelihood within bounds, by Fisher scoring with a secant correction.

The expected information is positive definite, so each step descends. Its difference to the true
Hessian, which makes weakly determined parameters oscillate, is learnt from successive gradients:
Dennis, Gay and Welsch, "An adaptive nonlinear least-squares algorithm", ACM Trans. Math. Softw. 7,
1981.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from werrimbi_odom.model.pose import Floats

Evaluate = Callable[[Floats], tuple[float, Floats, Floats]]
"""Function from parameters (n,) to cost, gradient (n,) and expected Hessian (n, n)."""


def minimum(
    evaluate: Evaluate,
    start: Floats,
    *,
    lowest: float,
    highest: Floats,
    longest: float = 2.0,
    rounds: int = 25,
) -> Floats:
    """Minimise a cost within bounds.

    `evaluate`: cost, gradient and expected Hessian; the cost is infinite outside its domain.
    `start` (n,): start values; clipped to the bounds. `lowest`, `highest` (n,): bounds. `longest`:
    largest step of a parameter: the quadratic model is not trusted beyond. `rounds`: largest number
    of iterations. Result (n,): parameters of least cost.
    """
    here = np.clip(start, lowest, highest)
    damping = 1e-6
    cost, gradient, expected = evaluate(here)
    lacking = np.zeros_like(expected)
    for _ in range(rounds):
        curvature = expected + lacking
        if np.linalg.eigvalsh(curvature)[0] <= 0.0:
            curvature = expected
        free = (here < highest) | (gradient > 0.0)
        scale = np.diag(curvature)
        damped = curvature + np.diag(damping * scale + 1e-9 * scale.max(initial=1e-12) + 1e-12)
        step = np.zeros(here.size)
        step[free] = -np.linalg.solve(damped[np.ix_(free, free)], gradient[free])
        tried = np.clip(here + np.clip(step, -longest, longest), lowest, highest)
        ahead = evaluate(tried)
        if not np.isfinite(ahead[0]):  # outside the domain: shorten the step, no secant information
            if damping > 1e4:
                break
            damping = max(10.0 * damping, 1e-2)
            continue
        moved = np.max(np.abs(tried - here), initial=0.0)
        if moved < longest:
            lacking = _lacking(lacking, ahead[2], tried - here, ahead[1] - gradient)
        else:  # clipped step: the secant is not of this region
            lacking = np.zeros_like(expected)
        if ahead[0] > cost + 1e-9 * abs(cost):
            if damping > 1e4:
                break
            damping = max(10.0 * damping, 1e-2)
            continue
        gained = cost - ahead[0]
        here, (cost, gradient, expected), damping = tried, ahead, 0.1 * damping
        if gained < 1e-3 or moved < 1e-4:
            break
    return here


def _lacking(before: Floats, expected: Floats, step: Floats, change: Floats) -> Floats:
    """Update the estimated difference between true and expected Hessian by one secant.

    It is the symmetric matrix nearest to the previous one, scaled down as in Dennis et al., for
    which the sum satisfies the secant equation.
    """
    if not step @ change > 0.0:
        return before
    asked = change - expected @ step
    along = before @ step
    sized = min(1.0, abs(float(step @ asked)) / max(abs(float(step @ along)), 1e-300))
    rest = asked - sized * along
    weight = change / float(step @ change)
    update = np.outer(rest, weight)
    return np.asarray(
        sized * before + update + update.T - float(rest @ step) * np.outer(weight, weight)
    )


def hessian(function: Callable[[Floats], Floats], here: Floats) -> Floats:
    """Hessian (n, n) of a function of rows (g, n), by differences of gradients."""
    step = 0.05
    rows = []
    for index in range(here.size):
        move = np.zeros(here.size)
        move[index] = step
        rows.append(_gradient(function, here + move) - _gradient(function, here - move))
    matrix = np.array(rows) / (2.0 * step)
    return np.asarray(0.5 * (matrix + matrix.T))


def _gradient(function: Callable[[Floats], Floats], here: Floats) -> Floats:
    """Gradient by central differences in one vectorised call."""
    step = 1e-4
    moves = step * np.eye(here.size)
    values = function(np.concatenate([here + moves, here - moves]))
    return np.asarray((values[: here.size] - values[here.size :]) / (2.0 * step))
