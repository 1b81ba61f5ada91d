# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""RESULTS.csv: manual measurements, one row per run; errors name line and column."""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.tables.bad_cells import BadCell, refuse
from werrimbi_odom.files.text_files import read_small_text
from werrimbi_odom.model.pose import Floats


@dataclass(frozen=True)
class ResultsTable:
    """Rows of a table; `words` is empty without a column of words."""

    numbers: Floats
    """Shape (n, columns)."""
    words: tuple[str, ...]


def read_results(
    path: str | Path,
    numbers: Sequence[str],
    *,
    word: str | None = None,
    choices: Sequence[str] = (),
) -> ResultsTable:
    """Read the named columns of a comma-separated table with a header line.

    Other columns, empty lines, and lines that begin with `#` are ignored. `numbers`: columns of
    finite numbers. `word`, `choices`: a column with one of these words, in any case. InputError
    names file, line, column, and the remedy.
    """
    path = Path(path)
    wanted = [*([word] if word else []), *numbers]
    header: list[str] = []
    rows, words, bad = [], [], list[BadCell]()
    for line, cells in _lines(path):
        if not header:
            header = cells
            missing = [name for name in wanted if name not in header]
            if missing:
                raise InputError(
                    f"{path}, line {line}: the header must hold {','.join(wanted)}; "
                    f"{', '.join(missing)} is missing, it says {','.join(cells)[:200]!r}"
                )
            twice = [name for name in wanted if header.count(name) > 1]
            if twice:
                raise InputError(f"{path}, line {line}: the column {twice[0]} is there twice")
            continue
        if len(cells) != len(header):
            fault = f"{len(cells)} cells where the header has {len(header)}"
            bad.append(BadCell(f"line {line}", fault, "separate by commas, and decimals by points"))
            continue
        row = dict(zip(header, cells, strict=True))
        faults = {word: _not_a_word(row[word], choices)} if word else {}
        faults |= {name: _not_measured(row[name]) for name in numbers}
        bad += [BadCell(f"line {line}, column {name}", *one) for name, one in faults.items() if one]
        if not any(faults.values()):
            words += [row[word].lower()] if word else []
            rows.append([float(row[name]) for name in numbers])
    refuse(path, bad)
    if not header:
        raise InputError(f"{path} is empty; its first line must be {','.join(wanted)}")
    return ResultsTable(np.array(rows, dtype=np.float64).reshape(-1, len(numbers)), tuple(words))


def _lines(path: Path) -> list[tuple[int, list[str]]]:
    """Number and cells of every line with content."""
    found = []
    text = read_small_text(
        path, wanted="it must be a CSV file", too_large="that was not typed by hand"
    )
    reader = csv.reader(text.splitlines(), skipinitialspace=True, strict=True)
    try:
        for cells in reader:
            stripped = [cell.strip() for cell in cells]
            if any(stripped) and not stripped[0].startswith("#"):
                found.append((reader.line_num, stripped))
    except csv.Error as error:
        raise InputError(f"{path}, line {reader.line_num}: {error}") from error
    return found


def _not_measured(cell: str) -> tuple[str, ...]:
    """What is wrong with a number, and what to do; empty if nothing is."""
    try:
        value = float(cell)
    except ValueError:
        return (f"{cell[:40]!r} is not a number such as -0.094",)
    return (
        () if math.isfinite(value) else (f"{cell!r} is no measurement", "leave the whole row out")
    )


def _not_a_word(cell: str, choices: Sequence[str]) -> tuple[str, ...]:
    return () if cell.lower() in choices else (f"{cell[:40]!r} must be {' or '.join(choices)}",)
