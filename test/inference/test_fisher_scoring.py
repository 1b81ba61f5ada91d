# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Variances of which one is hardly told: found at the minimum, in few steps."""

from __future__ import annotations

import numpy as np
import pytest

from test.evidence import in_evidence
from werrimbi_odom.inference.fitting.fisher_scoring import hessian, minimum

Floats = np.ndarray


def costs(rows: Floats, seen: Floats, shares: Floats) -> Floats:
    """Minus two log-likelihood (g,) of sums of two normal numbers, at logarithms of variances."""
    variance = np.exp(rows) @ shares
    return np.sum(np.log(variance) + seen**2 / variance, axis=-1)


@pytest.mark.parametrize(
    "seed",
    [*range(6), *(in_evidence(seed) for seed in range(6, 20))],
)
def test_the_minimum_is_found_where_one_of_two_noises_hides_behind_the_other(seed: int) -> None:
    random = np.random.default_rng(seed)
    shares = np.stack([np.ones(300), random.uniform(0.0, 0.2, 300)])
    seen = random.normal(0.0, np.sqrt(np.exp([0.0, 0.5]) @ shares))
    asked = 0

    def evaluate(logs: Floats) -> tuple[float, Floats, Floats]:
        nonlocal asked
        asked += 1
        parts = np.exp(logs)[:, None] * shares
        variance = parts.sum(axis=0)
        slopes = parts / variance
        gradient = slopes @ (1.0 - seen**2 / variance)
        return float(costs(logs[None], seen, shares)[0]), gradient, slopes @ slopes.T

    start, bounds = np.array([3.0, -3.0]), {"lowest": -12.0, "highest": np.array([9.0, 9.0])}
    found = minimum(evaluate, start, **bounds)  # type: ignore[arg-type]
    steps = asked

    def least(firsts: Floats, seconds: Floats) -> Floats:
        rows = np.stack(np.meshgrid(firsts, seconds), axis=-1).reshape(-1, 2)
        return rows[np.argmin(costs(rows, seen, shares))]

    first, second = least(np.linspace(-0.5, 0.5, 26), np.linspace(-12.0, 9.0, 211))
    finer = np.linspace(-1.0, 1.0, 21)
    best = least(first + 0.04 * finer, second + 0.1 * finer)
    assert costs(found[None], seen, shares)[0] < costs(best[None], seen, shares)[0] + 2e-3
    assert steps < 25


def test_where_there_is_no_cost_a_step_is_shorter() -> None:
    """As of variances whose covariance is none: the minimum lies beside a wall."""

    def evaluate(here: Floats) -> tuple[float, Floats, Floats]:
        if here[0] > 1.0:
            return np.inf, np.zeros(1), np.eye(1)
        return float((here[0] - 0.9) ** 2), 2.0 * (here - 0.9), np.array([[1.5]])

    found = minimum(evaluate, np.array([0.0]), lowest=-5.0, highest=np.array([5.0]))
    assert found[0] == pytest.approx(0.9, abs=0.05)


def test_second_derivatives_of_a_quadratic_are_its_matrix() -> None:
    matrix = np.array([[2.0, 0.3], [0.3, 5.0]])
    found = hessian(lambda rows: 0.5 * np.sum(rows @ matrix * rows, axis=-1), np.array([1.0, -2.0]))
    assert found == pytest.approx(matrix, rel=1e-6)
