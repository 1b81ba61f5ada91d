# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""How long to drive what tells rivals apart, and how surely it does."""

from __future__ import annotations

import pytest

from werrimbi_odom.inference.manoeuvres.for_unexplained_errors import ProposedManoeuvre
from werrimbi_odom.report.diagnosis.words import how_long


@pytest.mark.parametrize(
    ("minutes", "chance", "says"),
    [
        (3.0, 0.97, "About 3 min of it are enough."),
        (30.0, 0.704, "About 30 min of it tell them apart in 70 % of cases."),
    ],
)
def test_of_a_drive_it_is_said_how_long_and_how_surely_it_tells(
    minutes: float, chance: float, says: str
) -> None:
    move = ProposedManoeuvre("spins", "they differ", "spin", minutes, chance)
    first, then = how_long(move, "werrimbi diagnose")
    assert first == says
    assert then == "Then give that drive to `werrimbi diagnose` together with these."


def test_of_what_is_no_drive_no_minutes_are_said() -> None:
    assert not list(
        how_long(ProposedManoeuvre("push", "one and the same", "push it", 0.0), "werrimbi")
    )
