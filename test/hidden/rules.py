# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What must hold over all hidden sets: shares, counted over the lines that were judged."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from test.hidden import followed_to_rest
from test.hidden.plan import CALIBRATION
from test.hidden.result_line import (
    NEAR_THE_FLOOR,
    Judged,
    both_matter,
    is_right,
    judgement,
    matters,
)
from test.hidden.right_laws import DEPENDS_ON
from werrimbi_odom.effects import find


@dataclass(frozen=True)
class Rule:
    """Of the sets that a rule speaks of, at least a share must do as it says."""

    says: str
    short: str
    """For the head of a column."""
    needed: float
    speaks_of: Callable[[Judged], bool]
    holds: Callable[[Judged], bool]

    def of(self, lines: Iterable[Judged]) -> list[Judged]:
        """The sets that it speaks of."""
        return [line for line in lines if self.speaks_of(line)]

    def broken_by(self, lines: Iterable[Judged]) -> list[Judged]:
        """Those that do otherwise."""
        return [line for line in self.of(lines) if not self.holds(line)]

    def share(self, lines: Sequence[Judged]) -> float:
        """Of sets that do as it says; nan where it speaks of none."""
        there = self.of(lines)
        return 1.0 - len(self.broken_by(there)) / len(there) if there else float("nan")


def both_found(line: Judged) -> bool:
    """Each hidden effect, or its twin."""
    found = {*line.found, *line.rivals}
    return all({name, *find(name).twins} & found for name in line.hidden)


def plainly_calibration(line: Judged) -> bool:
    """Named as calibration, and as nothing else."""
    return line.effect in line.hidden and set(line.found) <= set(CALIBRATION)


def near_the_floor(line: Judged) -> bool:
    """What adding the first effect leaves, or all that was found where more was hidden."""
    left = line.added if len(line.hidden) == 1 and line.added is not None else line.after
    return bool(left and line.floor and left <= NEAR_THE_FLOOR * line.floor)


def halfway(line: Judged) -> bool:
    """The draft lowers the held-out error at least halfway to the floor."""
    if line.drafted is None or line.before is None or line.floor is None:
        return False
    return line.drafted <= 0.5 * (line.before + line.floor)


def right_variable(line: Judged) -> bool:
    """The strongest dependence is on what the hidden law looks at."""
    first = line.depends_on[0][1] if line.depends_on else None
    return first in DEPENDS_ON[line.hidden[0]]


def of_group(*groups: str) -> Callable[[Judged], bool]:
    """Sets of some groups."""
    return lambda line: line.group in groups


def _rivals(line: Judged) -> bool:
    return line.group == "rivals" and not line.below_limit


def _asks_for_more(line: Judged) -> bool:
    """Rivals are told, the hidden one among them, and what to drive."""
    return judgement(line) == "ambiguous" and line.next_manoeuvre is not None


def _strong(line: Judged) -> bool:
    return line.group == "effect" and matters(line)


def _weak(line: Judged) -> bool:
    return line.group == "effect" and not matters(line)


def _own_law(line: Judged) -> bool:
    return line.group == "outsider" and line.own_law is not None


def _as_good_as_nothing(line: Judged) -> bool:
    return bool(line.own_law and line.floor and line.own_law <= NEAR_THE_FLOOR * line.floor)


RULES = (
    Rule("an effect that matters is named first (twins: both)", "named", 0.95, _strong, is_right),
    Rule(
        "a weak effect gets its own name or none",
        "weak",
        0.95,
        _weak,
        lambda line: judgement(line) != "wrong",
    ),
    Rule("once added, the error is near the floor", "floor", 0.95, _strong, near_the_floor),
    Rule("nothing hidden: none", "clean", 0.95, of_group("clean"), is_right),
    Rule(
        "calibration alone is named as calibration",
        "calibration",
        0.95,
        of_group("calibration"),
        plainly_calibration,
    ),
    Rule(
        "two effects that both matter are both found",
        "pairs",
        0.90,
        lambda line: line.group == "pair" and both_matter(line),
        both_found,
    ),
    Rule(
        "of two effects none gets a wrong name",
        "pairs, names",
        0.90,
        of_group("pair"),
        lambda line: (
            line.effect is None
            or line.effect in line.hidden
            or any(line.effect in find(name).twins for name in line.hidden)
        ),
    ),
    Rule(
        "rivals by construction: named, or ambiguous, the hidden one among them",
        "rivals",
        1.0,
        _rivals,
        lambda line: judgement(line) == "named" or _asks_for_more(line),
    ),
    Rule(
        "... and the proposed manoeuvres, driven, resolve them",
        "resolved",
        1.0,
        lambda line: _rivals(line) and _asks_for_more(line),
        lambda line: line.resolved == ("named", *line.hidden),
    ),
    Rule(
        "what is outside the library is unknown",
        "outside",
        0.90,
        lambda line: line.group == "outsider" and matters(line),
        is_right,
    ),
    Rule(
        "unknown, it depends on the right variable",
        "variable",
        0.90,
        lambda line: line.group == "outsider" and line.verdict == "unknown",
        right_variable,
    ),
    Rule(
        "its draft brings the error halfway to the floor",
        "draft",
        0.80,
        lambda line: line.group == "outsider" and line.verdict == "unknown",
        halfway,
    ),
    Rule(
        "its right law, written by hand, reaches the floor",
        "right law",
        0.95,
        _own_law,
        _as_good_as_nothing,
    ),
    Rule(
        "a set-up mistake is named",
        "mistakes",
        1.0,
        of_group("mistake"),
        lambda line: named_mistake(line),
    ),
    Rule(
        "a simple factor is named as such",
        "factors",
        1.0,
        of_group("factor"),
        lambda line: is_right(line) and line.factor is not None,
    ),
    Rule(
        "another engine set-up: what matters is named first, nothing is none",
        "other",
        0.90,
        lambda line: line.group == "other" and (not line.hidden or matters(line)),
        is_right,
    ),
    Rule(
        "another engine set-up: no wrong name",
        "other, weak",
        0.95,
        lambda line: line.group == "other" and bool(line.hidden) and not matters(line),
        lambda line: judgement(line) != "wrong",
    ),
    Rule(
        "a poorer reference makes no wrong name",
        "poorer",
        0.95,
        of_group("poorer"),
        lambda line: judgement(line) != "wrong",
    ),
    Rule(
        "the printed commands, followed, come to rest",
        "rest",
        0.95,
        lambda line: bool(line.verdicts),
        followed_to_rest.at_rest,
    ),
    Rule(
        "... at the truth, where it matters, in no more steps than effects",
        "truth",
        0.95,
        followed_to_rest.counts,
        lambda line: followed_to_rest.at_the_truth(line) and followed_to_rest.without_detour(line),
    ),
    Rule(
        "at rest at none, compare finds nothing systematic either",
        "compare",
        0.90,
        lambda line: line.ended == "none",
        lambda line: line.mean_is_right is True,
    ),
)


def named_mistake(line: Judged) -> bool:
    """The mistake leads; where another one is the same to the records, both are named."""
    (name,) = line.hidden
    twins = set(find(name).twins)
    if not twins:
        return line.verdict == "named" and line.effect == name
    return line.verdict == "ambiguous" and name in line.rivals and bool(twins & set(line.rivals))
