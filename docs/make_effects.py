# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The chapter of docs/effects.md that is made from the library; the rest of it is written by hand.

`python docs/make_effects.py` makes it anew.
"""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from pathlib import Path

from werrimbi_odom.effects.effect_docstring import MEANING, STAGES, absent_at, anew, page_of
from werrimbi_odom.effects.library import LIBRARY
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
    return "\n".join([*table, *(_page(effect) for effect in effects)])


def _page(effect: Effect) -> str:
    page = page_of(effect)
    lines = [f"### `{effect.name}`", "", f"Acts {STAGES[effect.stage]}.", ""]
    for paragraph in page.physics:
        lines += [textwrap.fill(paragraph, 100), ""]
    for name, text in page.sections.items():
        if name == "Formula":
            lines += ["```text", text, "```", ""]
        else:
            lines += [
                textwrap.fill(f"**{name}** ({MEANING[name]}): {' '.join(text.split())}.", 100),
                "",
            ]
    if effect.parameters:
        lines += [
            "| parameter | unit | absent at | typical | possible | what it is |",
            "| --- | --- | --- | --- | --- | --- |",
        ]
        for name, item in effect.parameters.items():
            low, high = item.bounds
            lines.append(
                f"| `{name}` | {item.unit or '1'} | {absent_at(effect, name)} | {item.typical:g} "
                f"| {low:g} to {high:g} | {item.says}{anew(item)} |"
            )
        lines.append("")
    return "\n".join(lines)


if __name__ == "__main__":
    page = Path(__file__).with_name("effects.md")
    page.write_text(with_chapter(page.read_text(encoding="utf-8")), encoding="utf-8")
