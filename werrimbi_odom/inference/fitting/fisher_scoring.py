# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The least of minus two log-likelihood within bounds, by Fisher's scoring that learns on the way.

Expected curvature is positive, so every step goes downhill. What it lacks of the true one (a number
that data hardly tell is overshot, to and fro) is learnt from the gradients that come by: Dennis,
Gay and Welsch, "An adaptive nonlinear least-squares algorithm", ACM Trans. Math. Softw. 7, 1981.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from werrimbi_odom.model.pose import Floats

Evaluate = Callable[[Floats], tuple[float, Floats, Floats]]
"""Cost, gradient (n,) and expected curvature (n, n), at numbers (n,)."""


def minimum(
    evaluate: Evaluate,
    start: Floats,
    *,
    lowest: float,
    highest: Floats,
    longest: float = 2.0,
    rounds: int = 25,
) -> Floats:
    """Numbers of least cost, shape (n,).

    Parameters
    ----------
    evaluate
        The cost and what is expected of it nearby; an infinite cost where there is none.
    start : ndarray, shape (n,)
        Where to begin; put within the bounds.
    lowest, highest : float and ndarray, shape (n,)
        Bounds.
    longest : float
        Step of a number, at most: no curvature holds farther than that.
    rounds : int
        Steps, at most.
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
        if not np.isfinite(ahead[0]):  # no such place: nearer, and nothing was learnt
            if damping > 1e4:
                break
            damping = max(10.0 * damping, 1e-2)
            continue
        moved = np.max(np.abs(tried - here), initial=0.0)
        if moved < longest:
            lacking = _lacking(lacking, ahead[2], tried - here, ahead[1] - gradient)
        else:  # cut short: what was learnt was of another place
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
    """What the expected curvature lacks of the true one, after a step that changed the gradient so.

    The symmetric matrix nearest to the one before (shrunk to what this step asks for) with which
    both together explain the change.
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
    """Second derivatives (n, n) of what takes rows (g, n), by differences of gradients."""
    step = 0.05
    rows = []
    for index in range(here.size):
        move = np.zeros(here.size)
        move[index] = step
        rows.append(_gradient(function, here + move) - _gradient(function, here - move))
    matrix = np.array(rows) / (2.0 * step)
    return np.asarray(0.5 * (matrix + matrix.T))


def _gradient(function: Callable[[Floats], Floats], here: Floats) -> Floats:
    """By central differences taken in one pass."""
    step = 1e-4
    moves = step * np.eye(here.size)
    values = function(np.concatenate([here + moves, here - moves]))
    return np.asarray((values[: here.size] - values[here.size :]) / (2.0 * step))
