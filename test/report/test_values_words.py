# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Sizes that no drive tells apart are not told as if each were known."""

from __future__ import annotations

from werrimbi_odom.inference.diagnosis.estimated_values import Value
from werrimbi_odom.report.diagnosis.phrases import hang_together


def value(size: float, std: float, *, determined: bool = True) -> Value:
    return Value(size, std, "rad", "an angle", 0.0, determined=determined)


def test_two_that_may_each_be_none_hang_together() -> None:
    assert "hang together" in hang_together([value(0.040, 0.044), value(-0.075, 0.071)])


def test_one_that_is_known_says_it_all() -> None:
    assert hang_together([value(0.040, 0.004), value(-0.075, 0.071)]) == ""
    assert hang_together([value(0.040, 0.044)]) == ""
    assert hang_together([value(0.04, 0.044), value(0.1, 0.2, determined=False)]) == ""
