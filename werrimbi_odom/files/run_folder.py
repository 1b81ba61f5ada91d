# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Runs as a folder with ticks.csv and, optionally, reference.csv: read and written."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.bags.stamps import newest_of_bursts
from werrimbi_odom.files.references.course_headings import without_course
from werrimbi_odom.files.references.interpolated_poses import without_interpolated
from werrimbi_odom.files.references.own_headings import words_about_own_headings
from werrimbi_odom.files.references.separate_headings import one_kind_of_row
from werrimbi_odom.files.run import EXACT, Reference, Run, Ticks, counts_of
from werrimbi_odom.files.tables.csv_table import CsvTable, read_table
from werrimbi_odom.files.tables.row_order import in_order
from werrimbi_odom.files.text_files import readable, replacing
from werrimbi_odom.model.encoder_online import Counts
from werrimbi_odom.model.pose import Floats

TICKS = "ticks.csv"
TICKS_COLUMNS = ("t_s", "left_ticks", "right_ticks")
REFERENCE = "reference.csv"
REFERENCE_COLUMNS = ("t_s", "x_m", "y_m", "yaw_rad")
FEWEST_WHOLE, SELDOM = 20, 10.0
"""Rows whose times are all whole seconds and are taken for rounded, and the interval [s] from which
that matters little."""
UNSIGNED = (2.0**63, 2.0**64)
"""Range in which only counters of 64 bits without a sign come; there floats are 2048 apart."""
LATEST = 1e12
"""Upper limit of a time in seconds [s]; Unix time in milliseconds or nanoseconds exceeds it."""
SIGMA_COLUMNS = ("sigma_xy_m", "sigma_yaw_rad")
OF_PART = (
    {"t_s", "x_m", "y_m"},
    {"t_s", "x_m", "y_m", "sigma_xy_m"},
    {"t_s", "yaw_rad"},
    {"t_s", "yaw_rad", "sigma_yaw_rad"},
)
"""Headers of references that measure positions alone, or headings alone."""


def read_run_folder(path: str | Path) -> Run:
    """Read a run folder.

    InputError if a file is not usable; the message names file, line and column, of both files.
    """
    path = Path(path)
    file = path / REFERENCE
    reference, more, wrong = None, tuple[str, ...](), list[str]()
    try:
        ticks, damage = _ticks(path / TICKS)
    except InputError as error:
        wrong.append(str(error))
    try:
        if file.exists() or file.is_symlink():
            reference, more = read_reference(file)
    except InputError as error:
        wrong.append(str(error))
    if wrong:
        raise InputError("; and ".join(wrong))
    damage += more
    return Run(
        readable(path.resolve().name),
        path,
        ticks,
        reference,
        damage=damage,
        no_reference=f"({REFERENCE}: {','.join(REFERENCE_COLUMNS)})",
    )


def write_run_folder(path: Path, ticks: Ticks, reference: Reference | None) -> Path:
    """Write a run folder, to be read again without loss; stated sigmas are left out.

    InputError if it exists, or cannot be written, or a channel has no name for a column.
    """
    names = (*TICKS_COLUMNS, *ticks.channels)
    for name in ticks.channels:
        if names.count(name) > 1 or name != name.strip() or not name or set(name) & set(',"\r\n'):
            raise InputError(
                f"{path}: a channel cannot be called {name!r}: a column has a name of its own, "
                "without commas, quotes and line ends"
            )
    try:
        path.mkdir(parents=True)
        if reference is not None:  # first: what is left of a full disk is then no run without it
            poses = (reference.time, reference.x, reference.y, reference.yaw)
            _write(path / REFERENCE, REFERENCE_COLUMNS, poses, missing="")
        counts = (ticks.time, ticks.left, ticks.right, *ticks.channels.values())
        _write(path / TICKS, names, counts)
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}; a new folder is wanted") from error
    return path


def _write(
    path: Path, names: Sequence[str], columns: Sequence[Counts], missing: str = "nan"
) -> None:
    rows = zip(*(values.tolist() for values in columns), strict=True)
    lines = [",".join(missing if each != each else repr(each) for each in row) for row in rows]
    with replacing(path) as file:
        file.write("\n".join([",".join(names), *lines, ""]))


def _cut(table: CsvTable) -> tuple[str, ...]:
    """Remark on a file that ends in mid-row, as after a power failure."""
    if not table.cut:
        return ()
    return (f"{table.path.name}, line {table.cut}: cut off in mid-row; read up to there",)


def _ticks(path: Path) -> tuple[Ticks, tuple[str, ...]]:
    table = read_table(path, TICKS_COLUMNS, TICKS_COLUMNS)
    channels = {name: table.column(name) for name in table.names if name not in TICKS_COLUMNS}
    empty = [name for name in TICKS_COLUMNS[1:] if np.isnan(table.column(name)).any()]
    table.refuse_where({**_wrong_times(table), **dict.fromkeys(empty, _not_a_count)})
    times = table.column("t_s")
    left, right = (_counts(table, name) for name in TICKS_COLUMNS[1:])
    whole = _whole_seconds(times)
    told = (f"{path.name}: {whole}",) if whole else ()
    return Ticks(times, left, right, channels), (*_cut(table), *told)


