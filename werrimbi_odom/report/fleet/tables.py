# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A fleet as a table, a robot a row: on the terminal, and on a page."""

from __future__ import annotations

import html
from io import StringIO

from werrimbi_odom.report.fleet.rows import ERROR, Fleet, Row
from werrimbi_odom.report.fleet.words import error_words, missing_words, next_words
from werrimbi_odom.report.text import table

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
        from rich.table import Table
        from rich.text import Text
    except ModuleNotFoundError:
        return table(
            "The robots", HEADS, [[" ".join(cell.split()) for cell in row] for row in rows]
        )
    made = Table(box=box.SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, 0), expand=True)
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


def fleet_table_html(fleet: Fleet) -> str:
    """The same for a page, whole."""
    heads = "".join(f'<th scope="col"{_class(at)}>{head}</th>' for at, head in enumerate(HEADS))
    body = "".join(
        "<tr>"
        + "".join(
            f'<th scope="row">{_lines(cell)}</th>'
            if at == _ROBOT
            else f"<td{_class(at)}>{_lines(cell)}</td>"
            for at, cell in enumerate(cells(row, whole=True))
        )
        + "</tr>"
        for row in fleet.rows
    )
    return (
        f'<div class="wide"><table><thead><tr>{heads}</tr></thead>'
        f"<tbody>{body}</tbody></table></div>"
    )


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


def _class(at: int) -> str:
    return "" if at in _RIGHT else ' class="words"'


def _lines(cell: str) -> str:
    """Escaped; an indented line stays so."""
    kept = (line.replace("  ", "\N{NO-BREAK SPACE}" * 3) for line in cell.splitlines())
    return "<br>".join(map(html.escape, kept))
