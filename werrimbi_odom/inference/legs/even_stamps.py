# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Restore stamps that tell when a message arrived, not when counters were read or a lidar turned.

A driver reads its counters by a timer. Over a serial line or radio, messages then arrive in pairs
or late. Wheels turn evenly between readings, so the counts show which stamp is right: if counts are
linear in the message number rather than in the stamp, stamps are replaced by the timer's. Messages
may also queue up for seconds before a busy program takes them, and then come all at once: a timer
pauses now and then, but does not catch up. A lidar turns as evenly as a timer, and the path from
its scans shows the same.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter, uniform_filter1d

from werrimbi_odom.files.run import Reference, Run
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.distributions import fisher_survival
from werrimbi_odom.inference.legs.lost_messages import lost_messages
from werrimbi_odom.inference.legs.queued_messages import (
    period_of,
    queued_messages,
    read_before,
    travel_of_steps,
)
from werrimbi_odom.model.encoder_online import Counts
from werrimbi_odom.model.pose import Floats


def with_even_stamps(
    time: Floats,
    left: Counts,
    right: Counts,
    lost: NDArray[np.intp] | None = None,
    least: float = rules.EVEN_LEAST,
) -> Floats:
    """Estimate when a timer read the counters; return the stamps unchanged if no timer did.

    `time` (n,): stamps [s]. `left`, `right` (n,): cumulative counts. `lost` (n - 1,): number of
    missing messages between neighbours; by default as `lost_messages` finds them. `least`: stamps
    are corrected only if the correction exceeds this share of the message interval. Result (n,):
    ascending times [s]. A delay common to all stamps remains; it is estimated as such.
    """
    if time.size < rules.EVEN_MESSAGES or not (np.diff(time) >= 0.0).all():
        return time
    first = ~_told_again(time, left, right)
    row = np.cumsum(first) - 1
    stamps = time[first]
    if stamps.size <= rules.EVEN_WINDOW:
        return time
    number = np.arange(float(stamps.size))
    number[1:] += np.cumsum(
        lost_messages(stamps, left[first], right[first]) if lost is None else lost[first[1:]]
    )
    if not _by_timer(stamps, number, left[first], right[first]):
        return time
    queued = queued_messages(stamps, number)
    if not read_before(stamps, left[first], right[first], queued > 0.0):
        queued = np.zeros_like(stamps)
    even, period = _numbered(stamps - queued, number)
    off = stamps - queued - even
    if float(np.std(off)) > rules.EVEN_SPREAD * period:
        return time
    # Delays of their own scatter intervals by root 2 as much. If what is put right is more, numbers
    # are wrong by more than the delays; each by a period, whereas a queue without an end is longer.
    off = np.clip(off, -period, period)
    if np.std(off) > np.std(np.diff(off)):
        return time
    tenth = 0.1 * period * number  # keeps readings in order
    read = np.maximum.accumulate(even - tenth) + tenth
    if not _by_timer(stamps, read, left[first], right[first]):
        return time
    read = read[row]
    return np.asarray(read) if np.std(read - time) > least * period else time


def stamped_together(run: Run) -> bool:
    """Whether stamps of reference and wheels are late together, as when one packet brings both.

    Their relative delay is then zero, and correcting the wheels alone would introduce an error.
    """
    time = run.ticks.time
    late = time - with_even_stamps(time, run.ticks.left, run.ticks.right)
    if run.reference is None or run.reference.time.size <= rules.EVEN_WINDOW or not late.any():
        return False
    seen = np.asarray(run.reference.time, dtype=np.float64)
    number = np.arange(float(seen.size))
    queued = queued_messages(seen, number)
    own = seen - _numbered(seen - queued, number)[0]
    seldom, often = (time, seen) if seen.size > time.size else (seen, time)
    # What has nothing in common is a quarter of an interval from the nearest.
    chance = min(np.std(late), 0.25 * np.median(np.diff(often)))
    if _apart(seldom, often) < rules.EVEN_ONE_PACKET * chance:
        return True
    both = np.interp(seen, time, late), own
    if not all(part.any() for part in both):
        return False
    return bool(np.corrcoef(*both)[0, 1] > rules.EVEN_TOGETHER)


