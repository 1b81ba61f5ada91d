# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Find messages that waited in a queue before a busy program took them, and for how long."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_propagation, median_filter, minimum_filter1d

from werrimbi_odom.inference import rules
from werrimbi_odom.model.encoder_online import Counts
from werrimbi_odom.model.pose import Floats


def last_of_packets(time: Floats) -> NDArray[np.intp]:
    """Rows that end a packet of several that were sent at once; all rows if there is none.

    The last was read when it was sent, and the others before. Of a clock that stands still now and
    then the first is right; most rows share their stamp with another only where they were packed.
    Packets that are stamped as they arrive, by one row after another, have stamps next to each
    other. Pairs of these are put right by the timer (`even_stamps`). `time` (n,): stamps [s].
    """
    rows, apart = np.arange(time.size), np.abs(np.diff(time))
    usual = float(np.mean(np.minimum(apart, rules.PACKET_PAUSE))) if apart.size else 0.0
    for between, share in ((0.0, rules.PACKED), (rules.PACKET_APART * usual, rules.PACKED_APART)):
        last = np.append(apart > between, True)
        if 1.0 - np.count_nonzero(last) / time.size >= share:
            return np.asarray(rows[last])
    return rows


def period_of(stamps: Floats, number: Floats) -> float:
    """Period of a timer that sends numbered messages [s]."""
    apart = number[rules.EVEN_WINDOW :] - number[: -rules.EVEN_WINDOW]
    return float(np.median((stamps[rules.EVEN_WINDOW :] - stamps[: -rules.EVEN_WINDOW]) / apart))


def queued_messages(stamps: Floats, number: Floats) -> Floats:
    """How long messages waited in a queue, (n,), from what they are late by a timer's pace [s].

    A timer that pauses is late ever after. What is made up for later was a queue, and the timer is
    as late as the least late of the messages that follow. They are so because the queue was sent at
    once: what ends by a number that is left out was counted wrong.
    """
    period = period_of(stamps, number)
    late = stamps - period * number
    usual = median_filter(late, rules.EVEN_WINDOW, mode="nearest")
    behind = -(rules.EVEN_QUEUE // 2)
    soonest = minimum_filter1d(usual, rules.EVEN_QUEUE, mode="nearest", origin=behind)
    wait = np.maximum(late - soonest, 0.0)
    inside = binary_propagation(wait > period, mask=wait > rules.EVEN_QUEUED * period)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], inside])))
    if edges.size % 2:  # where the record ends, nothing is made up for
        inside[edges[-1] :] = False
        edges = edges[:-1]
    if not edges.size:
        return np.zeros_like(late)
    begin, end = edges[::2], edges[1::2]
    most = np.repeat(np.maximum.reduceat(wait, edges)[::2], end - begin)
    rows = np.flatnonzero(inside)
    long = np.zeros(late.size, dtype=np.intp)
    long[rows] = np.where(wait[rows] > 0.5 * most, rows, 0)
    last = np.maximum.reduceat(long, edges)[::2]
    was = stamps[end] - stamps[last] < rules.EVEN_AT_ONCE * period * (end - last)
    # The messages before it were in time too, by those that follow.
    before = late[np.maximum(begin - 1, 0)] - np.minimum.reduceat(soonest, edges)[::2]
    was &= before < rules.EVEN_IN_TIME * period
    waits = np.zeros_like(late)
    waits[rows] = np.where(np.repeat(was, end - begin), wait[rows], 0.0)
    return waits


def read_before(stamps: Floats, left: Counts, right: Counts, queued: NDArray[np.bool_]) -> bool:
    """Whether messages of a queue were read before they came, each a period after the last.

    Then they tell as much travel where they come at once as where they queue up, or where nothing
    came. A program that reads late, and often to catch up, finds next to none.
    """
    inside = queued[1:] | queued[:-1]
    interval = np.diff(stamps)
    quick = interval < rules.EVEN_AT_ONCE * np.median(interval)
    step = np.nan_to_num(travel_of_steps(left, right))
    at_once, usual = (step[inside & part] for part in (quick, ~quick))
    if not at_once.size or not usual.any():
        return False
    return bool(np.mean(at_once) > (1.0 - rules.EVEN_SHARE) * np.mean(usual))


def travel_of_steps(left: Counts, right: Counts) -> Floats:
    """Travel from each message to the next, the mean of both wheels', (n - 1,) [counts]."""
    return 0.5 * (np.abs(np.diff(left)) + np.abs(np.diff(right))).astype(np.float64)
