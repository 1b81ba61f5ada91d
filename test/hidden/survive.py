# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Certainty that survives: what is said of the same drives with half the reference, or split anew.

A verdict that is sure should stay, or be said to be less sure. One that turns into another name
was not sure.
"""

from __future__ import annotations

import tempfile
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

from test.hidden.follow import follow
from test.hidden.intervals import rate
from test.hidden.plan import evenly
from test.hidden.result_line import Judged
from test.hidden.resumable_jobs import Line
from test.hidden.set_judging import options_of
from test.hidden.sets import HiddenSet, make, runs_of
from test.hidden.table_layout import Table

ROWS = {"odd rows": slice(1, None, 2), "even rows": slice(0, None, 2)}
"""Of the reference: half its rate, and noise that the two do not share."""

VARIANTS = (*ROWS, "another split")
GROUPS = ("effect", "clean", "pair", "outsider", "calibration")
HOWS = ("the same", "less sure", "not seen any more", "changed")


def tasks(sets: Sequence[HiddenSet], wanted: int, start: int) -> dict[str, tuple[HiddenSet, str]]:
    """Some of the judged sets, each with all variants."""
    whole = [each for each in sets if each.group in GROUPS]
    some = evenly(whole, wanted, start)
    return {f"{each.name} {how}": (each, how) for each in some for how in VARIANTS}


def work(task: tuple[HiddenSet, str]) -> Line:
    """What is said of a variant."""
    what, how = task
    folder = make(what)
    with changed(folder, how) as place:
        told = follow(place, options_of(what), most=0)
    first = told.first
    return {
        "set": what.name,
        "variant": how,
        "verdict": first["verdict"] if first else told.ended,
        "effect": first["effect"] if first else None,
        "found": [each["effect"] for each in first["found"]] if first else [],
        "rivals": first["rivals"] if first else [],
        "error": told.error,
    }


@contextmanager
def changed(folder: Path, how: str) -> Iterator[Path]:
    """The set with its reference thinned out, or with other drives held out."""
    with tempfile.TemporaryDirectory(prefix="survive") as name:
        place = Path(name)
        (place / "robot.yaml").write_bytes((folder / "robot.yaml").read_bytes())
        train, holdout = (
            [(part, run) for run in runs_of(folder, part)] for part in ("train", "holdout")
        )
        # As many drives held out as before, all of them others where there are enough.
        moved = [*train, *holdout]
        if how == "another split":
            moved = [*moved[len(holdout) :], *moved[: len(holdout)]]
        for number, (part, run) in enumerate(moved):
            side = "train" if number < len(train) else "holdout"
            there = place / side / f"{part}_{run.name}"
            there.mkdir(parents=True)
            (there / "ticks.csv").symlink_to((run / "ticks.csv").resolve())
            head, *rows = (run / "reference.csv").read_text(encoding="utf-8").splitlines(True)
            text = head + "".join(rows[ROWS[how]] if how in ROWS else rows)
            (there / "reference.csv").write_text(text, encoding="utf-8")
        yield place


def agreement(before: Judged, after: Line) -> str:
    """How a variant's verdict agrees with the whole set's: one of HOWS."""
    names = set(before.rivals or before.found)
    now = set(after["rivals"] or after["found"])
    if after["verdict"] == before.verdict and (
        now == names or (after["effect"] == before.effect and after["effect"] is not None)
    ):
        return "the same"
    if names and now and names & now and {before.verdict, after["verdict"]} & {"ambiguous"}:
        return "less sure"
    if before.verdict != "none" and after["verdict"] == "none":
        return "not seen any more"
    return "changed"


def tables(lines: Sequence[Judged], results: Mapping[str, Line]) -> list[Table]:
    """Agreement by variant, and all changes."""
    known = {line.name: line for line in lines}
    there = [each for each in results.values() if each["set"] in known]
    rows, changes = [], []
    for how in VARIANTS:
        own = [each for each in there if each["variant"] == how]
        count = Counter(agreement(known[each["set"]], each) for each in own)
        if own:
            rows.append((how, str(len(own)), *(rate(count[word], len(own)) for word in HOWS)))
    for each in there:
        before = known[each["set"]]
        word = agreement(before, each)
        if word != "the same":
            said = ", ".join(each["rivals"] or each["found"]) or each["error"].replace("|", "/")
            names = ", ".join(before.rivals or before.found)
            cells = (f"`{before.name}`", each["variant"], word)
            was = f"{before.verdict} {names}".strip()
            changes.append((*cells, was, f"{each['verdict']} {said}".strip()))
    words = (
        "The same drives with half the rows of the reference, and with other drives held out. "
        "*Less sure*: ambiguous, the name among the rivals, or the other way round."
    )
    return [
        Table("Certainty that survives", ("given", "sets", *HOWS), tuple(rows), words),
        Table(
            "Verdicts that did not survive",
            ("set", "given", "how", "all of it", "part of it"),
            tuple(changes),
        ),
    ]
