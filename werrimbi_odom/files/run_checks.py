# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Whether a run can be judged at all, said with what is there; and what was got over."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.repeated_poses import words_about_held
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.model.encoder import CLOCK_JUMP

FEW_STEPS_BACK = 3
"""A clock is set back now and then; rows that are not sorted go back again and again."""
APART = 5.0
"""Seconds by which a reference may lie beside the ticks and be found again (docs/set_up.md)."""


def refuse_unjudgeable(run: Run) -> None:
    """Whether there is something to compare the odometry with, at the same time.

    Raises
    ------
    InputError
        When there is no reference, it lies wholly before or after the ticks, or the ticks go back
        in time.
    """
    if run.reference is None:
        raise InputError(f"{run.path}: there is no reference to compare with {run.no_reference}")
    _refuse_back(run)
    _refuse_apart(run, run.reference)


def words_about(runs: Sequence[Run]) -> list[str]:
    """What of some runs was left out, a line each."""
    found = [f"{run.path}: {words}" for run in runs for words in run.damage]
    for run in runs:
        lost = ~(np.isfinite(run.ticks.left) & np.isfinite(run.ticks.right))
        if lost.any():
            first = float(run.ticks.time[int(lost.argmax())])
            found.append(
                f"{run.path}: {int(lost.sum())} of {run.ticks.rows} rows of ticks are not finite, "
                f"the first at t_s {first:.10g}; they are left out"
            )
    held = words_about_held(runs)
    return found if held is None else [*found, held]


def _refuse_back(run: Run) -> None:
    time = run.ticks.time
    latest = np.maximum.accumulate(time)
    back = np.flatnonzero(np.diff(time) < -CLOCK_JUMP)
    if back.size == 0:
        return
    row = int(back[0]) + 1
    where = (
        f"{run.path}: the ticks go back in time {_times(int(back.size))}first in row {row + 1} of "
        f"{run.ticks.rows}, from t_s {latest[row - 1]:.10g} to {time[row]:.10g}"
    )
    if back.size > FEW_STEPS_BACK:
        raise InputError(f"{where}: the rows are not in the order of time; sort them by t_s")
    raise InputError(f"{where}: the clock was set back; cut the run there into two")


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
        f"{run.path}: the reference (t_s {_told(measured)}) lies wholly {word} the ticks "
        f"({_told(ticks)}), by {by:.6g} s; both need one clock, in seconds"
    )


def _span(of: Reference | Ticks) -> tuple[float, float]:
    return float(of.time.min()), float(of.time.max())


def _told(span: tuple[float, float]) -> str:
    return f"{span[0]:.14g} to {span[1]:.14g}"
