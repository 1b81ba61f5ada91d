# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Figures on the terminal: names to the left, values to the right."""

from __future__ import annotations

from collections.abc import Sequence


def print_figures(title: str, rows: Sequence[tuple[str, str]]) -> None:
    """Print a table of two columns; without rich (a robot may not have it) in plain text."""
    try:
        from rich.console import Console
        from rich.table import Table
        from rich.text import Text
    except ModuleNotFoundError:
        width = max(len(name) for name, _ in rows)
        print("\n".join([title, *(f"  {name:{width}}  {value}" for name, value in rows)]))
        return

    class Piped(Console):
        def on_broken_pipe(self) -> None:
            raise BrokenPipeError  # rich would end the process; main() does that, with its own code

    table = Table(title=Text(title), title_justify="left", show_header=False)
    for name, value in rows:
        table.add_row(Text(name, style="bold"), Text(value))
    Piped().print(table)
