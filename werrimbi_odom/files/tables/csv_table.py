# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Numeric tables from CSV: fast for valid files, with exact locations in error messages."""

from __future__ import annotations

import csv
import itertools
import re
import warnings
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.tables.bad_cells import NUMBER, BadCell, bad_cells, refuse
from werrimbi_odom.files.tables.column_names import perhaps_meant
from werrimbi_odom.files.text_files import reading
from werrimbi_odom.model.pose import Floats

MAX_BYTES = 2**30
MAX_ROWS = 20_000_000
"""Five and a half hours at 1 kHz; such a run's arrays still fit an ordinary memory."""
MAX_COLUMNS = 256
MAX_LINE = 2**20
"""Bytes."""
_FLOAT = np.dtype(np.float64)

_BLANK = re.compile(r'[\s,"]*\Z')
"""A line with no value in it."""
_EMPTY = re.compile(r'(?<=,)[^\S\n]*(?:"")?[^\S\n]*(?=,|\n|\Z)|\A[^\S\n]*(?:"")?[^\S\n]*(?=,)')
"""Empty cells of a line."""
_BEFORE_QUOTE = re.compile(r'(?<=,)[ \t]+(?=")')
"""Blanks in front of a cell in quotes."""


@dataclass(frozen=True)
class CsvTable:
    """Columns of a CSV file; empty cells are NaN, and so is all of a column that is not there."""

    path: Path
    names: tuple[str, ...]
    values: Floats
    """Shape (rows, columns); at least one row."""
    cut: int = 0
    """Number of the last line, if it is truncated and therefore skipped; else 0."""

    def column(self, name: str) -> Floats:
        """The column with this name."""
        if name not in self.names:
            return np.full(len(self.values), np.nan)
        return np.ascontiguousarray(self.values[:, self.names.index(name)])

    def integers(self, name: str) -> NDArray[np.int64] | None:
        """A column as exact integers beyond the range of floats; None if it has other values.

        Of integers without a sign, the upper half stands for those below zero.
        """
        for whole in ("i8", "u8"):
            kinds = [(str(i), whole if item == name else "f8") for i, item in enumerate(self.names)]
            with suppress(ValueError):
                rows = _loaded(_lines(self.path, self.cut), np.dtype(kinds))
                return np.ascontiguousarray(rows[str(self.names.index(name))]).view(np.int64)
        return None

    def refuse_where(self, wrong: Mapping[str, Callable[[str], str]]) -> None:
        """Raise on the invalid cells of some columns, with their lines and columns.

        `wrong`: for each column, a function that takes a cell's text and returns what is wrong with
        it and, behind a semicolon, what to do; "" if nothing is wrong.
        """
        places = [(name, self.names.index(name), fault_of) for name, fault_of in wrong.items()]
        refuse(
            self.path,
            (
                BadCell(f"line {line}, column {name}", *complaint.split("; ", 1))
                for line, cells in (_rows(self.path, self.cut) if places else ())
                for name, place, fault_of in places
                if (complaint := fault_of(cells[place].strip()))
            ),
        )


def read_table(
    path: Path,
    required: Sequence[str],
    filled: Sequence[str],
    enough: Sequence[Collection[str]] = (),
) -> CsvTable:
    """Read a CSV file of numbers whose first line names the columns, in any order.

    An incomplete last line without a line end (from a power failure) is skipped. `filled`: columns
    without empty cells. `enough`: headers that will do without the other columns that are required;
    under any further name these might be meant. InputError if the file is not valid; the message
    names line, column and content.
    """
    with reading(path, "it must be a CSV file"):
        try:
            _refuse_too_large(path)
            names = _header(path, required, filled, enough)
            cut = _cut_line(path, names, [names.index(name) for name in filled])
            return CsvTable(path, names, _values(path, names, cut, required), cut)
        except UnicodeDecodeError:
            raise _not_text(path) from None


def _refuse_too_large(path: Path) -> None:
    """Raise on files that would exceed the memory limit."""
    lines = 0
    with path.open("rb") as file:
        while block := file.read(MAX_LINE):
            ends = block.count(b"\n") or block.count(b"\r")
            lines += ends
            if not ends and len(block) == MAX_LINE:
                raise InputError(f"{path}, line {lines + 1} is longer than {MAX_LINE:,} bytes")
            if lines > MAX_ROWS or file.tell() > MAX_BYTES:
                raise InputError(
                    f"{path} has more than {MAX_ROWS:,} rows or {MAX_BYTES:,} bytes; "
                    "cut the run into several"
                )


