# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What to do where rivals are observationally equivalent, by the twins that effects declare."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

from werrimbi_odom.effects.effect_docstring import page_of
from werrimbi_odom.inference.manoeuvres.for_unexplained_errors import ProposedManoeuvre
from werrimbi_odom.model.effect import Effect, Twin, twin_of


def twin_where(one: Effect, other: Effect, positions: bool) -> Twin | None:
    """The declared equivalence of two effects, if it holds for this kind of reference."""
    twin = twin_of(one, other)
    return None if twin is None or (twin.of_headings and positions) else twin


def for_twins(rivals: Sequence[Effect], positions: bool) -> ProposedManoeuvre | None:
    """What to do at the robot; None if drives may tell some rivals apart, or nothing is declared.

    Set-up mistakes are equivalent in larger sets than pairs: two of them may equal a third. A check
    by hand tells them all apart.
    """
    pairs = [twin_where(*pair, positions) for pair in combinations(rivals, 2)]
    twins = [twin for twin in pairs if twin is not None]
    mistakes = [effect for effect in rivals if effect.is_mistake]
    said = next((twin for twin in twins if twin.do), None)
    if said is not None and (len(twins) == len(pairs) or mistakes):
        return ProposedManoeuvre(said.manoeuvre, said.told_apart_by, said.do, said.minutes)
    if not mistakes:
        return None
    checks = dict.fromkeys(" ".join(page_of(each).sections["Ruler"].split()) for each in mistakes)
    return ProposedManoeuvre(
        "push_by_hand",
        "no drive can tell them apart, because the robot file alone says which end is ahead; a "
        "hand can",
        "; ".join(checks),
        0.0,
    )
