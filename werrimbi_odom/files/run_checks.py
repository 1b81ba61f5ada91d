# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Checks whether a run can be evaluated; lists what was worked around."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.references.held_poses import these_runs, words_about_held
from werrimbi_odom.files.run import WORKED_OUT, Reference, Run, Ticks
from werrimbi_odom.files.tables.mislabelled_columns import refuse_wrong_columns
from werrimbi_odom.files.tables.row_order import FEW_STEPS_BACK, began_anew, clock_was_set_back
from werrimbi_odom.files.tables.units_of_time import words_about_one_clock_unit
from werrimbi_odom.model.encoder_online import CLOCK_JUMP
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

REVERSED = 0.9
"""Share of steps back in time from which rows are taken for reversed; shuffled ones have half."""
LEAP = 1e7
"""Step forward of the times [s], and in usual intervals if these are longer, from which on a clock
was set: no recording pauses for four months."""
APART = 5.0
"""Largest time between reference and ticks that a search for the delay covers [s]
(docs/set_up.md)."""


def refuse_unjudgeable(run: Run, robot: Robot) -> None:
    """Check that there is a reference to compare with, overlapping in time, and what columns hold.

    InputError if there is no reference, it lies entirely before or after the ticks, either goes
    back in time, or a column holds something else than its name says.
    """
    if run.reference is None:
        raise InputError(
            f"{run.path}: there is no reference to compare with {run.no_reference}; --reference "
            "gives another recording that holds it"
        )
    _refuse_reversed(run, "the ticks go", run.ticks.time)
    _refuse_reversed(run, "the reference goes", run.reference.time)
    _refuse_back(run, "the ticks go", run.ticks.time)
    if clock_was_set_back(run.reference):
        _refuse_back(run, "the reference goes", run.reference.time)
    _refuse_leap(run, run.reference)
    if words := words_about_one_clock_unit(run.ticks, run.reference):
        raise InputError(f"{run.path}: {words}")
    _refuse_apart(run, run.reference)
    refuse_wrong_columns(run, robot)


def words_about(runs: Sequence[Run]) -> list[str]:
    """What was left out of some runs, or worked out from something else, one line each."""
    found = [f"{run.path}: {words}" for run in runs for words in run.damage]
    for run in runs:
        lost = ~(np.isfinite(run.ticks.left) & np.isfinite(run.ticks.right))
        if lost.any():
            first = float(run.ticks.time[int(lost.argmax())])
            found.append(
                f"{run.path}: {int(lost.sum())} of {run.ticks.rows} rows of ticks are not finite, "
                f"the first at t_s {first:.10g}; they are left out"
            )
    for gives, words in WORKED_OUT.items():
        if some := [run for run in runs if run.wheels_from == gives]:
            found.append(f"{these_runs(some)}: {words}")
    held = words_about_held(runs)
    return found if held is None else [*found, held]


def _refuse_reversed(run: Run, what: str, time: Floats) -> None:
    steps = np.diff(time)
    back = int((steps < 0.0).sum())
    if back and back >= REVERSED * np.count_nonzero(steps):
        raise InputError(
            f"{run.path}: {what} back in time in {back} of {time.size} rows: the last row comes "
            "first; sort the rows by t_s (or t_s holds something else than times)"
        )


def _refuse_back(run: Run, what: str, time: Floats) -> None:
    latest = np.maximum.accumulate(time)
    back = np.flatnonzero(np.diff(time) < -CLOCK_JUMP)
    if back.size == 0:
        return
    row = int(back[0]) + 1
    where = (
        f"{run.path}: {what} back in time {_times(int(back.size))}first in row {row + 1} of "
        f"{time.size}, from t_s {latest[row - 1]:.10g} to {time[row]:.10g}"
    )
    bits, period = began_anew(time, back)
    if bits:
        again = ", and as much again at each further one" if back.size > 1 else ""
        raise InputError(
            f"{where}: a clock of {bits} bits began anew there: add {period:.10g} to t_s from "
            f"that row on{again}"
        )
    if back.size > FEW_STEPS_BACK:
        raise InputError(f"{where}: the rows are not in the order of time; sort them by t_s")
    raise InputError(f"{where}: the clock was set back; cut the run there into two")


def _refuse_leap(run: Run, reference: Reference) -> None:
    """Raise if the clock was set forward, as where a robot gets the date from a network."""
    (begin, end), (first, last) = _span(run.ticks), _span(reference)
    time = run.ticks.time
    time = time[(time >= max(begin, first)) & (time <= min(end, last))]
    steps = np.diff(time)
    if steps.size and steps.max() > LEAP * max(1.0, float(np.median(steps))):
        row = int(steps.argmax())
        raise InputError(
            f"{run.path}: the times of the ticks leap from t_s {time[row]:.10g} to "
            f"{time[row + 1]:.10g}: the clock was set forward; cut the run there into two"
        )


def _times(count: int) -> str:
    return "" if count == 1 else f"{count} times, "


def _refuse_apart(run: Run, reference: Reference) -> None:
    ticks = _span(run.ticks)
    measured = _span(reference)
    early, late = ticks[0] - measured[1], measured[0] - ticks[1]
    if max(early, late) <= APART:
        return
    word, by = ("before", early) if early > late else ("after", late)
    raise InputError(
        f"{run.path}: the reference (t_s {span_in_words(reference)}) lies wholly {word} the ticks "
        f"({span_in_words(run.ticks)}), by {by:.6g} s; both need one clock, in seconds (if "
        "both began with one drive, count each from its first row; else it is another drive's)"
    )


def _span(of: Reference | Ticks) -> tuple[float, float]:
    return float(of.time.min()), float(of.time.max())


def span_in_words(of: Reference | Ticks) -> str:
    """First and last stamp."""
    return "{:.14g} to {:.14g}".format(*_span(of))
