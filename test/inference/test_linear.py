# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Projections, ranks and quantiles, against numpy and scipy."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from werrimbi_odom.inference.distributions import (
    bonferroni,
    chi2_survival,
    fisher_survival,
    student_survival,
)
from werrimbi_odom.inference.linear import (
    DETERMINED,
    admitted,
    covariance_of,
    inverse_root,
    nuisance,
    score_test,
    solved,
    square_and_volume,
)

RANDOM = np.random.default_rng(4)
NUISANCES = RANDOM.standard_normal((200, 3)) * np.array([1e-3, 1.0, 1e4])
COLUMNS = RANDOM.standard_normal((200, 2)) * np.array([1e-5, 1e3])
DATA = RANDOM.standard_normal(200)


def squares_left(columns: np.ndarray) -> float:
    left = DATA - columns @ np.linalg.lstsq(columns, DATA, rcond=None)[0]
    return float(left @ left)


def test_the_gain_is_what_a_fit_of_everything_would_gain() -> None:
    beside = nuisance(NUISANCES)
    found = score_test(COLUMNS, beside.residual(COLUMNS), beside.residual(DATA))
    assert found is not None
    everything = np.concatenate([NUISANCES, COLUMNS], axis=1)
    assert found.degrees == 2
    assert found.gain == pytest.approx(squares_left(NUISANCES) - squares_left(everything))
    fitted = np.linalg.lstsq(everything, DATA, rcond=None)[0]
    np.testing.assert_allclose(-found.coefficients, fitted[3:], rtol=1e-8)
    np.testing.assert_allclose(solved(everything, DATA), fitted, rtol=1e-8)
    expected = np.linalg.inv(everything.T @ everything)
    spread = np.sqrt(np.diag(expected))
    np.testing.assert_allclose(
        covariance_of(everything) / np.outer(spread, spread),
        expected / np.outer(spread, spread),
        atol=1e-8,
    )


@pytest.mark.parametrize(("share", "degrees"), [(2.0, 2), (0.5, 1)])
def test_a_column_that_the_nuisances_explain_is_not_counted(share: float, degrees: int) -> None:
    """Whatever its unit: what counts is the share of it that is left."""
    beside = nuisance(NUISANCES)
    own = beside.residual(COLUMNS[:, 0])
    own = own / np.sqrt(own @ own)
    for unit in (1e-7, 1.0, 1e7):
        hidden = unit * (beside.basis[:, 0] + share * DETERMINED * own)
        columns = np.stack([hidden, COLUMNS[:, 1]], axis=-1)
        found = score_test(columns, beside.residual(columns), beside.residual(DATA))
        assert found is not None
        assert found.degrees == degrees
        assert admitted(columns, beside) == ([0, 1] if degrees == 2 else [1])


def test_of_equivalent_columns_the_first_is_kept() -> None:
    columns = np.stack([COLUMNS[:, 0], COLUMNS[:, 1], COLUMNS[:, 0] + 3e-9 * COLUMNS[:, 1]], -1)
    beside = nuisance(NUISANCES[:, :0])
    assert admitted(columns, beside) == [0, 1]
    assert admitted(columns[:, ::-1], beside) == [0, 1]


def test_a_column_that_is_not_known_well_enough_is_in_the_way_of_none_after_it() -> None:
    alike = COLUMNS[:, 0] + 0.01 * COLUMNS[:, 1]
    columns = np.stack([COLUMNS[:, 0], alike, COLUMNS[:, 1]], axis=-1)
    beside = nuisance(NUISANCES[:, :0])
    assert admitted(columns, beside) == [0, 1]
    assert admitted(columns, beside, lambda tried: 1 not in tried) == [0, 2]


def test_a_silent_column_is_neither_tested_nor_moved() -> None:
    none = np.zeros((200, 1))
    assert score_test(none, none, DATA) is None
    np.testing.assert_array_equal(solved(np.concatenate([none, COLUMNS], axis=1), DATA)[:1], 0.0)


def test_formulas_for_covariances_say_what_lapack_says() -> None:
    random = np.random.default_rng(3)
    part = random.normal(0.0, [1.0, 0.1, 0.02], (2, 50, 3, 3))
    covariance = part.swapaxes(-1, -2) @ part + np.diag([1e-4, 1e-4, 1e-6])
    covariance[:, :10, 2, 2] += 1e6  # what was not measured
    value = random.normal(0.0, [1.0, 0.1, 0.02], (2, 50, 3))
    root = np.linalg.inv(np.linalg.cholesky(covariance))
    np.testing.assert_allclose(inverse_root(covariance), root, rtol=1e-7, atol=1e-9)
    square, volume = square_and_volume(covariance, value)
    np.testing.assert_allclose(square, np.sum((root @ value[..., None]) ** 2, (-1, -2)), rtol=1e-7)
    np.testing.assert_allclose(volume, np.linalg.slogdet(covariance)[1], rtol=1e-9)
    with pytest.raises(np.linalg.LinAlgError):
        inverse_root(-covariance)


VALUES = st.floats(-1e3, 1e3)
DEGREES = st.floats(1.0, 400.0)


def alike(ours: float, theirs: float) -> None:
    assert ours == pytest.approx(theirs, rel=1e-8, abs=1e-290)


@given(VALUES, DEGREES, DEGREES)
def test_they_are_those_of_scipy_stats(value: float, degrees: float, more: float) -> None:
    alike(chi2_survival(value, degrees), stats.chi2.sf(value, degrees))
    alike(student_survival(value, degrees), stats.t.sf(value, degrees))
    alike(fisher_survival(value, degrees, more), stats.f.sf(value, degrees, more))


def test_nothing_known_is_no_chance_at_all() -> None:
    assert math.isnan(chi2_survival(math.nan, 2.0))
    assert math.isnan(student_survival(math.nan, 2.0))
    assert math.isnan(fisher_survival(math.nan, 2.0, 3.0))
    assert chi2_survival(math.inf, 2.0) == fisher_survival(math.inf, 2.0, 3.0) == 0.0


def test_many_tests_find_something_by_chance_no_oftener_than_is_said() -> None:
    """Bonferroni's bound against so many p-values drawn alike; and no chance is above one."""
    least = np.random.default_rng(7).uniform(size=(4000, 20)).min(axis=1)
    said = np.array([bonferroni(20, float(p)) for p in least])
    for level in (0.05, 0.2):
        share = float(np.mean(said < level))
        assert 0.8 * level < share < level + 3.0 * np.sqrt(level / least.size)
    assert bonferroni(20, 0.3) == 1.0
