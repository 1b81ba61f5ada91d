# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Nothing is said to fall from 3.5 mm to 3.5 mm."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from werrimbi_odom.inference.diagnosis.paired_comparison import Sides
from werrimbi_odom.report.diagnosis.phrases import cost, whole


def told_of(after: float) -> Any:
    """One thing that was found, and another, by a metre of driving."""
    sides = Sides(3.5300e-3, after)
    diagnosis = SimpleNamespace(
        found=("track_width", "reference_delay"),
        ranking=(SimpleNamespace(effect="track_width", holdout=sides),),
        holdout=sides,
    )
    return SimpleNamespace(diagnosis=diagnosis, held_out=(), leg=0.25)


@pytest.mark.parametrize(
    ("after", "one", "all_of_it"),
    [
        (3.5299e-3, "hardly anything on a part put aside for judging", "stays at 3.5 mm"),
        (1.2e-3, "falls from 3.5 mm to 1.2 mm when it is put in", "falls from 3.5 mm to 1.2 mm"),
    ],
)
def test_what_it_costs(after: float, one: str, all_of_it: str) -> None:
    told = told_of(after)
    assert one in " ".join(cost(told, "track_width"))
    assert all_of_it in " ".join(whole(told))
