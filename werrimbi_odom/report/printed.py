# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Plain text as it is printed: filled sentences, and tables; `page_text` makes HTML of it."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

WIDTH = 80
"""Columns that printed words are filled to."""


def filled(text: str, *, hanging: bool = False) -> str:
    """A paragraph; what begins with "- " hangs, and others on request."""
    return textwrap.fill(
        text,
        WIDTH,
        subsequent_indent="  " if hanging or text.startswith("- ") else "",
        break_long_words=False,
        break_on_hyphens=False,
    )


def pairs(title: str, rows: Sequence[tuple[str, str]]) -> str:
    """Names to the left, values to the right of them, filled."""
    width = max(len(name) for name, _ in rows) + 4
    lines = [
        textwrap.fill(
            value,
            max(WIDTH, width + 40),
            initial_indent=f"  {name}".ljust(width),
            subsequent_indent=" " * width,
            break_long_words=False,
            break_on_hyphens=False,
        )
        for name, value in rows
    ]
    return "\n".join([title, *lines])


def table(title: str, heads: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """First column to the left, the others to the right, two blanks between."""
    columns = list(zip(heads, *rows, strict=True))
    widths = [max(map(len, column)) for column in columns]
    lines = [title]
    for row in (heads, *rows):
        cells = [row[0].ljust(widths[0])]
        cells += [cell.rjust(width) for cell, width in zip(row[1:], widths[1:], strict=True)]
        lines.append(("  " + "  ".join(cells)).rstrip())
    return "\n".join(lines)
