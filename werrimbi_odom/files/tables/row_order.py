# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Rows of a reference that are not in the order of time."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.run import Reference
from werrimbi_odom.model.encoder_online import CLOCK_JUMP
from werrimbi_odom.model.pose import Floats

FEW_STEPS_BACK = 3
"""More steps back in time than this are unsorted rows and not a clock set back."""
CLOCKS = tuple((bits, unit) for bits in (32, 16) for unit in (1.0, 1e-3, 1e-6))
"""Bits of a board's clock, and what t_s has for each of its ticks: as it is, or milliseconds or
microseconds as seconds."""
WRAPS_WITHIN = 5.0
"""Usual intervals of rows by which the step back may be off: a message may be late or lost."""
WRAPS_SHARE = 0.1
"""Share of the period that these may be: rows in no order step back by anything."""


def in_order(reference: Reference) -> tuple[Reference, str]:
    """The reference with its rows sorted by time, and in words what that changed; "" if nothing.

    Rows that step back by less than a second may be late, and stay; so do those of a clock that was
    set back, as their order by time is not that in which they were measured.
    """
    if not (np.diff(reference.time) < -CLOCK_JUMP).any() or clock_was_set_back(reference):
        return reference, ""
    told = "its rows are not in the order of time; they are sorted by t_s"
    return reference.chosen(np.argsort(reference.time, kind="stable")), told


def clock_was_set_back(reference: Reference) -> bool:
    """Whether its clock began anew, or a few steps back in time lead into what was measured.

    Parts in another order do not (the positions of a drive, then its headings), nor does one row
    with a wrong time.
    """
    back = np.flatnonzero(np.diff(reference.time) < -CLOCK_JUMP)
    if not 0 < back.size <= FEW_STEPS_BACK:
        return False
    if began_anew(reference.time, back)[0] or reference.time.size == 2:  # two rows show no order
        return True
    measures = reference.has_position + 2 * reference.has_yaw
    rows = np.arange(reference.time.size)
    return any(
        _overlap(
            reference.time[first[measures[first] == kind]],
            reference.time[then[measures[then] == kind]],
        )
        for first, then in itertools.pairwise(np.split(rows, back + 1))
        for kind in np.unique(measures)
    )


def _overlap(one: Floats, other: Floats) -> bool:
    """Whether two rows of each of two parts are within the times of the other."""
    return _within(one, other) > 1 and _within(other, one) > 1


def _within(one: Floats, other: Floats) -> int:
    if not one.size or not other.size:
        return 0
    inside: NDArray[np.bool_] = (one >= other.min()) & (one <= other.max())
    return int(inside.sum())


def began_anew(time: Floats, back: NDArray[np.intp]) -> tuple[int, float]:
    """Bits and period of the clock that began anew at some rows; zeros if none did."""
    for bits, unit in CLOCKS:
        if _begins_anew(np.diff(time), back, period := unit * 2.0**bits):
            return bits, period
    return 0, 0.0


def _begins_anew(steps: Floats, back: NDArray[np.intp], period: float) -> bool:
    """Whether steps back are those of a clock that begins anew after a period."""
    if not (steps > 0.0).any():
        return False
    usual = float(np.median(steps[steps > 0.0]))
    within = WRAPS_WITHIN * usual
    off = np.abs(period + steps[back] - usual)
    return bool(within < WRAPS_SHARE * period and (off <= within).all())
