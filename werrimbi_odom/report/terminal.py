# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A document as text of 80 columns, without rich, which a robot may not have."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable

from werrimbi_odom.report.document import Definition, Document, Part, Table

_WIDTH = 80
_COMMAND = "    "


def printed(document: Document) -> str:
    """Words and tables as text."""
    return as_text([*document.words, *document.tables])


def as_text(parts: Iterable[Part]) -> str:
    """Parts as text, with empty lines around tables."""
    lines: list[str] = []
    after_table = False
    for part in parts:
        table = isinstance(part, Table)
        if lines and (table or after_table or (not isinstance(part, Table) and part.apart)):
            lines.append("")
        lines.append(_as_text(part))
        after_table = table
    return "\n".join(lines)


def _as_text(part: Part) -> str:
    if isinstance(part, Definition):
        return f"  {part.term}\n{_filled(part.says, '    ', '    ')}"
    if isinstance(part, Table):
        lines = _columns(part) if part.heads else _pairs(part)
        rest = [f"  {part.rest}"] if part.rest else []
        return "\n".join([part.title, *lines, *rest])
    if part.kind in ("command", "code"):
        return textwrap.indent(part.text, _COMMAND if part.kind == "command" else "")
    point = part.kind == "point"
    return _filled(part.text, "- " if point else "", "  " if point or part.hanging else "")


def _filled(text: str, first: str, others: str, width: int = _WIDTH) -> str:
    return textwrap.fill(
        text,
        width,
        initial_indent=first,
        subsequent_indent=others,
        break_long_words=False,
        break_on_hyphens=False,
    )


def _columns(table: Table) -> list[str]:
    """Table with the first column left aligned, the others right aligned."""
    widths = [max(map(len, column)) for column in zip(table.heads, *table.rows, strict=True)]
    lines = []
    for row in (table.heads, *table.rows):
        cells = [row[0].ljust(widths[0])]
        cells += [cell.rjust(width) for cell, width in zip(row[1:], widths[1:], strict=True)]
        lines.append(("  " + "  ".join(cells)).rstrip())
    return lines


def _pairs(table: Table) -> list[str]:
    """Names on the left, their descriptions on the right, wrapped."""
    width = max(len(name) for name, _ in table.rows) + 4
    return [
        _filled(words, f"  {name}".ljust(width), " " * width, max(_WIDTH, width + 40))
        for name, words in table.rows
    ]