def _whole_seconds(times: Floats) -> str:
    """Remark on times without a fraction, as `int(time.time())` writes them; "" for others."""
    if times.size < FEWEST_WHOLE or not (times == np.rint(times)).all():
        return ""
    if float(np.median(np.abs(np.diff(times)))) >= SELDOM:
        return ""
    return (
        "all its times are whole seconds; if they were rounded, each is off by up to one, and "
        "delays and short legs tell no more than that: write all their digits"
    )


def _wrong_times(table: CsvTable) -> dict[str, Callable[[str], str]]:
    """What is wrong with stamps, if any is: a row without one is an error."""
    return {} if (np.abs(table.column("t_s")) < LATEST).all() else {"t_s": _not_a_time}


def _not_a_time(text: str) -> str:
    if not text:
        return "it is empty; every row needs its time: fill it in, or leave the row out"
    value = float(text)
    if not math.isfinite(value):
        return f"{text!r} is not a time; leave the row out"
    return "" if abs(value) < LATEST else f"{text!r} is not a time in seconds; is it in ns, or ms?"


def _counts(table: CsvTable, name: str) -> Counts:
    """Counters; `nan` and `inf` mark failed readings, which the model counts."""
    values = table.column(name)
    counts = counts_of(values)
    if np.isfinite(values).all() and np.abs(values).max() >= EXACT:
        exact = table.integers(name)
        return counts if exact is None else exact
    if ((values >= UNSIGNED[0]) & (values <= UNSIGNED[1])).any():
        table.refuse_where({name: _not_a_whole_count})
    return counts


def _not_a_count(text: str) -> str:
    return "" if text else "it is empty; write nan where a reading is missing, or leave the row out"


def _not_a_whole_count(text: str) -> str:
    if math.isfinite(float(text)):
        return ""
    return (
        f"{text!r} is no count; leave the row out: counters of 64 bits without a sign are exact "
        "where all rows are whole numbers"
    )


def read_reference(path: Path) -> tuple[Reference, tuple[str, ...]]:
    """A reference, and in words the damage of its file and the rows that are left out.

    InputError if it is not usable; the message names file, line and column.
    """
    table = read_table(path, REFERENCE_COLUMNS, REFERENCE_COLUMNS[:1], OF_PART)
    for name in table.names:
        if name.startswith("sigma") and name not in SIGMA_COLUMNS:
            known = " and ".join(SIGMA_COLUMNS)
            raise InputError(f"{path}, line 1: unknown column {name}; there are {known}")
    wrong = _wrong_times(table)
    for name in (*REFERENCE_COLUMNS[1:], *SIGMA_COLUMNS):
        values, least = table.column(name), 0.0 if name in SIGMA_COLUMNS else -math.inf
        if np.isinf(values).any() or (values < least).any():
            wrong[name] = partial(_not_measured, minimum=least)
    table.refuse_where(wrong)
    sigmas = [table.column(name) if name in table.names else None for name in SIGMA_COLUMNS]
    poses = [table.column(name) for name in REFERENCE_COLUMNS]
    reference, was_sorted = in_order(Reference(*poses, *sigmas))
    reference, course = without_course(reference)
    reckoned = words_about_own_headings(reference)
    if not (reference.has_position | reference.has_yaw).any():
        raise _nothing_measured(table)
    whole = _whole_seconds(reference.time)
    reference, resampled = without_interpolated(reference)
    keep, late = _on_time(reference)
    reference, alike = one_kind_of_row(reference if keep.all() else reference.chosen(keep))
    told = (*late, was_sorted, reckoned, course, resampled, whole, alike)
    return reference, (*_cut(table), *(f"{path.name}: {each}" for each in told if each))


def _on_time(reference: Reference) -> tuple[NDArray[np.bool_], list[str]]:
    """Rows that are not stamped late, and what was left out, in words.

    Rows of positions and rows of headings may share their stamps, so each are judged by themselves.
    """
    keep, told = np.ones(reference.time.size, dtype=np.bool_), []
    measured = reference.has_position + 2 * reference.has_yaw
    for kind in np.unique(measured):
        own = measured == kind
        keep[own], left_out = newest_of_bursts(reference.time[own])
        told += [f"of its rows {left_out}"] if left_out else []
    return keep, told


def _nothing_measured(table: CsvTable) -> InputError:
    names = REFERENCE_COLUMNS[1:]
    empty = [name for name in names if np.isnan(table.column(name)).all()]
    *others, last = empty if len(empty) > 1 else names
    return InputError(
        f"{table.path}: {', '.join(others)} and {last} are empty in all {len(table.values)} rows: "
        "nothing is measured; fill in x_m and y_m, or yaw_rad where headings alone were measured"
    )


def _not_measured(text: str, minimum: float) -> str:
    value = float(text or "nan")
    if math.isinf(value):
        return f"{text!r} cannot be measured; leave the cell empty where nothing was"
    return f"{text!r} must not be less than {minimum:g}" if value < minimum else ""
