# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Tables of what was judged, for the terminal and for docs/evidence.md."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Sequence
from statistics import median

from test.hidden import followed_to_rest
from test.hidden.intervals import between
from test.hidden.plan import EFFECTS, OUTSIDERS
from test.hidden.poorer import POORER
from test.hidden.result_line import Judged, in_a_cell, is_right, judgement, matters
from test.hidden.rules import RULES, both_found, halfway, right_variable
from test.hidden.table_layout import Table
from werrimbi_odom.simulation.hidden import find as hideable


def tables(lines: Sequence[Judged]) -> list[Table]:
    """All tables that there are lines for."""
    made = [
        rules(lines),
        followed_to_rest.table(lines),
        of_effects("Each effect of the vocabulary", lines, "effect"),
        of_others(lines),
        of_outsiders(lines),
        of_pairs(lines),
        of_effects("Another engine set-up", lines, "other"),
        of_poorer(lines),
        wrong(lines),
        followed_to_rest.astray(lines),
    ]
    return [table for table in made if table.rows]


def rules(lines: Sequence[Judged]) -> Table:
    """Each rule, and how it stands."""
    rows = []
    for rule in RULES:
        there = rule.of(lines)
        if there:
            kept = len(there) - len(rule.broken_by(there))
            share = rule.share(lines)
            verdict = "kept" if share >= rule.needed else "BROKEN"
            kept_of = f"{kept} of {len(there)}"
            row = (rule.says, kept_of, f"{share:.1%}", between(kept, len(there)))
            rows.append((*row, f"{rule.needed:.0%}", verdict))
    columns = ("rule", "sets", "share", "95 % interval", "needed", "")
    return Table("Rules", columns, tuple(rows))


def of_effects(title: str, lines: Sequence[Judged], group: str) -> Table:
    """Effect by effect."""
    there = [line for line in lines if line.group == group]
    rows = []
    for name in ("", *EFFECTS):
        own = [line for line in there if line.hidden == ((name,) if name else ())]
        if own:
            rows.append(_row(name or "nothing", own, name))
    columns = (
        "hidden",
        "strengths",
        "sets",
        "that matter",
        "named first",
        "ambiguous",
        "missed",
        "wrong",
        "before, mm",
        "after, mm",
        "floor, mm",
        "after / floor, worst",
    )
    return Table(title, columns, tuple(rows))


def _row(title: str, own: Sequence[Judged], name: str) -> tuple[str, ...]:
    how = Counter(judgement(line) for line in own)
    strong = [line for line in own if matters(line)]
    named = sum(1 for line in strong if is_right(line))
    left = [line.added if line.added is not None else line.after for line in own]
    ratios = [
        value / line.floor
        for value, line in zip(left, own, strict=True)
        if value is not None and line.floor and is_right(line)
    ]
    return (
        title,
        _strengths(own, name),
        str(len(own)),
        f"{len(strong)}, {named} named" if strong else "0",
        str(how["named"]),
        str(how["ambiguous"]),
        str(how["missed"]),
        str(how["wrong"]),
        _mm(line.before for line in own),
        _mm(left),
        _mm(line.floor for line in own),
        f"{max(ratios):.2f}" if ratios else "",
    )


def _strengths(own: Sequence[Judged], name: str) -> str:
    if not name:
        return ""
    entry = hideable(name)
    sizes = sorted(abs(line.strengths[0] - entry.null) for line in own)
    unit = "" if entry.unit == "1" else f" {entry.unit}"
    return f"{sizes[0]:.2g} to {sizes[-1]:.2g}{unit}"


def of_others(lines: Sequence[Judged]) -> Table:
    """Groups whose verdict alone counts."""
    words = {
        "clean": "nothing",
        "calibration": "several calibration numbers",
        "mistake": "a set-up mistake",
        "factor": "a factor in the robot file",
        "rivals": "rivals by construction",
    }
    rows = []
    for group, says in words.items():
        own = [line for line in lines if line.group == group]
        if own:
            how = Counter(judgement(line) for line in own)
            given = Counter(line.verdict for line in own)
            rows.append(
                (
                    says,
                    str(len(own)),
                    *(str(how[word]) for word in ("named", "ambiguous", "missed", "wrong")),
                    ", ".join(f"{verdict} {count}" for verdict, count in given.items()),
                )
            )
    columns = ("hidden", "sets", "right", "ambiguous", "missed", "wrong", "verdicts")
    return Table("Nothing, calibration, mistakes, rivals", columns, tuple(rows))


