# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Drafts of one variable and of two, on what the engine hides outside the library.

python -m test.hidden.drafts prints the table of docs/draft.md.
"""

from __future__ import annotations

from test.hidden.plan import OUTSIDERS
from test.hidden.set_judging import floor_of, read_set
from test.hidden.sets import HiddenSet
from werrimbi_odom.api.draft import draft
from werrimbi_odom.errors import InputError

OF_TWO = ("slide_by_tilt_and_payload", "one_tyre_by_load_over_pressure", "one_tyre_backwards")
SEED = 80_001
"""None of these sets was seen while the search was written."""

HEAD = ("hidden", "strength", "before", "one variable", "two variables", "right law", "law of two")


def row(what: HiddenSet) -> tuple[str, ...]:
    """Held-out errors of a set [mm], and the law of two where one was taken."""
    file, train, holdout = read_set(what)
    (hidden,) = what.hidden()
    unit = "" if hidden.entry.unit == "1" else f" {hidden.entry.unit}"
    named = (f"`{what.names[0]}`", f"{hidden.strength:.2g}{unit}")
    right = _mm(floor_of(what).of(what.names))
    try:
        result = draft(file, train, holdout=holdout, force=True)
    except InputError:
        return (*named, "", "none", "none", right, "")
    figures = result.to_dict()
    before, after = (_mm(figures["holdout"][key]) for key in ("before", "after"))
    two = figures["draft"]["of_two"]
    if two is None:
        return (*named, before, after, "not taken", right, "")
    one = _mm(two["held_out_with_one"]) if two["one"] else "none"
    law = figures["draft"]["law"].replace("|", r"\|")
    return (*named, before, one, after, right, f"`{law}`")


def _mm(metres: float) -> str:
    return f"{1e3 * metres:.2f}"


def main() -> None:
    """Print the table."""
    print("| " + " | ".join(HEAD) + " |\n" + "| --- " * len(HEAD) + "|")
    sets = [(name, 3) for name in OF_TWO]
    sets += [(name, 1) for name in OUTSIDERS if name not in OF_TWO]
    for name, count in sets:
        for number in range(count):
            cells = row(HiddenSet("outsider", (name,), SEED + number))
            print("| " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
