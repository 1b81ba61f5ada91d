# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What is missing of one robot of a fleet, and what to do next, in a few words."""

from __future__ import annotations

from werrimbi_odom.report.fleet import Row, believed, number
from werrimbi_odom.report.number_format import listed, with_std


def missing_words(row: Row) -> list[str]:
    """Missing effects of a robot, each with its fitted values."""
    if row.verdict == "none":
        return ["nothing"]
    said = [f"{row.rivals[0]} or {listed(row.rivals[1:], 'or')}"] if len(row.rivals) > 1 else []
    said += [_with_values(row, effect) for effect in row.missing]
    if _drives_differ(row):
        said.append("not the same in all drives")
    elif wheel := _one_wheel(row):
        said.append("the wheels err" if wheel == "both" else f"the {wheel} wheel errs")
        said[-1] += ", by no law"
    elif when := _by_events(row):
        said.append(f"something at each {when}")
    elif row.verdict == "unknown" and row.figures is not None:
        cells = row.figures["depends_on"]
        said.append(cells[0]["words"] if cells else "no effect of the library")
    return said


def _with_values(row: Row, effect: str) -> str:
    values = [
        f"{name} {with_std(item['value'], number(item['std']))} {item['unit']}".rstrip()
        for name, item in believed(row.values(effect)).items()
    ]
    return "\n  ".join([f"{effect}:", *values]) if values else effect


def _one_wheel(row: Row) -> str:
    """The wheel that errs far more than the other, by no law; "" if none does."""
    told = row.figures and row.figures.get("one_sided_noise")
    return told["side"] if told else ""


def _drives_differ(row: Row) -> bool:
    """Whether changes between its drives may be all that no effect explains."""
    return bool(row.figures and row.figures.get("drives_differ"))


def _by_events(row: Row) -> str:
    """With what abrupt errors come that alone say that something is missing; "" if none do."""
    told = row.figures if row.figures and row.figures.get("by_events") else None
    return str(told["events_alike"]["what"]) if told else ""


def next_words(row: Row) -> str:
    """Next step in a few words; `add` and `draft` are verbs of this tool."""
    if row.verdict == "named":
        return f"add {','.join(row.missing)}"
    if _drives_differ(row):
        return "diagnose the drives since the change"
    if wheel := _one_wheel(row):
        return "look at the wheels" if wheel == "both" else f"look at the {wheel} wheel"
    if row.figures is not None and row.figures.get("as_a_floor"):
        return "record with motion capture"
    if row.verdict == "unknown" and not _by_events(row):
        return "draft"
    if row.verdict == "none" and row.figures is not None and row.figures["outdated"]:
        return f"add {row.figures['outdated'][0]['effect']}"
    if row.verdict in ("ambiguous", "unknown") and row.figures is not None:
        move = row.figures["next_manoeuvre"]
        if move is None:
            return "use a ruler"
        name = str(move["name"]).replace("_", " ")
        return f"drive {name} ({move['minutes']:.0f} min)" if move["minutes"] else name
    return ""