def of_outsiders(lines: Sequence[Judged]) -> Table:
    """What the library does not hold."""
    rows = []
    for name in OUTSIDERS:
        own = [line for line in lines if line.hidden == (name,) and line.group == "outsider"]
        if not own:
            continue
        verdicts = Counter(line.verdict for line in own)
        unknown = [line for line in own if line.verdict == "unknown"]
        drafts = [line for line in unknown if line.drafted is not None]
        rows.append(
            (
                name,
                _strengths(own, name),
                str(len(own)),
                str(verdicts["unknown"]),
                str(verdicts["none"]),
                ", ".join(sorted({line.effect for line in own if line.effect})) or "",
                f"{sum(map(right_variable, unknown))} of {len(unknown)}",
                f"{sum(map(halfway, drafts))} of {len(drafts)}" if drafts else "",
                _mm(line.before for line in own),
                _mm(line.drafted for line in own),
                _mm(line.own_law for line in own),
                _mm(line.floor for line in own),
            )
        )
    columns = (
        "hidden",
        "strengths",
        "sets",
        "unknown",
        "none",
        "named instead",
        "right variable",
        "draft halfway",
        "before, mm",
        "draft, mm",
        "right law, mm",
        "nothing hidden, mm",
    )
    return Table("Outside the library", columns, tuple(rows))


def of_pairs(lines: Sequence[Judged]) -> Table:
    """Two effects at once."""
    rows = []
    for line in lines:
        if line.group != "pair":
            continue
        each = [
            f"{name} ({value / line.floor:.2f})" if line.floor else name
            for name, value in zip(line.hidden, line.without or (math.nan, math.nan), strict=True)
        ]
        rows.append(
            (
                " + ".join(each),
                ", ".join(line.found) or "none",
                "yes" if both_found(line) else "no",
                _mm([line.before]),
                _mm([line.after]),
                _mm([line.floor]),
            )
        )
    columns = (
        "hidden (error without it in the model, over the floor)",
        "found",
        "both",
        "before, mm",
        "after, mm",
        "floor, mm",
    )
    return Table("Two effects at once", columns, tuple(rows))


def of_poorer(lines: Sequence[Judged]) -> Table:
    """What poorer references can tell, by effect: named, ambiguous, missed, wrong."""
    there = [line for line in lines if line.group == "poorer"]
    rows = []
    for name in ("", *EFFECTS):
        cells = []
        for seen in POORER:
            own = [
                line
                for line in there
                if line.seen == seen and line.hidden == ((name,) if name else ())
            ]
            how = Counter(judgement(line) for line in own)
            words = {"named": "named" if name else "none", "ambiguous": "ambiguous"}
            words |= {"missed": "missed", "wrong": "WRONG"}
            cells.append(", ".join(f"{how[key]} {word}" for key, word in words.items() if how[key]))
        if any(cells):
            rows.append((name or "nothing", *cells))
    columns = ("hidden", *(each.says for each in POORER.values()))
    return Table("Poorer references of the same drives", columns, tuple(rows))


def _mm(values: Iterable[float | None]) -> str:
    """Median [mm]."""
    there = [value for value in values if value is not None and math.isfinite(value)]
    return f"{1e3 * median(there):.2f}" if there else ""


def wrong(lines: Sequence[Judged]) -> Table:
    """All wrong verdicts, whatever the group."""
    rows = [
        (
            f"`{line.name}`",
            line.verdict,
            ", ".join(line.found) or in_a_cell(line.error),
            ", ".join(line.rivals),
            f"{line.raised:.2f}" if math.isfinite(line.raised) else "",
        )
        for line in lines
        if judgement(line) == "wrong"
    ]
    columns = ("set", "verdict", "found", "rivals", "error raised by")
    return Table("All wrong verdicts", columns, tuple(rows))
