# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What was said of one hidden set, against what is true: right, or not."""

from __future__ import annotations

import re
from dataclasses import asdict, dataclass, field, fields
from typing import Any

from test.hidden.resumable_jobs import Line
from werrimbi_odom.effects import find
from werrimbi_odom.effects.library import LIBRARY

IN_LIBRARY = frozenset(effect.name for effect in LIBRARY)

CONFUSED = "wrong"

MATTERS = 1.1
"""An effect matters when it raises the held-out error by more than a tenth."""

NEAR_THE_FLOOR = 1.25
"""What is found brings the held-out error to within this of the best that can be had."""


BY_A_GYRO = {"reference_heading_delay": "reference_delay", "wheel_radius_scale": "track_width"}
"""What headings alone call a thing that they cannot tell from it."""


@dataclass(frozen=True, kw_only=True)
class Judged:
    """What was said of a set, and what was true."""

    name: str
    group: str
    setup: str
    seen: str
    hidden: tuple[str, ...]
    strengths: tuple[float, ...]
    entered: tuple[tuple[str, float], ...]
    commit: str
    seconds: float
    """Of one core, for the diagnosis."""
    verdict: str
    effect: str | None = None
    found: tuple[str, ...] = ()
    values: Line = field(default_factory=dict)
    """Of all parameters of what was found, as the first diagnosis states them: value and standard
    deviation."""
    rivals: tuple[str, ...] = ()
    factor: str | None = None
    depends_on: tuple[tuple[str, str], ...] = ()
    changes: tuple[str, ...] = ()
    """Parts and effects that are said to differ from drive to drive."""
    below_limit: bool = False
    """Of a verdict of none: whether the diagnosis itself says that one of this size would not have
    been seen in 95 of 100 cases."""
    next_manoeuvre: str | None = None
    minutes: float = 0.0
    """How long that is to be driven."""
    p_values: tuple[tuple[str, float | None], ...] = ()
    """Of the ranking."""
    before: float | None = None
    """Held-out position error with the robot file as it was given [m]."""
    after: float | None = None
    """With what was found put in [m]."""
    verdicts: tuple[str, ...] = ()
    """Of the diagnosis, and of those after each command that it printed."""
    steps: tuple[tuple[str, ...], ...] = ()
    """What each of these commands added."""
    ended: str = ""
    """How that ended; of `Followed`."""
    rested: float | None = None
    """Held-out position error of the robot file at the end [m]."""
    explains: bool | None = None
    """Whether compare agrees with a last verdict of none."""
    mean_is_right: bool | None = None
    """The same, whatever compare says of the covariance."""
    fits: tuple[Line, ...] = ()
    """Parameters of each addition with their standard deviations."""
    added: float | None = None
    """Held-out error once the first command was followed; as before where it was refused [m]."""
    floor: float | None = None
    """With the truth put in [m]."""
    without: tuple[float, ...] = ()
    """Of several hidden effects: held-out error with the truth less each of them [m]."""
    own_law: float | None = None
    """Of an outsider: with its right law, written by hand [m]."""
    drafted: float | None = None
    """Of an outsider: with the draft [m]."""
    resolved: tuple[str, ...] = ()
    """Of rivals by construction: verdict and names once what was asked for was driven."""
    error: str = ""

    @property
    def raised(self) -> float:
        """Factor by which what was hidden raised the held-out error."""
        if not self.before or not self.floor:
            return float("nan")
        return self.before / self.floor

    def line(self) -> Line:
        """For the file of results."""
        return asdict(self)

    @classmethod
    def of(cls, line: Line) -> Judged:
        """From a line of the file of results."""
        return cls(**{each.name: _tuples(line[each.name]) for each in fields(cls)})


def _tuples(value: Any) -> Any:
    return tuple(map(_tuples, value)) if isinstance(value, list) else value


def judgement(line: Judged) -> str:
    """named, ambiguous, missed or wrong: what the diagnosis made of what was hidden.

    ambiguous is right for twins (of one alone both are to be told), and honest where the hidden
    effect is among the rivals; unknown, for an effect of the library, is wrong. An effect of which
    only what it extends was told, and that this is another from drive to drive, was missed.
    """
    if line.verdict in ("refused", "crashed"):
        return CONFUSED
    if not line.hidden and not line.entered:
        return "named" if line.verdict == "none" else CONFUSED
    if line.group == "outsider" or any(name not in IN_LIBRARY for name in line.hidden):
        return _of_outsider(line)
    if line.verdict == "none":
        return "missed"
    expected = expected_names(line)
    if line.verdict == "ambiguous":
        return "ambiguous" if expected & set(line.rivals) else CONFUSED
    if line.verdict == "named" and line.effect in expected:
        twins = {twin for name in expected for twin in find(name).twins}
        alone = len(line.hidden) == 1  # then both twins are to be told
        return CONFUSED if alone and twins and not twins & expected else "named"
    return "missed" if _without_what_extends_it(line) else CONFUSED


def _without_what_extends_it(line: Judged) -> bool:
    """Whether a hidden effect was told but for what it has beyond the one that it extends.

    A clock whose rate is too small to be seen is late by another delay in each drive. That is true
    where both are said; one delay for all drives is not.
    """
    if line.verdict != "named" or len(line.hidden) != 1 or len(line.found) != 1:
        return False
    (name,) = line.hidden
    return line.found == (find(name).extends,) and line.found[0] in line.changes


def _of_outsider(line: Judged) -> str:
    if line.verdict == "unknown":
        return "named"
    return "missed" if line.verdict == "none" else CONFUSED


def expected_names(line: Judged) -> set[str]:
    """Names that are right.

    Of a gyro, whose headings are all that it tells, late headings are a late clock, and the size of
    both wheels is the base's inverse, which is told in its place (and in a sentence beside it).
    """
    if line.entered:
        keys = {key for key, _ in line.entered}
        return {
            "track_width" if key == "wheel_separation" else "wheel_radius_scale" for key in keys
        }
    same = BY_A_GYRO if line.seen == "gyro" else {}
    return {*line.hidden, *(same[name] for name in line.hidden if name in same)}


def is_right(line: Judged) -> bool:
    """Named first; of twins, both."""
    how = judgement(line)
    if how == "named":
        return True
    if how != "ambiguous" or len(line.hidden) != 1:
        return False
    (name,) = line.hidden
    twins = set(find(name).twins)
    return bool(twins) and name in line.rivals and bool(twins & set(line.rivals))


def matters(line: Judged) -> bool:
    """Whether what is hidden raises the held-out error by more than a tenth."""
    return line.raised > MATTERS


def both_matter(line: Judged) -> bool:
    """Whether each of several hidden effects does, the others being in the model."""
    return bool(line.without) and all(
        line.floor is not None and each > MATTERS * line.floor for each in line.without
    )


def in_a_cell(error: str) -> str:
    """An error for a table's cell: without the folders of this machine."""
    return re.sub(r"/\S*/", "", error).replace("|", "/")
