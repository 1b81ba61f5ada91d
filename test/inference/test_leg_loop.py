# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The filter's loop by arrays, leg by leg, and as machine code: one filter."""

from __future__ import annotations

from collections.abc import Callable
from unittest.mock import patch

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from werrimbi_odom.inference.fitting import leg_loop
from werrimbi_odom.inference.fitting.filtering import FilterInput, FilterResult, filtered
from werrimbi_odom.model.compiled import compiled


def of_any_drive(random: np.random.Generator, sets: int, alike: bool) -> FilterInput:
    """Legs of some runs, with jumps, gaps, and coordinates that were not measured."""
    count = int(random.integers(2, 60))

    def covariance(*shape: int) -> np.ndarray:
        root = random.normal(0.0, 0.02, (*shape, 3, 3))
        return root @ root.swapaxes(-1, -2) + 1e-8 * np.eye(3)

    pose = np.cumsum(random.normal(0.0, [1.0, 1.0, 2.0], (count + 1, 3)), axis=0)
    pose[random.random(pose.shape) < random.choice([0.0, 0.3])] = np.nan
    begins = random.random(count) < 0.1
    begins[0] = True
    return FilterInput(
        random.normal(0.0, [1.0, 0.1, 2.0], (count, 3)),
        covariance(sets, count),
        pose[:-1],
        pose[1:],
        covariance(sets, 1 if alike else count),
        begins,
        random.random(count) < 0.2,
        np.where(random.random(count) < 0.5, random.normal(size=count), np.nan),
        stretch=int(random.integers(2, 20)),
    )


def by(way: Callable[..., None] | None, legs: FilterInput) -> FilterResult:
    with patch.object(leg_loop, "compiled", lambda function: way):
        return filtered(legs)


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 10**6), st.integers(1, 3), st.booleans())
def test_arrays_and_single_numbers_are_one_filter(seed: int, sets: int, alike: bool) -> None:
    legs = of_any_drive(np.random.default_rng(seed), sets, alike)
    arrays = by(None, legs)
    ways = [leg_loop.loop_over_scalars, compiled(leg_loop.loop_over_scalars)]
    for way in ways if ways[1] is not None else ways[:1]:
        numbers = by(way, legs)
        np.testing.assert_allclose(numbers.value, arrays.value, rtol=1e-8, atol=1e-9)
        rounding = 1e-15 * leg_loop.UNMEASURED  # of what was not measured, turned into the others
        np.testing.assert_allclose(numbers.covariance, arrays.covariance, rtol=1e-8, atol=rounding)
        for name in ("enter", "carry", "leave"):
            here, there = getattr(numbers.ways, name), getattr(arrays.ways, name)
            np.testing.assert_allclose(here, there, rtol=1e-7, atol=1e-8)


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 10**6), st.integers(1, 3), st.sampled_from([3, 6]))
def test_changes_are_carried_on_alike(seed: int, columns: int, states: int) -> None:
    random = np.random.default_rng(seed)
    bounds = np.cumsum([0, *sorted(random.integers(1, 5, 6))[::-1]])
    carry = random.normal(size=(bounds[-1], states, states)) * (random.random(states) < 0.7)
    given = random.normal(size=(bounds[-1], states, columns))
    plain = given.copy()
    for begin, end, before in zip(bounds[1:-1], bounds[2:], bounds[:-2], strict=True):
        for row in range(begin, end):
            plain[row] += carry[row] @ plain[before + row - begin]
    for way in (None, leg_loop.carried_in_scalars, compiled(leg_loop.carried_in_scalars)):
        change = given.copy()
        with patch.object(leg_loop, "compiled", lambda function, way=way: way):
            leg_loop.carry_on(carry, bounds, change)
        np.testing.assert_allclose(change, plain, rtol=1e-9, atol=1e-12)


def test_the_machine_code_is_there_where_numba_is() -> None:
    pytest.importorskip("numba")
    assert compiled(leg_loop.loop_over_scalars) is not None
