# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Poses on the line between two others: resampled to a faster clock, not measured.

So does a script that brings a reference to the times of its counters, and a tracker that carries
its last pose on by its last speed. Taken as measured they cut the robot's bends short, and err
alike from row to row.
"""

from __future__ import annotations

import numpy as np

from werrimbi_odom.files.run import Reference
from werrimbi_odom.model.pose import Floats, wrap_all

FEWEST = 20
"""Corners that must be seen: fewer poses were taken by hand."""
ON_LINE = 0.3
"""Share of the rows that must lie on the line between their neighbours: of a reference brought to
thrice its rate a third does, if no row is at a time of its own. Of measured poses that err by two
digits a tenth does, by chance."""
ALONE = 0.8
"""Share of the corners that must be single rows, or two where the measured pose is between them. In
a bend the poses of a simulator that measures without noise all are corners."""
SHARP = 5.0
"""Typical size of a corner, in last digits. Chosen: the rounding of three rows makes one digit, and
noise that makes five leaves one row in fifty on the line in position and heading."""
DIGITS = 9
"""Decimal places beyond which a difference is the rounding of floating-point numbers."""


def without_interpolated(reference: Reference) -> tuple[Reference, str]:
    """Leave out the poses that others were resampled to; and what was done, in words.

    Unchanged, without words, unless corners come one by one between rows that lie on straight lines
    to the last digit, in all that was measured.
    """
    bends = _bends(reference)
    if bends is None:
        return reference, ""
    size: Floats = np.abs(bends).max(axis=0)
    corner = size > 1.0
    moves = np.isfinite(size)
    begin = np.flatnonzero(corner & ~np.concatenate([[False], corner[:-1]]))
    end = np.flatnonzero(corner & ~np.concatenate([corner[1:], [False]]))
    single = end - begin <= 1
    if (
        begin.size < FEWEST
        or (moves & ~corner).sum() < ON_LINE * moves.sum()
        or single.mean() < ALONE
        or float(np.median(np.maximum(size[begin], size[end]))) < SHARP
    ):
        return reference, ""
    keep = corner.copy()
    for first, last in zip(begin[single], end[single], strict=True):
        if first == last:
            continue
        # Two corners with one measured pose between: the nearer one. Where they bend to opposite
        # sides the reference leapt from what it was carried on to, to what it measured.
        leapt = float(bends[:, first] @ bends[:, last]) < 0.0
        keep[first if leapt or size[last] >= size[first] else last] = False
    keep = np.concatenate([[True], keep, [True]])
    return reference.chosen(keep), (
        f"{np.count_nonzero(~keep)} of its {keep.size} rows lie on the line between their "
        "neighbours to the last digit, from corner to corner: they are taken for interpolated, or "
        "carried on, not measured, and left out"
    )


def _bends(reference: Reference) -> Floats | None:
    """By how much each row but the first and last is off the line between its neighbours.

    In last digits (the most that rounding makes is one) of what was measured, shape (k, n - 2); NaN
    where no row moved. None if nothing was measured in all rows, or stamps repeat.
    """
    time = reference.time
    if time.size < 2 * FEWEST or (np.diff(time) <= 0.0).any():
        return None
    before, after = np.diff(time)[:-1], np.diff(time)[1:]
    share = before / (before + after)
    found, moved = [], np.zeros(time.size - 2, dtype=np.bool_)
    for values, steps in (
        (reference.x, np.diff(reference.x)),
        (reference.y, np.diff(reference.y)),
        (reference.yaw, wrap_all(np.diff(reference.yaw))),
    ):
        if not np.isfinite(values).all():
            continue
        digit = last_digit(values)
        found.append(((1.0 - share) * steps[:-1] - share * steps[1:]) / digit)
        moved |= np.maximum(np.abs(steps[:-1]), np.abs(steps[1:])) > digit
    return np.where(moved, np.stack(found), np.nan) if found else None


def last_digit(values: Floats) -> float:
    """Unit of the last decimal place in which some values are written."""
    places = next(
        (
            place
            for place in range(DIGITS)
            if (np.abs(values - np.round(values, place)) < 0.5 * 10.0**-DIGITS).all()
        ),
        DIGITS,
    )
    return float(10.0**-places)
