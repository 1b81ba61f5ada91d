# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Stamps of ticks that say when a message came, and not when the counters were read.

A driver reads its counters by a timer; over a serial line or radio the messages then come two at a
time, or late. Wheels turn evenly from one reading to the next, so the counts tell which it was: if
they lie on a line by the number of their message, and not by its stamp, the stamps are put right.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter, uniform_filter1d

from werrimbi_odom.inference.rules import EVEN_LEAST, EVEN_MESSAGES, EVEN_SHARE, EVEN_WINDOW
from werrimbi_odom.model.encoder import Counts
from werrimbi_odom.model.pose import Floats


def evened(time: Floats, left: Counts, right: Counts) -> Floats:
    """When the counters were read, if a timer read them; else the stamps as they are.

    Parameters
    ----------
    time : ndarray, shape (n,)
        Stamps [s].
    left, right : ndarray, shape (n,)
        Cumulative counts.

    Returns
    -------
    ndarray, shape (n,)
        Ascending [s]. What all stamps are late by together stays in it: that is a delay, and found
        as one.
    """
    if time.size < EVEN_MESSAGES or not (np.diff(time) >= 0.0).all():
        return time
    first = ~_told_again(time, left, right)
    stamps, number = time[first], np.cumsum(first) - 1
    by_stamp, by_number = _unevenness(stamps, left[first], right[first])
    if not by_number < EVEN_SHARE * by_stamp:
        return time
    period = float(np.median(stamps[EVEN_WINDOW:] - stamps[:-EVEN_WINDOW])) / EVEN_WINDOW
    even = period * np.arange(stamps.size)
    late = median_filter(stamps - even, EVEN_WINDOW, mode="reflect")  # a pause is a step of it
    off = np.clip(stamps - even - late, -period, period)
    late += uniform_filter1d(off, EVEN_WINDOW, mode="reflect")
    least = 0.1 * even  # none is read before the one before it
    read = (np.maximum.accumulate(even + late - least) + least)[number]
    return np.asarray(read) if np.std(read - time) > EVEN_LEAST * period else time


def _told_again(time: Floats, left: Counts, right: Counts) -> NDArray[np.bool_]:
    """Which rows are the one before once more, as where a slow counter is written with each scan.

    Of a robot that stands two readings are alike as well; so it is asked of one that drives.
    """
    together = np.append(False, np.diff(time) == 0.0)
    moved = np.append(False, (np.diff(left) != 0.0) | (np.diff(right) != 0.0))
    drives = (np.convolve(moved, np.ones(5), "same") > 0.0) & together
    again = together & ~moved
    mostly = (again & drives).sum() > (drives & ~again).sum()
    return np.asarray(again & bool(mostly))


def _unevenness(time: Floats, left: Counts, right: Counts) -> tuple[float, float]:
    """How far counts are off the line of their neighbours, by stamps and by numbers (rms)."""
    step = np.diff(time)
    both = step[:-1] + step[1:]
    share = np.divide(step[:-1], both, out=np.full(both.size, 0.5), where=both > 0.0)
    off: list[list[Floats]] = [[], []]
    for counts in (left, right):
        whole, half = counts[2:] - counts[:-2], counts[1:-1] - counts[:-2]
        size = np.abs(whole)
        usual = np.median(size[size > 0.0]) if (size > 0.0).any() else 0.0
        turns = (size > 0.0) & (size < 20.0 * usual)  # and no counter that wraps or leaps
        for kept, part in zip(off, (share, 0.5), strict=True):
            kept.append((half - part * whole)[turns])
    stamped, numbered = (np.concatenate(kept) for kept in off)
    if stamped.size < EVEN_MESSAGES:
        return 0.0, 0.0
    return float(np.sqrt(np.mean(stamped**2))), float(np.sqrt(np.mean(numbered**2)))
