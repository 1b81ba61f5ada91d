# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What `add` says first."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

from werrimbi_odom.inference.diagnosis.paired_comparison import Sides
from werrimbi_odom.report.adding.words import _headline


def test_of_what_could_not_be_judged_no_number_is_told() -> None:
    """A spin that was held again and again, and added by force: nan mm, and nan % higher."""
    added: Any = SimpleNamespace(
        holdout=SimpleNamespace(sides=Sides(math.nan, math.nan), after=SimpleNamespace(leg=1.0)),
        effects=[SimpleNamespace(name="reference_lever_arm")],
        also=(),
        objection="reference_lever_arm cannot be judged",
    )
    said = _headline(added)
    assert "nan" not in said
    assert said.startswith("What reference_lever_arm does to the error of the held-out drives")
    added.holdout.sides = Sides(0.1, 0.05)
    assert "50.00 mm where it was 100 mm (50 % lower" in _headline(added)
