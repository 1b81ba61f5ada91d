# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The chapter of docs/effects.md that is made from the library; the rest of it is written by hand.

`python docs/make_effects.py` makes it anew.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from werrimbi_odom.effects.library import LIBRARY
from werrimbi_odom.effects.page import as_markdown
from werrimbi_odom.model.effect import Effect

BEGIN = "<!-- made by docs/make_effects.py; write elsewhere -->"
END = "<!-- made until here -->"


def with_chapter(text: str, effects: Sequence[Effect] = LIBRARY) -> str:
    """A page with the chapter between its two marks made anew."""
    before, mark, rest = text.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not mark or not end:
        raise ValueError(f"the page needs the two lines {BEGIN} and {END}")
    return f"{before}{BEGIN}\n\n{_chapter(effects)}\n{END}{after}"


def _chapter(effects: Sequence[Effect]) -> str:
    rows = [
        f"| [`{effect.name}`](#{effect.name}) | {effect.stage} | {effect.summary.rstrip('.')} |"
        for effect in effects
    ]
    table = ["| effect | acts on | what it is |", "| --- | --- | --- |", *rows, ""]
    return "\n".join([*table, *(as_markdown(effect) for effect in effects)])


if __name__ == "__main__":
    page = Path(__file__).with_name("effects.md")
    page.write_text(with_chapter(page.read_text(encoding="utf-8")), encoding="utf-8")
