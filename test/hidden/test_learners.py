# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The general learners are no straw men: each learns a plain law, and leaves noise alone."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("sklearn", reason="needs scikit-learn (pip install werrimbi_odom[peers])")
pytest.importorskip("pysindy", reason="needs pysindy (pip install werrimbi_odom[peers])")

from test.hidden.learners import CHOICES, Legs, learnt

NOISE = 1e-3


def legs(chance: np.random.Generator, size: float) -> Legs:
    """Sideways by `size` times the first of twelve measured things; noise beside it."""
    plain = chance.normal(size=(900, 12))
    left = chance.normal(0.0, NOISE, size=(900, 3))
    left[:, 1] += size * plain[:, 0]
    return Legs(plain, plain, left, np.repeat(np.arange(6), 150))


@pytest.mark.evidence
@pytest.mark.parametrize("peer", CHOICES)
def test_a_plain_law_is_learnt(peer: str) -> None:
    chance = np.random.default_rng(1)
    learn, judge = legs(chance, 5 * NOISE), legs(chance, 5 * NOISE)
    rest = judge.left - learnt(peer, learn)(judge)
    assert np.std(rest[:, 1]) < 1.2 * NOISE
    assert np.std(judge.left[:, 1]) > 4 * NOISE


@pytest.mark.evidence
@pytest.mark.parametrize("peer", CHOICES)
def test_noise_is_left_alone(peer: str) -> None:
    chance = np.random.default_rng(2)
    learn, judge = legs(chance, 0.0), legs(chance, 0.0)
    rest = judge.left - learnt(peer, learn)(judge)
    assert np.std(rest) < 1.1 * NOISE
