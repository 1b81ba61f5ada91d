# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Tables of the sets that are made as people record them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping

from test.hidden.field import SEEN, could_be_seen, how
from test.hidden.intervals import between
from test.hidden.plan import EFFECTS
from test.hidden.result_line import in_a_cell
from test.hidden.resumable_jobs import Line
from test.hidden.table_layout import Table

WORDS = (
    "Sets made by `werrimbi simulate --like field`: wheels at 20 Hz with stamps that jitter, a "
    "gyro with a scale of its own, a localiser that wanders and jumps, the robot held and carried "
    "in each drive. {by} *Small*: not told, and the diagnosis itself says that one of this size "
    "would not have been seen, or the reference holds none of it."
)
BY_EACH = "The same bags are judged by five references."
BY_SCANS = "Other such sets, judged by their scans, and by nothing else."


def tables(results: Mapping[str, Line]) -> list[Table]:
    """The rules, each effect by each reference, and all wrong verdicts."""
    return _tables(results, "As people record", BY_EACH)


def tables_by_scans(results: Mapping[str, Line]) -> list[Table]:
    """The same where a lidar is all that there is."""
    return _tables(results, "As people record, by a lidar alone", BY_SCANS)


def _tables(results: Mapping[str, Line], title: str, by: str) -> list[Table]:
    return [
        _rules(results, f"{title}: rules", WORDS.format(by=by)),
        _effects(results, f"{title}: each effect"),
        _wrong(results, f"{title}: all wrong verdicts"),
    ]


def _judged(results: Mapping[str, Line]) -> Iterator[tuple[str, Line, str, Line, str]]:
    """Set, its line, reference, what was said, and what that is worth."""
    for key, line in results.items():
        for name, said in line["said"].items():
            yield key, line, name, said, how(line["hidden"], name, said)


def rules(results: Mapping[str, Line]) -> dict[str, tuple[int, int, float]]:
    """By what each says: how many kept it, of how many, and the share that is needed."""
    worth = [(line, word) for _, line, _, _, word in _judged(results)]
    told = [word != "wrong" for line, word in worth if line["hidden"]]
    clean = [word == "named" for line, word in worth if not line["hidden"]]
    found = {"held": [], "carried": []}  # type: dict[str, list[bool]]
    for _, _, _, said, _ in _judged(results):
        for why, there in said.get("stretches", {}).items():
            found[why] += [hit for _, _, hit in there]
    circles = [refused for line in results.values() for refused in line.get("circles", {}).values()]
    counted = {
        "no wrong name": (told, 0.98),
        "nothing hidden: none (by a gyro: nothing but its own scale)": (clean, 0.98),
        "held: found, to 0.5 s": (found["held"], 0.95),
        "carried: found, to 0.5 s": (found["carried"], 0.95),
        "a reference made from the wheels is refused": (circles, 1.0),
    }
    return {says: (sum(kept), len(kept), least) for says, (kept, least) in counted.items() if kept}


def _rules(results: Mapping[str, Line], title: str, words: str) -> Table:
    rows = [
        (
            says,
            f"{kept} of {count}",
            f"{kept / count:.1%}",
            between(kept, count),
            f"{needed:.0%}",
            "kept" if kept >= needed * count else "BROKEN",
        )
        for says, (kept, count, needed) in rules(results).items()
    ]
    columns = ("rule", "judged", "share", "95 % interval", "needed", "")
    return Table(title, columns, tuple(rows), words)


def _effects(results: Mapping[str, Line], title: str) -> Table:
    judged = {name for line in results.values() for name in line["said"]}
    by = [name for name in SEEN if name in judged]
    rows = []
    for effect in ("", *EFFECTS):
        own = [
            each for each in _judged(results) if each[1]["hidden"] == ([effect] if effect else [])
        ]
        cells = [", ".join(_counted(own, effect, name)) for name in by]
        if any(cells):
            rows.append((effect or "nothing", *cells))
    return Table(title, ("hidden", *(SEEN[name].says for name in by)), tuple(rows))


def _counted(own: list[tuple[str, Line, str, Line, str]], effect: str, name: str) -> list[str]:
    """Verdicts by one reference, in words."""

    def word(line: Line, seen: str, said: Line, worth: str) -> str:
        if not effect and worth == "named":
            return "none"
        if worth == "missed" and not could_be_seen(effect, line["strength"], seen, said):
            return "small"
        return "WRONG" if worth == "wrong" else worth

    counts = Counter(word(*each[1:]) for each in own if each[2] == name)
    order: Callable[[str], int] = (["named", "none", "ambiguous", "small", "missed", "WRONG"]).index
    return [f"{counts[each]} {each}" for each in sorted(counts, key=order)]


def _wrong(results: Mapping[str, Line], title: str) -> Table:
    rows = [
        (
            f"`{key}`",
            SEEN[name].says,
            said["verdict"],
            ", ".join(said.get("found", ())) or in_a_cell(said.get("error", "")),
            ", ".join(said.get("rivals", ())),
        )
        for key, _, name, said, worth in _judged(results)
        if worth == "wrong"
    ]
    columns = ("set", "by", "verdict", "found", "rivals")
    return Table(title, columns, tuple(rows))
