# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The filters' loops by arrays, leg by leg, and as machine code: one filter each."""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType
from typing import TypeVar
from unittest.mock import patch

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from werrimbi_odom.inference.fitting import correlated_filter, correlated_loop, filtering, leg_loop
from werrimbi_odom.inference.fitting.correlated_filter import (
    GaussMarkovError,
    GyroHeading,
    filtered_with_correlated_error,
)
from werrimbi_odom.inference.fitting.correlated_loop import CorrelatedLoop
from werrimbi_odom.inference.fitting.filtering import FilterInput, filtered
from werrimbi_odom.model.compiled import compiled

Found = TypeVar("Found")


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


def of_any_reference(
    random: np.random.Generator, legs: FilterInput, gyro: bool
) -> GaussMarkovError:
    """An error that wanders, with gaps in which a localiser lost the robot."""
    sets, count = legs.noise.shape[:2]
    gap = legs.skip & (random.random(count) < 0.5)
    laid = None
    if gyro:
        turn, duration = random.normal(size=count), random.uniform(0.1, 2.0, count)
        laid = GyroHeading(turn, duration, random.uniform(0.0, 1e-4, sets))
    return GaussMarkovError(
        random.uniform(1e-6, 1e-2, (sets, 3)),
        random.uniform(0.0, 1.0, (sets, count)),
        gap,
        gap & (random.random(count) < 0.5),
        float(random.choice([0.0, 0.1])),
        laid,
    )


def of_each_way(module: ModuleType, run: Callable[[], Found]) -> tuple[Found, list[Found]]:
    """What a loop gives by arrays, and by Python's scalars and machine code."""
    ways = [None, module.loop_over_scalars, compiled(module.loop_over_scalars)]
    found = []
    for way in ways if ways[2] is not None else ways[:2]:
        with patch.object(module, "compiled", lambda function, way=way: way):
            found.append(run())
    return found[0], found[1:]


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 10**6), st.integers(1, 3), st.booleans())
def test_arrays_and_single_numbers_are_one_filter(seed: int, sets: int, alike: bool) -> None:
    legs = of_any_drive(np.random.default_rng(seed), sets, alike)
    arrays, others = of_each_way(leg_loop, lambda: filtered(legs))
    for numbers in others:
        np.testing.assert_allclose(numbers.value, arrays.value, rtol=1e-8, atol=1e-9)
        np.testing.assert_allclose(numbers.covariance, arrays.covariance, rtol=1e-8, atol=1e-9)
        for name in ("enter", "carry", "leave"):
            here, there = getattr(numbers.ways, name), getattr(arrays.ways, name)
            np.testing.assert_allclose(here, there, rtol=1e-7, atol=1e-8)


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 10**6), st.integers(1, 3), st.booleans())
def test_so_they_are_of_a_reference_whose_error_wanders(seed: int, sets: int, gyro: bool) -> None:
    """Asked in the axes of the reference, before they are turned into the robot's.

    There the variance of what was not measured, 1e6, is on the diagonal alone; turned, it takes the
    digits of the others.
    """
    random = np.random.default_rng(seed)
    legs = of_any_drive(random, sets, alike=False)
    wander = of_any_reference(random, legs, gyro)

    def run() -> CorrelatedLoop:
        with patch.object(correlated_filter, "run_loop", wraps=correlated_loop.run_loop) as loop:
            filtered_with_correlated_error(legs, wander)
        return loop.call_args.args[0]

    arrays, others = of_each_way(correlated_loop, run)
    for numbers in others:
        np.testing.assert_allclose(numbers.values, arrays.values, rtol=1e-8, atol=1e-9)
        np.testing.assert_allclose(numbers.covariances, arrays.covariances, rtol=1e-8, atol=1e-9)
        for name in ("turns", "moves", "less"):
            here, there = getattr(numbers, name), getattr(arrays, name)
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
    for way in (None, filtering.carried_in_scalars, compiled(filtering.carried_in_scalars)):
        change = given.copy()
        with patch.object(filtering, "compiled", lambda function, way=way: way):
            filtering.carry_on(carry, bounds, change)
        np.testing.assert_allclose(change, plain, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("module", [leg_loop, correlated_loop])
def test_the_machine_code_is_there_where_numba_is(module: ModuleType) -> None:
    pytest.importorskip("numba")
    assert compiled(module.loop_over_scalars) is not None
