# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Count messages of a timer that never came, by the stamps and by how far the wheels turned.

A message that is a period late, and one that comes after a lost one, have the same stamp. They
differ in what follows, which is late no more or late ever after, and in the travel to the message,
which is of one period or of two. Of all ways to number the messages, the likeliest is found by
dynamic programming (Viterbi 1967).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter, minimum_filter1d, uniform_filter1d

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.legs.queued_messages import travel_of_steps
from werrimbi_odom.model.encoder_online import Counts
from werrimbi_odom.model.pose import Floats


def lost_messages(stamps: Floats, left: Counts, right: Counts) -> NDArray[np.intp]:
    """Count messages of a timer that are missing between neighbours, (n - 1,).

    However many are missing, the rest come at whole periods of the timer. Without those that are
    lost, an even timer would seem to err by half a period beside each hole. A timer that loses its
    pace now and then seems to lose messages too, but no travel is more in these intervals.
    """
    none = np.zeros(stamps.size - 1, dtype=np.intp)
    place = _place(stamps)
    if place is None:
        return none
    more = place - np.arange(float(stamps.size))
    seen = median_filter(more, rules.EVEN_BESIDE, mode="nearest")
    # Whatever waits in a queue, the least late of those that follow tell how many are missing.
    ahead = -(rules.EVEN_QUEUE // 2)
    soonest = minimum_filter1d(seen, rules.EVEN_QUEUE, mode="nearest", origin=ahead)
    rough = np.rint(np.maximum.accumulate(soonest))
    ways = _ways(left, right)
    lost = np.asarray(np.diff(_likeliest(more - rough, rough, ways)))
    step, least, most = ways
    # In a pause of the timer all seem lost, beyond the band in which travel has a say.
    in_band = lost <= 2 * rules.EVEN_BAND
    lost[~in_band & (step < rules.EVEN_HOLE * most)] = 0
    counted = in_band & (lost > 0)
    expected = float(np.sum((0.5 * (least + most) * (1 + lost))[counted]))
    return none if float(np.sum(step[counted])) < rules.EVEN_TRAVEL * expected else lost


def _place(stamps: Floats) -> Floats | None:
    """Numbers of the messages by their stamps alone, with what they are late by [periods], (n,)."""
    count = stamps.size // rules.EVEN_WINDOW
    apart = stamps[rules.EVEN_WINDOW :] - stamps[: -rules.EVEN_WINDOW]
    usual = float(np.median(apart)) / rules.EVEN_WINDOW if count >= rules.EVEN_WINDOWS else 0.0
    if usual <= 0.0:
        return None
    windows = stamps[: count * rules.EVEN_WINDOW].reshape(count, -1)
    since = windows - windows[:, :1]
    finely = 0.25 / rules.EVEN_WINDOW
    rates = np.arange(1.0 - 4.0 * finely, 1.0 + rules.EVEN_MOST_LOST, finely) / usual
    # Mean resultant length of the stamps as angles of the timer: 1 if even, 0 if anywhere.
    angle, further = (np.exp(2j * np.pi * rate * since) for rate in (rates[0], finely / usual))
    even = []
    for _ in rates:
        even.append(np.abs(angle.mean(axis=1)).mean())
        angle *= further
    if max(even) < rules.EVEN_KNOWN:
        return None
    turns = rates[np.argmax(even)] * (stamps - stamps[0])
    # Messages of a queue that come at once have one angle, which is not the timer's.
    own = np.append(True, np.diff(turns) > rules.EVEN_AT_ONCE)
    angle = np.exp(2j * np.pi * turns[own])
    phase = uniform_filter1d(angle, rules.EVEN_WINDOW, mode="reflect")
    slow = np.interp(turns, turns[own], np.unwrap(np.angle(phase)))
    return np.asarray(turns - slow / (2.0 * np.pi))


def _ways(left: Counts, right: Counts) -> Floats:
    """Travel of each step, and the least and most that one period has by the steps beside it.

    They are those before and after, each the median of three, of which one may have a loss itself:
    wheels may speed up or brake meanwhile. In multiples of what steps are off by, (3, n - 1); zeros
    where nothing is known.
    """
    step = travel_of_steps(left, right)
    known = np.isfinite(step)
    step = np.where(known, step, 0.0)
    usual = np.pad(median_filter(step, 3, mode="nearest"), 2, mode="edge")
    least, most = np.minimum(usual[:-4], usual[4:]), np.maximum(usual[:-4], usual[4:])
    known &= most > 0.0
    off = np.minimum(np.maximum(np.maximum(least - step, step - most), 0.0), most)[known]
    scale = float(off.mean()) if off.any() else np.inf
    return np.stack([np.where(known, way, 0.0) for way in (step, least, most)]) / scale


def _likeliest(late: Floats, rough: Floats, ways: Floats) -> NDArray[np.intp]:
    """Number of messages that are missing before each, (n,), for the least sum of what is unlikely.

    `late` (n,): what messages are late by if as many as `rough` (n,) are missing [periods].
    `ways`: as from `_ways`. The unlikeliness of a message is its distance from the timer, and that
    of its travel from that of its periods, each divided by its mean (Laplace distribution) up to a
    bound, and `EVEN_LOSS` if messages are lost before it. The parts of the drive are gone through
    side by side, from all numbers at which they may begin, and then put together: no loop is longer
    than the root of n.
    """
    near = late - np.rint(late)
    middle = np.median(near)
    late, scale = late - middle, max(float(np.abs(near - middle).mean()), rules.EVEN_LEAST)
    length = int(np.sqrt(late.size)) + 1
    parts = -(-late.size // length)

    def side_by_side(values: Floats) -> NDArray[np.float32]:
        wide = np.concatenate([values, np.zeros(parts * length - values.size)])
        return np.ascontiguousarray(wide.reshape(parts, length).T, dtype=np.float32)

    tried = np.arange(-rules.EVEN_BAND, rules.EVEN_BAND + 1, dtype=np.float32)
    shift = (tried[None, :] - tried[:, None])[:, :, None]
    places = side_by_side(late)
    holes = side_by_side(np.append(0.0, np.diff(rough)))
    gone, least, most = (side_by_side(np.append(0.0, way)) for way in ways)
    # Axes: number at the begin of a part, number before a row, number at it, part.
    path = np.full((tried.size, tried.size, parts), np.inf, dtype=np.float32)
    path[np.arange(tried.size), np.arange(tried.size)] = 0.0
    back = np.empty((length, tried.size, tried.size, parts), dtype=np.int8)
    for row in range(length):
        lost = holes[row] + shift
        off = np.maximum(
            (1.0 + lost) * least[row] - gone[row], gone[row] - (1.0 + lost) * most[row]
        )
        price = np.clip(off, 0.0, rules.EVEN_UNLIKELY) + rules.EVEN_LOSS * (lost > 0.0)
        price[lost < 0.0] = np.inf
        total = path[:, :, None, :] + price
        back[row] = total.argmin(axis=1)
        off = np.abs(places[row] - tried[:, None]) / scale
        path = total.min(axis=1) + np.minimum(off, rules.EVEN_UNLIKELY)
    best, begins = np.zeros(tried.size), np.empty((parts, tried.size), dtype=np.intp)
    for part in range(parts):
        total = best[:, None] + path[:, :, part]
        begins[part], best = total.argmin(axis=0), total.min(axis=0)
    begin, end = (np.empty(parts, dtype=np.intp) for _ in range(2))
    last = int(best.argmin())
    for part in range(parts)[::-1]:
        end[part], begin[part] = last, begins[part, last]
        last = begin[part]
    found = np.empty((length, parts), dtype=np.intp)
    every = np.arange(parts)
    for row in range(length)[::-1]:
        found[row] = tried[end]
        end = back[row, begin, end, every].astype(np.intp)
    return np.asarray(np.rint(rough).astype(np.intp) + found.T.ravel()[: late.size])
