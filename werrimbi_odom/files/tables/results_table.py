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
    rows, words = [], []
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
            raise InputError(
                f"{path}, line {line}: {len(cells)} cells where the header has {len(header)}; "
                "separate by commas, and decimals by points"
            )
        row = dict(zip(header, cells, strict=True))
        if word:
            words.append(_word(row[word], f"{path}, line {line}, column {word}", choices))
        rows.append([_number(row[name], f"{path}, line {line}, column {name}") for name in numbers])
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


def _number(cell: str, place: str) -> float:
    try:
        value = float(cell)
    except ValueError:
        raise InputError(f"{place}: {cell[:40]!r} is not a number such as -0.094") from None
    if not math.isfinite(value):
        raise InputError(f"{place}: {cell!r} is no measurement; leave the whole row out")
    return value


def _word(cell: str, place: str, choices: Sequence[str]) -> str:
    if cell.lower() not in choices:
        raise InputError(f"{place}: {cell[:40]!r} must be {' or '.join(choices)}")
    return cell.lower()
