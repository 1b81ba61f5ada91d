# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Chances are those of scipy.stats."""

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
