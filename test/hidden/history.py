# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""All states of the code that were judged, a line each: docs/evidence_history.jsonl.

Each is judged on sets of its own, so rates may be compared, and sets not be learnt by heart.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Sequence
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

from test.hidden.result_line import Judged
from test.hidden.rules import RULES
from test.hidden.sets import ROOT
from test.hidden.table_layout import Table

FILE = ROOT / "docs" / "evidence_history.jsonl"

Entry = dict[str, Any]


def entry_of(lines: Sequence[Judged], digest: str, start: int) -> Entry:
    """What was judged now."""
    commits = Counter(line.commit for line in lines)
    kept = {}
    for rule in RULES:
        there = rule.of(lines)
        if there:
            kept[rule.short] = [len(there) - len(rule.broken_by(there)), len(there)]
    return {
        "date": datetime.now(timezone.utc).date().isoformat(),
        "commit": max(commits, key=commits.__getitem__),
        "digest": digest,
        "start": start,
        "sets": len(lines),
        "rules": kept,
    }


def read(file: Path = FILE) -> list[Entry]:
    """All that was judged, the oldest first."""
    if not file.exists():
        return []
    return [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()]


def append(entry: Entry, file: Path = FILE) -> list[Entry]:
    """Add a line; the same code on the same sets again takes the place of its last one."""
    same = ("commit", "digest", "start")
    there = [each for each in read(file) if any(each[key] != entry[key] for key in same)]
    there.append(entry)
    file.write_text("".join(json.dumps(each) + "\n" for each in there), encoding="utf-8")
    return there


def table(entries: Sequence[Entry]) -> Table:
    """The newest first."""
    shorts = list(dict.fromkeys(name for each in entries for name in each["rules"]))
    rows = tuple(
        (
            each["date"],
            f"`{each['commit']}`",
            f"`{each['digest']}`",
            f"{each['sets']} {'fresh' if each['start'] else 'known before'}",
            *("/".join(map(str, each["rules"].get(name, ()))) for name in shorts),
        )
        for each in reversed(entries)
    )
    words = (
        "One line for each state of the code that was judged: how many sets kept each rule, of all "
        "to which it applies. *Fresh*: with seeds from the code's own digest, seen by nobody "
        "before."
    )
    return Table("All judged", ("date", "commit", "digest", "sets", *shorts), rows, words)
