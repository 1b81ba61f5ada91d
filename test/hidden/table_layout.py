# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A table, for the terminal and for docs/evidence.md."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class Table:
    """A title, what the columns are, and rows of cells."""

    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    words: str = ""
    """Before it."""

    def markdown(self) -> str:
        """For the docs."""
        head = [self.columns, tuple("---" for _ in self.columns)]
        lines = ["| " + " | ".join(row) + " |" for row in (*head, *self.rows)]
        words = [self.words, ""] if self.words else []
        return "\n".join([f"## {self.title}", "", *words, *lines, ""])


def show(tables: Iterable[Table], write: Callable[[object], None]) -> None:
    """On the terminal."""
    from rich.markup import escape
    from rich.table import Table as Shown

    for table in tables:
        shown = Shown(*table.columns, title=table.title, title_justify="left")
        for row in table.rows:
            shown.add_row(*map(escape, row))
        write(shown)
