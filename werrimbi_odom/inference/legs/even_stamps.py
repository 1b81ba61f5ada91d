# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Stamps that say when a message came, and not when counters were read, or a lidar turned.

A driver reads its counters by a timer; over a serial line or radio the messages then come two at a
time, or late. Wheels turn evenly from one reading to the next, so the counts tell which it was: if
they lie on a line by the number of their message, and not by its stamp, the stamps are put right.
A lidar turns as evenly as a timer: of its scans the path that they give tells the same.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter, uniform_filter1d

from werrimbi_odom.files.run import Reference, Run
from werrimbi_odom.inference.rules import (
    EVEN_HALF_BASE,
    EVEN_HOLE,
    EVEN_LEAST,
    EVEN_MESSAGES,
    EVEN_MOST,
    EVEN_SHARE,
    EVEN_SURE,
    EVEN_TOGETHER,
    EVEN_WINDOW,
)
from werrimbi_odom.model.encoder import Counts
from werrimbi_odom.model.pose import Floats


def evened(
    time: Floats,
    left: Counts,
    right: Counts,
    lost: NDArray[np.intp] | None = None,
    least: float = EVEN_LEAST,
) -> Floats:
    """When the counters were read, if a timer read them; else the stamps as they are.

    Parameters
    ----------
    time : ndarray, shape (n,)
        Stamps [s].
    left, right : ndarray, shape (n,)
        Cumulative counts.
    lost : ndarray, shape (n - 1,), optional
        How many messages are missing between two; none where not given.
    least : float
        Share of the time between two messages that stamps must be off to be put right.

    Returns
    -------
    ndarray, shape (n,)
        Ascending [s]. What all stamps are late by together stays in it: that is a delay, and found
        as one.
    """
    if time.size < EVEN_MESSAGES or not (np.diff(time) >= 0.0).all():
        return time
    first = ~_told_again(time, left, right)
    row = np.cumsum(first) - 1
    stamps, number = time[first], np.arange(float(row[-1] + 1))
    if lost is not None:
        number[1:] += np.cumsum(lost)[first[1:]]
    if stamps.size <= EVEN_WINDOW or not _by_timer(stamps, number, left[first], right[first]):
        return time
    even, period = _numbered(stamps, number)
    tenth = 0.1 * period * number  # none is read before the one before it
    read = (np.maximum.accumulate(even - tenth) + tenth)[row]
    return np.asarray(read) if np.std(read - time) > least * period else time


def stamped_together(run: Run) -> bool:
    """Whether a reference's stamps are late when the wheels' are, as where one packet brings both.

    Then each is late against the other by nothing, and wheels put right alone would err.
    """
    time = run.ticks.time
    late = time - evened(time, run.ticks.left, run.ticks.right)
    if run.reference is None or run.reference.time.size <= EVEN_WINDOW or not late.any():
        return False
    seen = np.asarray(run.reference.time, dtype=np.float64)
    own = seen - _numbered(seen, np.arange(float(seen.size)))[0]
    both = np.interp(seen, time, late), own
    if not all(part.any() for part in both):
        return False
    return bool(np.corrcoef(*both)[0, 1] > EVEN_TOGETHER)


def evened_scans(reference: Reference) -> Reference:
    """The same, with scans where their lidar turned, if their path is even by number alone.

    Of any other reference nothing is known of a timer, and its stamps stay; so they do where a
    gyro's headings were laid upon the scans, at the stamps that these had.
    """
    seen = reference.has_position & reference.has_yaw
    if not reference.own_axes or reference.gyro is not None or not seen.all():
        return reference
    turn = np.diff(np.unwrap(reference.yaw))
    axis = np.exp(-1j * (reference.yaw[:-1] + 0.5 * turn))
    forth = ((np.diff(reference.x) + 1j * np.diff(reference.y)) * axis).real
    left, right = (
        np.concatenate([[0.0], np.cumsum(forth + side * EVEN_HALF_BASE * turn)])
        for side in (-1.0, 1.0)
    )
    time = np.asarray(reference.time, dtype=np.float64)
    if time.size < EVEN_MESSAGES:
        return reference
    even = evened(time, left, right, _lost(time, left, right))
    # Beyond that they are not numbered rightly: too many are missing.
    late = float(np.std(even - time)) > EVEN_MOST * float(np.median(np.diff(time)))
    return reference if even is time or late else replace(reference, time=even)


def _lost(time: Floats, left: Floats, right: Floats) -> NDArray[np.intp]:
    """Scans that are missing: across the hole it goes as far as in several steps beside it."""
    interval = np.diff(time)
    step = 0.5 * (np.abs(np.diff(left)) + np.abs(np.diff(right)))
    wide = np.pad(step, 2, mode="edge")
    beside = 0.5 * np.maximum(wide[:-4] + wide[1:-3], wide[3:-1] + wide[4:])
    drives = beside > 0.5 * float(np.median(step))
    times = np.divide(step, beside, out=np.ones_like(step), where=drives)
    holes = (times > EVEN_HOLE) & (interval > np.median(interval))
    return np.where(holes, np.rint(times).astype(np.intp) - 1, 0)


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


def _numbered(stamps: Floats, number: Floats) -> tuple[Floats, float]:
    """When messages that a timer sends were sent, by their numbers [s], and its period."""
    apart = number[EVEN_WINDOW:] - number[:-EVEN_WINDOW]
    period = float(np.median((stamps[EVEN_WINDOW:] - stamps[:-EVEN_WINDOW]) / apart))
    even = period * number
    late = median_filter(stamps - even, EVEN_WINDOW, mode="reflect")  # a pause is a step of it
    off = np.clip(stamps - even - late, -period, period)
    return even + late + uniform_filter1d(off, EVEN_WINDOW, mode="reflect"), period


def _by_timer(time: Floats, number: Floats, left: Counts, right: Counts) -> bool:
    """Whether counts lie where the number of their message has them, and not where its stamp has.

    How far a count is off the line of its neighbours by number, over how far it should be if its
    stamp were right, is 1 where stamps are right and 0 where a timer read it (least squares). A
    robot that speeds up puts counts off the line as well, but not as the stamps go.
    """
    by_stamp, by_number = _before(time), _before(number)
    off, told = [], []
    for counts in (left, right):
        whole, half = counts[2:] - counts[:-2], counts[1:-1] - counts[:-2]
        size = np.abs(whole)
        usual = np.median(size[size > 0.0]) if (size > 0.0).any() else 0.0
        turns = (size > 0.0) & (size < 20.0 * usual)  # and no counter that wraps or leaps
        turns &= np.isfinite(half)
        off.append((half - by_number * whole)[turns])
        told.append(((by_stamp - by_number) * whole)[turns])
    said, by_stamps = np.concatenate(off), np.concatenate(told)
    if said.size < EVEN_MESSAGES or not by_stamps.any():
        return False
    follows = float(said @ by_stamps / (by_stamps @ by_stamps))
    rest = (said - follows * by_stamps) * by_stamps
    std = float(np.sqrt(rest @ rest) / (by_stamps @ by_stamps))
    return abs(follows) + EVEN_SURE * std < EVEN_SHARE


def _before(place: Floats) -> Floats:
    """Of the way from each one's neighbour before it to that after it, the share up to it."""
    step = np.diff(place)
    both = step[:-1] + step[1:]
    share = np.full(both.size, 0.5)
    np.divide(step[:-1], both, out=share, where=both > 0.0)
    return share