def _apart(seldom: Floats, often: Floats) -> float:
    """Typical distance of stamps from the nearest of others, but for a constant one [s]."""
    sent = _sent(seldom, often)
    after = np.clip(np.searchsorted(often, sent), 1, often.size - 1)
    return float(
        np.median(np.minimum(np.abs(sent - often[after - 1]), np.abs(sent - often[after])))
    )


def in_packets_of(run: Run, seen: Reference) -> Reference:
    """Put scans that come with the wheels back by as much as the wheels, if nothing else did.

    One packet has one delay: wheels that were corrected alone would disagree with the scans by all
    of it.
    """
    ticks = run.ticks
    if seen is not run.reference or not seen.own_axes or seen.gyro is not None:
        return seen
    read = with_even_stamps(ticks.time, ticks.left, ticks.right, least=rules.EVEN_LEAST_TOGETHER)
    late = np.interp(_sent(seen.time, ticks.time), ticks.time, ticks.time - read)
    return replace(seen, time=seen.time - late) if late.any() else seen


def _sent(seen: Floats, time: Floats) -> Floats:
    """Stamps of the packets that bring poses: a scan's pose is that of its middle, some time on."""
    before = time[np.maximum(np.searchsorted(time, seen, "right") - 1, 0)]
    return np.asarray(seen - np.median(seen - before))


def with_even_scan_stamps(reference: Reference) -> Reference:
    """Put scan stamps where the lidar turned, if the scan-matched path is even in the scan number.

    For any other reference no timer is known, and its stamps stay. They also stay where gyro
    headings were combined with the scans at the original stamps.
    """
    seen = reference.has_position & reference.has_yaw
    if not reference.own_axes or reference.gyro is not None or not seen.all():
        return reference
    turn = np.diff(np.unwrap(reference.yaw))
    axis = np.exp(-1j * (reference.yaw[:-1] + 0.5 * turn))
    forth = ((np.diff(reference.x) + 1j * np.diff(reference.y)) * axis).real
    left, right = (
        np.concatenate([[0.0], np.cumsum(forth + side * rules.EVEN_HALF_BASE * turn)])
        for side in (-1.0, 1.0)
    )
    time = np.asarray(reference.time, dtype=np.float64)
    if time.size < rules.EVEN_MESSAGES:
        return reference
    even = with_even_stamps(time, left, right, _lost_scans(time, left, right))
    # A larger correction means the numbering is wrong: too many scans are missing.
    late = float(np.std(even - time)) > rules.EVEN_MOST * float(np.median(np.diff(time)))
    return reference if even is time or late else replace(reference, time=even)


def _lost_scans(time: Floats, left: Floats, right: Floats) -> NDArray[np.intp]:
    """Count missing scans: holes in which the robot moves several times a neighbouring step."""
    interval = np.diff(time)
    step = travel_of_steps(left, right)
    wide = np.pad(step, 2, mode="edge")
    beside = 0.5 * np.maximum(wide[:-4] + wide[1:-3], wide[3:-1] + wide[4:])
    drives = beside > 0.5 * float(np.median(step))
    times = np.divide(step, beside, out=np.ones_like(step), where=drives)
    holes = (times > rules.EVEN_HOLE) & (interval > np.median(interval))
    return np.where(holes, np.rint(times).astype(np.intp) - 1, 0)


def _told_again(time: Floats, left: Counts, right: Counts) -> NDArray[np.bool_]:
    """Rows that repeat the one before, as where a slow counter is written with each scan.

    Readings of a standing robot are equal as well, so the test only uses rows in motion.
    """
    together = np.append(False, np.diff(time) == 0.0)
    moved = np.append(False, (np.diff(left) != 0.0) | (np.diff(right) != 0.0))
    drives = (np.convolve(moved, np.ones(5), "same") > 0.0) & together
    again = together & ~moved
    mostly = (again & drives).sum() > (drives & ~again).sum()
    return np.asarray(again & bool(mostly))


