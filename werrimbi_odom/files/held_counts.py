# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Counts that are repeated until the next reading: logged oftener than the counter was read."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.run import Run
from werrimbi_odom.model.encoder_online import Counts
from werrimbi_odom.model.pose import Floats

STEP = 4
"""Counts of a step that a rolling wheel does not make between two rows without any: its own counts
would have to stop and start again within three rows."""
ROWS = 4
"""Rows that a reading may be repeated in."""
ALIKE = 4.0
"""Factor within which the steps before and after are alike: a counter that wraps steps further."""
FEWEST, SHARE = 20, 0.1
"""Such rows, and their share of those in which the wheel turns: a few are readings that failed."""


def without_held_counts(run: Run) -> Run:
    """Counts between two readings instead of the first of them again, wheel by wheel.

    A log with a row for each message of either wheel repeats the other's last count: taken as
    measured, the robot would turn to and fro from row to row. Unchanged if no counter was held.
    """
    ticks = run.ticks
    held = [_held(counts) for counts in (ticks.left, ticks.right)]
    if not any(rows.any() for rows in held):
        return run
    left, right = (
        _between(ticks.time, counts, rows)
        for counts, rows in zip((ticks.left, ticks.right), held, strict=True)
    )
    names = zip(("left", "right"), held, strict=True)
    told = " and ".join(f"{rows.sum()} of the {name}" for name, rows in names if rows.any())
    words = (
        f"of {ticks.time.size} counts {told} wheel repeat the one before between steps of several "
        "counts: they are taken for held, not read, and lie between their neighbours now"
    )
    return replace(run, ticks=replace(ticks, left=left, right=right), damage=(*run.damage, words))


def _held(counts: Counts) -> NDArray[np.bool_]:
    """Rows between two steps of the same sense and about the same size, shape (n,)."""
    held = np.zeros(counts.size, dtype=np.bool_)
    steps = np.diff(counts).astype(np.float64)
    moved = np.flatnonzero(steps)  # NaN counts as a step, and is alike to none
    size, sense = np.abs(steps[moved]), np.sign(steps[moved])
    apart = np.diff(moved) - 1
    with np.errstate(invalid="ignore"):
        alike = (np.minimum(size[1:], size[:-1]) >= STEP) & (sense[1:] == sense[:-1])
        alike &= np.maximum(size[1:], size[:-1]) <= ALIKE * np.minimum(size[1:], size[:-1])
    between = np.flatnonzero(alike & (apart > 0) & (apart <= ROWS))
    for row in range(1, ROWS + 1):
        here = between[apart[between] >= row]
        held[moved[here] + 1 + row] = True
    turning = int(np.count_nonzero(size >= STEP)) + int(held.sum())
    if held.sum() < max(FEWEST, SHARE * turning):
        held[:] = False
    return held


def _between(time: Floats, counts: Counts, held: NDArray[np.bool_]) -> Counts:
    """Whole counts at the held rows, on the line between the readings around them."""
    if not held.any():
        return counts
    read = np.flatnonzero(~held)
    rows = np.flatnonzero(held)
    after = np.searchsorted(read, rows)
    before, after = read[after - 1], read[after]
    span = time[after] - time[before]
    part = np.where(span > 0.0, (time[rows] - time[before]) / np.where(span > 0.0, span, 1.0), 0.0)
    found = counts.copy()
    steps = np.rint(np.clip(part, 0.0, 1.0) * (counts[after] - counts[before]))
    found[rows] = counts[before] + steps.astype(counts.dtype)
    return found
