# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Where the printed commands lead a user who types them: to rest, at the truth, by no detour."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from test.hidden.intervals import rate
from test.hidden.plan import CALIBRATION
from test.hidden.result_line import (
    IN_LIBRARY,
    NEAR_THE_FLOOR,
    Judged,
    both_matter,
    expected_names,
    matters,
)
from test.hidden.table_layout import Table
from werrimbi_odom.effects import find

GROUPS = {
    "effect": "an effect",
    "clean": "nothing",
    "calibration": "several calibration numbers",
    "pair": "two effects",
    "mistake": "a set-up mistake",
    "factor": "a factor in the robot file",
    "rivals": "rivals by construction",
    "outsider": "outside the library",
    "other": "another engine set-up",
    "poorer": "a poorer reference",
}


def at_rest(line: Judged) -> bool:
    """The tool has nothing more to add."""
    return line.ended in ("none", "unknown")


def at_the_truth(line: Judged) -> bool:
    """What was added is what was hidden, twins and all, and the error is near the floor."""
    added = {name for names in line.steps for name in names}
    if not line.hidden and not line.entered:
        return line.ended == "none" and not added
    if not set(line.hidden) <= IN_LIBRARY:
        return line.ended == "unknown" and not added
    alike = {name: {name, *find(name).twins} for name in expected_names(line)}
    # Calibration is fitted along with whatever is added.
    fitted = bool(added) and any(name in CALIBRATION for name in alike)
    reached = all(
        added & names or (fitted and name in CALIBRATION) for name, names in alike.items()
    )
    allowed = set().union(*alike.values()) | (set(CALIBRATION) if fitted else set())
    near = not line.floor or (line.rested or 0.0) <= NEAR_THE_FLOOR * line.floor
    return line.ended == "none" and reached and added <= allowed and near


def without_detour(line: Judged) -> bool:
    """In at most as many steps as there are effects hidden, or factors entered."""
    return len(line.steps) <= len(line.hidden) + len(line.entered)


def counts(line: Judged) -> bool:
    """Whether the drives can show what is hidden: a weak effect may be left, and rivals do not."""
    if line.group == "pair":
        return both_matter(line)
    if line.group in ("effect", "other", "outsider"):
        return not line.hidden or matters(line)
    return line.group not in ("rivals", "poorer")


def table(lines: Sequence[Judged]) -> Table:
    """By what was hidden."""
    rows = []
    for group, says in GROUPS.items():
        own = [line for line in lines if line.group == group]
        parts = ((True, says), (False, f"{says}: weak, or not to be told"))
        for strong, words in parts:
            there = [line for line in own if counts(line) is strong]
            if there:
                rows.append((words, *_row(there)))
    columns = (
        "hidden",
        "sets",
        "come to rest",
        "... at the truth",
        "... in no more steps than effects",
        "at rest at none: compare says it explains",
        "... its mean is right",
    )
    return Table("Following the printed commands", columns, tuple(rows))


def _row(there: Sequence[Judged]) -> tuple[str, ...]:
    resting = [line for line in there if line.ended == "none"]
    return (
        str(len(there)),
        _share(there, at_rest),
        _share(there, at_the_truth),
        _share(there, lambda line: at_rest(line) and without_detour(line)),
        _share(resting, lambda line: line.explains is True),
        _share(resting, lambda line: line.mean_is_right is True),
    )


def _share(there: Sequence[Judged], holds: Callable[[Judged], bool]) -> str:
    return rate(sum(map(holds, there)), len(there))


def astray(lines: Sequence[Judged]) -> Table:
    """Those that should have come to the truth, by no detour, and did not."""
    rows = [
        (
            f"`{line.name}`",
            " → ".join(line.verdicts),
            line.ended,
            line.error.replace("|", "/"),
        )
        for line in lines
        if counts(line) and not (at_the_truth(line) and without_detour(line))
    ]
    columns = ("set", "verdicts, one after the other", "ended", "said")
    return Table("Printed commands that did not lead straight to the truth", columns, tuple(rows))
