# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The proof on hidden effects: makes the sets, judges them, prints and writes the tables.

    python -m test.hidden [PART...] [--all] [--only WORD] [--workers N] [--start SEED]
                          [--sessions N]

Parts: make, judge, field, scans, survive, coverage, smallest, gaps, margins, table; all if none is
given.
It can be stopped at any time: what was made and judged stays, and the next call goes on from there.
Other code begins anew, on sets that nobody has seen: seeds are drawn from the code's digest.
"""

from __future__ import annotations

import argparse
import os
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from test.hidden import (
    coverage,
    evidence_tables,
    field,
    field_table,
    history,
    margins,
    plan,
    set_judging,
    smallest,
    survive,
)
from test.hidden.page import draw, page, with_part
from test.hidden.plan import ALL, SAMPLE, Sizes
from test.hidden.result_line import Judged, judgement
from test.hidden.resumable_jobs import Line, commit_now, done, kept, mark, results_of
from test.hidden.sets import ROOT, HiddenSet, make_all
from test.hidden.table_layout import Table, show

BY_ITSELF = ("field", "scans", "smallest")
"""Parts whose tables hold nothing of the judged sets."""


@dataclass(frozen=True)
class Extent:
    """How much of everything."""

    option: str
    """By which it is asked for."""
    sizes: Sizes
    survive: int
    """Sets."""
    fits: int
    """Short sessions for `calibrate fit`, beside the sets that calibration alone explains."""
    smallest: int
    """Sessions for each effect."""
    gaps: int
    """Sets."""
    margins: tuple[int, int]
    """Sets for each number, and of how many numbers one is taken."""
    field: tuple[int, int, int]
    """Sets of an effect, with nothing hidden, and effects, as people record them."""
    scans: tuple[int, int, int]
    """The same, judged by their scans alone."""


EVERYTHING = Extent(
    " --all",
    ALL,
    survive=100,
    fits=200,
    smallest=8,
    gaps=200,
    margins=(24, 1),
    field=(4, 12, len(plan.EFFECTS)),
    scans=(2, 12, len(plan.EFFECTS)),
)
PART_OF_IT = Extent(
    "",
    SAMPLE,
    survive=6,
    fits=32,
    smallest=1,
    gaps=20,
    margins=(1, 6),
    field=(1, 1, 4),
    scans=(1, 4, len(plan.EFFECTS)),
)

SCANS = 1000
"""Their seeds go on from there: other sets than those of "field"."""

SECONDS = {
    "make": 6.5,
    "judge": 17.0,
    "field": 100.0,
    "scans": 60.0,
    "survive": 4.5,
    "coverage": 6.0,
    "smallest": 30.0,
    "gaps": 4.5,
    "margins": 4.5,
}
"""Of one idle core, for a task of each part."""

PARTS = (*SECONDS, "table")


@dataclass(frozen=True)
class Work:
    """A part: its tasks, by the keys of their results, and who does them."""

    tasks: Mapping[str, Any]
    by: Callable[[Any], Line]


def works(
    wanted: Sequence[HiddenSet], start: int, extent: Extent, only: str = ""
) -> dict[str, Work]:
    """All parts but making and telling; of tasks those whose key holds a word."""
    all_of_it = {
        "judge": Work({each.name: each for each in wanted}, set_judging.work),
        "field": Work({each.name: each for each in field.sets(start, *extent.field)}, field.work),
        "scans": Work(
            {each.name: each for each in field.sets(start + SCANS, *extent.scans)}, field.by_scans
        ),
        "survive": Work(survive.tasks(wanted, extent.survive, start), survive.work),
        "coverage": Work(coverage.tasks(wanted, start, extent.fits), coverage.work),
        "smallest": Work(smallest.tasks(start, extent.smallest), smallest.work),
        "gaps": Work(
            {each.name: each for each in plan.evenly(wanted, extent.gaps, start)}, margins.gap
        ),
        "margins": Work(margins.tasks(wanted, extent.margins, start), margins.work),
    }
    return {
        name: Work({key: task for key, task in part.tasks.items() if only in key}, part.by)
        for name, part in all_of_it.items()
    }


def estimate(wanted: Sequence[HiddenSet], there: Mapping[str, Work], workers: int) -> list[str]:
    """The plan in words, with what is left to do."""
    missing = sum(not each.path.exists() for each in wanted)
    counts = {"make": (missing, len(wanted))}
    for name, part in there.items():
        left = set(part.tasks) - set(kept(results_of(name)))
        counts[name] = (len(left), len(part.tasks))
    lines = [
        f"{name:9} {left:5} of {planned:5} to do, {left * SECONDS[name] / 60.0:6.1f} min of a core"
        for name, (left, planned) in counts.items()
    ]
    total = sum(left * SECONDS[name] for name, (left, _) in counts.items()) / 60.0
    return [*lines, f"in all about {total / workers:.0f} min on {workers} idle cores"]


def judged_lines(wanted: Sequence[HiddenSet]) -> list[Judged]:
    """What was judged of the wanted sets, in the plan's order."""
    there = kept(results_of("judge"))
    return [Judged.of(there[each.name]) for each in wanted if each.name in there]


def tell(key: str, line: Line, part: str, count: str) -> None:
    """One line on the terminal for each result."""
    words = ""
    if part == "judge":
        judged = Judged.of(line)
        path = " > ".join(judged.verdicts) or judged.error
        words = f": {judgement(judged)} ({path}; ends {judged.ended})"
    print(f"{part} {count} {key}{words}", flush=True)