def _header(
    path: Path,
    required: Sequence[str],
    filled: Sequence[str],
    enough: Sequence[Collection[str]],
) -> tuple[str, ...]:
    wanted = ",".join(required)
    with path.open(encoding="utf-8-sig", newline=None) as file:
        line, row = file.readline(65536), file.readline(65536)
    if not line:
        raise InputError(f"{path} is empty; its first line must be {wanted}")
    # numpy.savetxt writes the names as a remark.
    names = tuple(name.strip() for name in next(_cells(line.lstrip("#% ")), []))
    place = f"{path}, line 1"
    missing = [name for name in required if name not in names]
    if missing and set(names) not in map(set, enough):
        if all(NUMBER.match(name) for name in names):
            raise InputError(f"{place}: there is no header; the first line must be {wanted}")
        if line.lstrip()[:1] in ("#", "%"):
            raise InputError(
                f"{place} is a remark, {line.strip()[:200]!r}; leave such lines out: the first "
                f"line must be {wanted}, and columns be separated by commas"
            )
        if len(names) == 1 and len(re.split(r"[;\s]+", names[0])) > 1:
            points = "write a point for each comma in its numbers, " if "," in row else ""
            raise InputError(
                f"{place}: the columns are not separated by commas; {points}separate them so, and "
                f"the first line must be {wanted}"
            )
        held = line.strip()[:200]
        raise InputError(
            f"{place}: no column {', '.join(missing)}; the header is {held!r}; write these names "
            f"into it in place of its own{perhaps_meant(missing, names)}, and bring the values to "
            f"the units that they name{_may_be_empty(set(missing) - set(filled))}"
        )
    if len(names) > MAX_COLUMNS:
        raise InputError(f"{place}: {len(names)} columns are more than {MAX_COLUMNS}")
    for number, name in enumerate(names):
        if not name:
            raise InputError(f"{place}: column {number + 1} has no name")
        if name in names[:number]:
            raise InputError(f"{place}: the column {name} is there twice")
    return names


def _may_be_empty(names: Collection[str]) -> str:
    """What to do where nothing was measured for some columns."""
    if not names:
        return ""
    which = "its cells" if len(names) == 1 else "the cells of what was not measured"
    return f"; {which} may be empty, but the name must be there"


def _cut_line(path: Path, names: Sequence[str], filled: Sequence[int]) -> int:
    """Number of the last line if it is truncated, else 0."""
    with path.open("rb") as file:
        size = file.seek(0, 2)
        file.seek(max(size - MAX_LINE, 0))
        end = file.read()
    last = re.split(rb"[\r\n]", end)[-1].decode("utf-8", "replace")
    if not last.strip():
        return 0
    cells = last.split(",")
    whole = len(cells) == len(names) and all(
        NUMBER.match(cell.strip().strip('"')) or not cell.strip() for cell in cells
    )
    if whole and all(cells[place].strip() for place in filled):
        return 0
    with path.open(encoding="utf-8-sig", errors="replace", newline=None) as file:
        lines = sum(1 for _ in file)
    return lines if lines > 2 else 0  # only a header and no complete row: there is nothing to read


def _values(path: Path, names: Sequence[str], cut: int, required: Sequence[str]) -> Floats:
    try:
        try:
            # numpy reads a named file in blocks, twice as fast as from an iterator of lines
            values = _loaded(_lines(path, cut) if cut else str(path.absolute()), _FLOAT)
        except ValueError:
            values = _loaded(_lines(path, cut), _FLOAT)
        if values.size and values.shape[1] == len(names):
            return np.asarray(values, dtype=np.float64)
    except UnicodeDecodeError:
        raise
    except ValueError as error:
        _refuse_bad_row(path, names, cut, required)
        raise InputError(f"{path} cannot be read: {error}") from error
    _refuse_bad_row(path, names, cut, required)
    raise InputError(f"{path} has a header and no rows")


def _loaded(source: Any, kind: np.dtype[Any]) -> NDArray[Any]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # no data: handled by the caller
        warnings.simplefilter("error", DeprecationWarning)  # 1.0 read as an integer
        values: NDArray[Any] = np.loadtxt(
            source,
            dtype=kind,
            comments=None,
            delimiter=",",
            skiprows=1,
            ndmin=1 if kind.names else 2,
            encoding="utf-8-sig",
            quotechar='"',
        )
    return values


def _lines(path: Path, cut: int) -> Iterator[str]:
    """Yield lines with `nan` in empty cells; skip lines without a value and the truncated one."""
    with path.open(encoding="utf-8-sig", newline=None) as file:
        for line in itertools.islice(file, cut - 1 if cut else None):
            if not _BLANK.match(line):
                yield _EMPTY.sub("nan", _BEFORE_QUOTE.sub("", line))


def _cells(line: str) -> Iterator[list[str]]:
    return csv.reader([_BEFORE_QUOTE.sub("", line)])


def _rows(path: Path, cut: int) -> Iterator[tuple[int, list[str]]]:
    """Yield line number, from 1, and cells of each row below the header."""
    with path.open(encoding="utf-8-sig", newline=None) as file:
        for number, line in enumerate(itertools.islice(file, 1, cut - 1 if cut else None), start=2):
            if not _BLANK.match(line):
                yield number, next(_cells(line.rstrip("\n")))


def _refuse_bad_row(path: Path, names: Sequence[str], cut: int, required: Sequence[str]) -> None:
    try:
        refuse(path, bad_cells(lambda: _rows(path, cut), names, required))
    except csv.Error as error:
        raise InputError(f"{path} cannot be read: {error}") from error


def _not_text(path: Path) -> InputError:
    with path.open("rb") as file:
        for number, line in enumerate(file, start=1):
            try:
                line.decode("utf-8")
            except UnicodeDecodeError as error:
                byte = line[error.start]
                return InputError(f"{path}, line {number}: byte 0x{byte:02x} is not UTF-8 text")
    return InputError(f"{path} is not UTF-8 text")
