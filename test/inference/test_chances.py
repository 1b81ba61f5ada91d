# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Chances are those of scipy.stats."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from werrimbi_odom.inference.chances import chi2_above, fisher_above, student_above

VALUES = st.floats(-1e3, 1e3)
DEGREES = st.floats(1.0, 400.0)


def alike(ours: float, theirs: float) -> None:
    assert ours == pytest.approx(theirs, rel=1e-8, abs=1e-290)


@given(VALUES, DEGREES, DEGREES)
def test_they_are_those_of_scipy_stats(value: float, degrees: float, more: float) -> None:
    alike(chi2_above(value, degrees), stats.chi2.sf(value, degrees))
    alike(student_above(value, degrees), stats.t.sf(value, degrees))
    alike(fisher_above(value, degrees, more), stats.f.sf(value, degrees, more))


def test_nothing_known_is_no_chance_at_all() -> None:
    assert math.isnan(chi2_above(math.nan, 2.0))
    assert math.isnan(student_above(math.nan, 2.0))
    assert math.isnan(fisher_above(math.nan, 2.0, 3.0))
    assert chi2_above(math.inf, 2.0) == fisher_above(math.inf, 2.0, 3.0) == 0.0