def _numbered(stamps: Floats, number: Floats) -> tuple[Floats, float]:
    """Send times of messages that a timer sends, from their numbers [s], and the timer's period."""
    period = period_of(stamps, number)
    even = period * number
    late = median_filter(
        stamps - even, rules.EVEN_WINDOW, mode="reflect"
    )  # a pause is a step in it
    off = np.clip(stamps - even - late, -period, period)
    line = np.polyval(np.polyfit(number, late + off, 1), number)
    if _keeps_pace(late + off - line):
        return even + line, period
    return even + late + uniform_filter1d(off, rules.EVEN_WINDOW, mode="reflect"), period


def _keeps_pace(off: Floats) -> bool:
    """Whether deviations from one pace, (n,), are those of single stamps, by analysis of variance.

    The means of windows then scatter as chance has it: more where messages wait for one another
    and neighbours are late together (variance inflation of a first-order autoregression). Two
    clocks that drift apart, a pause and a computer that was busy for seconds show there.
    """
    count = off.size // rules.EVEN_WINDOW
    if count < rules.EVEN_WINDOWS:
        return False
    windows = off[: count * rules.EVEN_WINDOW].reshape(count, -1)
    within = float(np.mean(np.var(windows, axis=1, ddof=1)))
    inner = windows - windows.mean(axis=1, keepdims=True)
    lag = float(np.mean(inner[:, 1:] * inner[:, :-1])) / max(float(np.mean(inner**2)), 1e-30)
    lag = max(lag + 1.0 / rules.EVEN_WINDOW, 0.0)
    within *= (1.0 + lag) / (1.0 - lag)
    between = rules.EVEN_WINDOW * float(np.sum(windows.mean(axis=1) ** 2)) / (count - 2)
    spare = count * (rules.EVEN_WINDOW - 1)
    chance = fisher_survival(between / max(within, 1e-30), count - 2, spare)
    return chance > rules.SURE_WHEN_ASKED


def _by_timer(time: Floats, number: Floats, left: Counts, right: Counts) -> bool:
    """Whether counts are linear in the message number, and not in the stamp.

    The deviation of a count from linear interpolation by number is regressed on the deviation
    predicted if its stamp were right. The slope is 1 if stamps are right and 0 if a timer read the
    counters. Acceleration adds deviations too, but these are not correlated with the stamps.
    """
    by_stamp, by_number = _before(time), _before(number)
    off, told = [], []
    for counts in (left, right):
        whole, half = counts[2:] - counts[:-2], counts[1:-1] - counts[:-2]
        size = np.abs(whole)
        usual = np.median(size[size > 0.0]) if (size > 0.0).any() else 0.0
        turns = (size > 0.0) & (size < 20.0 * usual)  # excludes wraps and jumps of a counter
        turns &= np.isfinite(half)
        off.append((half - by_number * whole)[turns])
        told.append(((by_stamp - by_number) * whole)[turns])
    said, by_stamps = np.concatenate(off), np.concatenate(told)
    if said.size < rules.EVEN_MESSAGES or not by_stamps.any():
        return False
    follows = float(said @ by_stamps / (by_stamps @ by_stamps))
    rest = (said - follows * by_stamps) * by_stamps
    std = float(np.sqrt(rest @ rest) / (by_stamps @ by_stamps))
    return abs(follows) + rules.EVEN_SURE * std < rules.EVEN_SHARE


def _before(place: Floats) -> Floats:
    """Share of the interval between both neighbours that lies before each element."""
    step = np.diff(place)
    both = step[:-1] + step[1:]
    share = np.full(both.size, 0.5)
    np.divide(step[:-1], both, out=share, where=both > 0.0)
    return share