def all_tables(wanted: Sequence[HiddenSet], there: Mapping[str, Work]) -> dict[str, list[Table]]:
    """By part, of what was done; results of tasks that are no longer wanted are left out."""
    lines = judged_lines(wanted)
    own = {name: _own(name, part) for name, part in there.items()}
    scores = coverage.scores(lines, wanted, own["coverage"])
    return {
        "judge": evidence_tables.tables(lines),
        "field": field_table.tables(own["field"]),
        "scans": field_table.tables_by_scans(own["scans"]),
        "survive": survive.tables(lines, own["survive"]),
        "coverage": [coverage.table(scores), coverage.rank_table(scores)],
        "smallest": [smallest.table(own["smallest"])],
        "gaps": margins.tables(lines, own["gaps"]),
        "margins": [margins.table(lines, own["margins"])],
    }


def _own(name: str, part: Work) -> dict[str, Line]:
    return {key: line for key, line in kept(results_of(name)).items() if key in part.tasks}


def pictures(
    wanted: Sequence[HiddenSet], there: Mapping[str, Work], folder: Path
) -> list[tuple[str, str]]:
    """Drawn to a folder."""
    lines = judged_lines(wanted)
    scores = coverage.scores(lines, wanted, _own("coverage", there["coverage"]))
    found = smallest.ratios(_own("smallest", there["smallest"]), "named")
    sure = margins.constants().get("SURE", 1e-3)
    return draw(scores, found, *margins.sureness(lines), sure, folder)


def extent_wanted(*, whole: bool = False) -> Extent:
    """What an hour is enough for, or all; ALL=1 says the same as the option."""
    return EVERYTHING if whole or os.environ.get("ALL") == "1" else PART_OF_IT


def main() -> None:
    """See above."""
    parser = argparse.ArgumentParser(
        prog="python -m test.hidden",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("parts", nargs="*", metavar="PART", help=", ".join(PARTS))
    parser.add_argument("--all", action="store_true", help="all sets, not some of each kind")
    parser.add_argument("--only", default="", help="sets whose name holds this; nothing is written")
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--start", type=int, help="of the seeds; 0: those that were judged before")
    parser.add_argument("--sessions", type=int, help="of `smallest`, for each effect")
    parser.add_argument("--docs", type=Path, default=ROOT / "docs" / "evidence.md")
    arguments = parser.parse_args()
    unknown = set(arguments.parts) - set(PARTS)
    if unknown:
        parser.error(f"no part {', '.join(sorted(unknown))}; there are {', '.join(PARTS)}")
    parts = arguments.parts or PARTS
    extent = extent_wanted(whole=arguments.all)
    if arguments.sessions is not None:
        extent = replace(extent, smallest=arguments.sessions)
    start = plan.start_of(mark()) if arguments.start is None else arguments.start
    everything = plan.plan(start, extent.sizes)
    wanted = [each for each in everything if arguments.only in each.name]
    there = works(wanted, start, extent, arguments.only)
    print(f"code {mark()}, seeds from {start} on")
    print("\n".join(estimate(wanted, there, arguments.workers)), flush=True)
    if "make" in parts:
        for each in make_all(wanted, arguments.workers):
            print(f"made {each.name}", flush=True)
    # A robot that the engine cannot hold is left out.
    there = works([each for each in wanted if each.path.exists()], start, extent, arguments.only)
    for name, part in there.items():
        if name in parts:
            results = done(results_of(name), part.tasks, part.by, arguments.workers)
            for number, (key, line) in enumerate(results, start=1):
                tell(key, line, name, f"{number}/{len(part.tasks)}")
    if "table" in parts:
        write(wanted, there, start, arguments.docs, whole=not arguments.only, how=extent.option)


def write(
    wanted: Sequence[HiddenSet],
    there: Mapping[str, Work],
    start: int,
    docs: Path,
    *,
    whole: bool,
    how: str,
) -> None:
    """Tables on the terminal; where all that was planned is wanted, the page and its history."""
    from rich.console import Console

    by_part = all_tables(wanted, there)
    made = [table for tables in by_part.values() for table in tables]
    show([table for table in made if table.rows], Console(width=200).print)
    lines = judged_lines(wanted)
    if not whole:
        return
    if not lines:
        text = docs.read_text(encoding="utf-8")
        for part, tables in by_part.items():
            own = _own(part, there[part])
            if own and part in BY_ITSELF:
                codes = Counter(str(line.get("commit", commit_now())) for line in own.values())
                share = f"{len(own)} of {len(there[part].tasks)}"
                says = f"Run by itself, {share} (code `{max(codes, key=codes.__getitem__)}`)"
                text = with_part(text, tables, says)
        docs.write_text(text, encoding="utf-8")
        return
    entry = history.entry_of(lines, mark(), start)
    kept_in = docs.with_name("evidence_history.jsonl")
    # A line of the history is for good: not before every set is judged that the engine could make.
    complete = len(lines) == sum(each.path.exists() for each in wanted)
    entries = history.append(entry, kept_in) if complete else history.read(kept_in)
    text = page(
        [*made, history.table(entries)],
        pictures(wanted, there, docs.parent / "pictures"),
        how=how,
        judged=len(lines),
        planned=len(wanted),
        commit=entry["commit"],
        digest=mark(),
        fresh=bool(start),
        before=docs.read_text(encoding="utf-8") if docs.exists() else "",
        not_run=[
            table.title
            for part, tables in by_part.items()
            for table in tables
            if not _own(part, there[part])
        ],
    )
    docs.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
