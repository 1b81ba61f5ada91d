# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Cells of a table that are not usable: several are told at once, with what mends them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from werrimbi_odom.errors import InputError

NUMBER = re.compile(
    r"\s*[+-]?((\d+\.?\d*|\.\d+)(e[+-]?\d+)?|inf|infinity|nan)\s*\Z", re.IGNORECASE | re.ASCII
)
"""A cell with a number in it."""

MOST = 5
"""Cells that are told one by one."""


class BadCell(NamedTuple):
    """A cell that is not usable, or a row."""

    place: str
    """Line and column."""
    fault: str
    mend: str = ""


def refuse(path: Path, found: Iterable[BadCell]) -> None:
    """Raise on bad cells: the first ones, and the number of the others; nothing for none.

    A mend that several have in a row is told once, behind the first.
    """
    told: list[str] = []
    before, more = "", 0
    for cell in found:
        if len(told) == MOST:
            more += 1
            continue
        mend = f"; {cell.mend}" if cell.mend and cell.mend != before else ""
        told.append(f"{cell.place}: {cell.fault}{mend}")
        before = cell.mend
    if told:
        rest = f"; and {more} more like these" if more else ""
        raise InputError(f"{path}, {'; '.join(told)}{rest}")


def bad_cells(
    rows: Callable[[], Iterator[tuple[int, list[str]]]],
    names: Sequence[str],
    required: Sequence[str],
) -> Iterator[BadCell]:
    """Find cells that are no numbers, and rows of another length than their header.

    `rows`: yields line number and cells of each row. Of a column of text that is not required the
    first cell alone is told.
    """
    of_text: set[str] = set()
    remark = None
    for number, cells in rows():
        place = f"line {number}"
        if [cell.strip() for cell in cells] == list(names):
            begun = "the column names again: the log was begun anew there"
            yield BadCell(place, begun, "make a run of each part, with the names as its first line")
            continue
        for name, cell in zip(names, cells, strict=False):
            if name in of_text or not cell.strip() or NUMBER.match(cell):
                continue
            mend, text = "leave the cell empty where there is none", cell.strip()
            if name not in required:
                of_text.add(name)
                mend += "; leave a column of text out"
            shown = text if len(text) <= 40 else f"{text[:40]}..."
            yield BadCell(f"{place}, column {name}", f"{shown!r} is not a number", mend)
        if len(cells) != len(names):
            remark = _in_all_rows(rows(), names) if remark is None else remark
            yield BadCell(place, f"{len(cells)} cells under {len(names)} columns{remark}")
            if remark:
                return


def _in_all_rows(rows: Iterator[tuple[int, list[str]]], names: Sequence[str]) -> str:
    """Remark on a header that fits no row."""
    counts = {len(cells) for _, cells in rows}
    if len(counts) > 1:
        return ""
    few = min(counts) < len(names)
    return (
        f", as in all rows: {'one that it names was not written' if few else 'one has no name'}, "
        "so the others may not stand under their names"
    )
