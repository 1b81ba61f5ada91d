# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A fleet as a table, a robot a row: on the terminal, and on a page."""

from __future__ import annotations

from io import StringIO

from werrimbi_odom.report.document import Table
from werrimbi_odom.report.fleet.rows import ERROR, Fleet, Row
from werrimbi_odom.report.fleet.words import error_words, missing_words, next_words
from werrimbi_odom.report.terminal import as_text

HEADS = ("robot", "runs", "verdict", "what is missing", "held-out error [mm]", "next step")
_ROBOT, _RUNS, _VERDICT, _MISSING, _ERROR, _NEXT = range(len(HEADS))
_RIGHT = (_RUNS, _ERROR)
_MOST = 20
"""Columns for names on the terminal; longer ones go on in the next line."""


def fleet_table(fleet: Fleet, width: int = 100) -> str:
    """The table as text that fits into `width` columns; without rich in long lines."""
    rows = [cells(row) for row in fleet.rows]
    try:
        from rich import box
        from rich.console import Console
        from rich.table import Table as Grid
        from rich.text import Text
    except ModuleNotFoundError:
        plain = [[" ".join(cell.split()) for cell in row] for row in rows]
        return as_text([Table("The robots", HEADS, plain)])
    made = Grid(box=box.SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, 0), expand=True)
    for number, head in enumerate(HEADS):
        made.add_column(
            Text(head.replace(" error", "\nerror")),
            justify="right" if number in _RIGHT else "left",
            overflow="fold",
            no_wrap=number == _VERDICT,
            max_width=_MOST if number in (_ROBOT, _NEXT) else None,
            ratio=1 if number == _MISSING else None,
        )
    for cut in rows:
        made.add_row(*map(Text, cut))
    written = StringIO()
    Console(file=written, width=width, color_system=None, legacy_windows=False).print(made)
    lines = written.getvalue().splitlines()
    return "\n".join(line.rstrip() for line in lines if line.strip())


def robots_table(fleet: Fleet) -> Table:
    """The same for a page, whole."""
    words = [at for at in range(1, len(HEADS)) if at not in _RIGHT]
    return Table("", HEADS, [cells(row, whole=True) for row in fleet.rows], words)


def cells(row: Row, *, whole: bool = False) -> list[str]:
    """The cells of a robot; line breaks part its effects.

    Parameters
    ----------
    whole
        Errors in full, for a page; the terminal tells them above its table.
    """
    missing = "\n".join(missing_words(row))
    error, then = error_words(row), next_words(row)
    if whole:
        error = error.replace(" ", "\N{NO-BREAK SPACE}")
    if row.verdict == ERROR:
        missing, then = (row.error, "") if whole else ("could not be diagnosed", "see above")
    return [row.robot, str(row.runs), row.verdict, missing, error, then]
