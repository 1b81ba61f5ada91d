# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The proof on hidden effects: makes the sets, judges them, prints and writes the tables.

    python -m test.hidden [make|judge|table] [--sample] [--only WORD] [--workers N]

It can be stopped at any time: what was made and judged stays, and the next call goes on from there.
A result counts for the code of the diagnosis that it was made with; other code judges anew.
"""

from __future__ import annotations

import argparse
import os
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path

from test.hidden import plan
from test.hidden.judge import Judged, append, judged, judgement, results
from test.hidden.sets import ROOT, HiddenSet, cache, code_mark, make_all
from test.hidden.table import page, show

CODE = tuple(f"werrimbi_odom/{name}" for name in ("model", "effects", "files", "inference"))
"""What a verdict depends on; when it changes, sets are judged anew."""


def results_file() -> Path:
    """Where the results of the present code are kept."""
    return cache() / "results" / f"{code_mark(*CODE)}.jsonl"


def judge_all(wanted: list[HiddenSet], workers: int, file: Path) -> None:
    """Judge what is not judged yet, each as soon as it is done."""
    known = {line.name for line in results(file)}
    todo = [each for each in wanted if each.name not in known and each.path.exists()]
    with ProcessPoolExecutor(workers) as pool:
        jobs = {pool.submit(judged, each): each for each in todo}
        for number, job in enumerate(as_completed(jobs), start=1):
            line = job.result()
            append(line, file)
            _tell(number, len(todo), line)


def _tell(number: int, count: int, line: Judged) -> None:
    found = ", ".join(line.found) or line.error
    print(f"{number}/{count} {line.name}: {judgement(line)} ({line.verdict} {found})", flush=True)


def chosen(lines: list[Judged], wanted: list[HiddenSet]) -> list[Judged]:
    """The last result of each wanted set, in the plan's order."""
    last = {line.name: line for line in lines}
    return [last[each.name] for each in wanted if each.name in last]


def main() -> None:
    """See above."""
    parser = argparse.ArgumentParser(prog="python -m test.hidden", description=__doc__)
    parser.add_argument("what", nargs="?", choices=("make", "judge", "table", "all"), default="all")
    parser.add_argument("--sample", action="store_true", help="some of each kind")
    parser.add_argument("--only", default="", help="sets whose name holds this")
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--docs", type=Path, default=ROOT / "docs" / "evidence.md")
    arguments = parser.parse_args()
    everything = plan.sample() if arguments.sample else plan.everything()
    wanted = [each for each in everything if arguments.only in each.name]
    file = results_file()
    if arguments.what in ("make", "all"):
        for each in make_all(wanted, arguments.workers):
            print(f"made {each.name}", flush=True)
    if arguments.what in ("judge", "all"):
        judge_all(wanted, arguments.workers, file)
    from rich.console import Console

    lines = chosen(list(results(file)), wanted)
    show(lines, Console(width=200).print)
    if not arguments.sample and not arguments.only:
        arguments.docs.write_text(page(lines, len(wanted)), encoding="utf-8")


if __name__ == "__main__":
    main()
