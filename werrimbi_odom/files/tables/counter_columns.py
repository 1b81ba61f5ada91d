# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Counters that are no running, signed totals, by their own values and the reference."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from werrimbi_odom.files.instants import instants
from werrimbi_odom.files.run import Reference, Ticks
from werrimbi_odom.model.encoder_online import Counts
from werrimbi_odom.model.pose import Floats, wrap_all

FEWEST = 20
"""Rows, windows or chords below which nothing is concluded."""

WINDOW = 0.5
"""Time over which counts and motion are compared [s]: longer than most delays of a reference."""
TAKES, HARDLY = 0.9, 0.5
"""Correlations with the motion: of the values themselves, from which they are increments or speeds,
and of their differences, up to which they are no totals."""
CARRIED = 3
"""Windows that matter most for a correlation of the values, and are left out of it: a robot that
drives straight and is turned by hand once has one that makes it alone."""

STRAIGHT = 0.02
"""Range of right less left, over that of their mean, up to which a drive is straight: a count more
or less by chance while the robot was carried and turned is no speed."""

SEVERAL, AT_MOST = 3, 0.3
"""Leaps from which a counter's range is taken for its period, and their largest share of the rows:
a counter that is reset leaps once, and one that is read too seldom leaps always."""
USUAL = 0.9
"""Quantile of a counter's steps: about a power of two to within this, one leap is enough."""
AGAINST = 0.8
"""Share of the leaps that must be against the motion beside them."""

SPINS, SPIN_TURN, SPIN_RADIUS = 3, 0.2, 0.03
"""Windows of turning on the spot that must contradict counters without a sign: how many, the turn
[rad] in each, and the way [m] for each radian of it. On one wheel that stands, a robot's middle
goes half its base a radian: 40 mm for the smallest."""


def what_counters_hold(ticks: Ticks, reference: Reference) -> str:
    """What is wrong with a run's counters and how to convert them; "" if nothing is.

    `ticks`: run on where the robot file says that they wrap.
    """
    windows = _windows(ticks, reference)
    words = "" if windows is None else _no_totals(windows) or _no_signs(ticks, windows)
    return words or wraps_words(ticks)


def turns_by_wheels(ticks: Ticks, reference: Reference) -> float:
    """Correlation of the reference's turns with the difference of both counters' steps."""
    windows = _windows(ticks, reference)
    return 0.0 if windows is None else _related(windows.steps[1], windows.moved[1])


class _Windows(NamedTuple):
    """Sums over windows of time; k windows."""

    values: Floats
    """Mean of both counters' values, and right less left, shape (2, k)."""
    steps: Floats
    """The same of their change."""
    moved: Floats
    """Displacement [m] and turn [rad] by the reference, shape (2, k); NaN where not measured."""


def _no_totals(found: _Windows) -> str:
    # A displacement has no sign, so the values have none either. Turns have theirs.
    of_values = [_related(np.abs(found.values[0]), found.moved[0], CARRIED)]
    of_steps = [_related(np.abs(found.steps[0]), found.moved[0])]
    mean, apart = np.ptp(found.values, axis=-1)
    if apart > STRAIGHT * mean:
        of_values += [_related(found.values[1], found.moved[1], CARRIED)]
        of_steps += [_related(found.steps[1], found.moved[1])]
    if max(of_values) < TAKES or max(of_steps) > HARDLY:
        return ""
    return (
        "left_ticks and right_ticks go with how fast the robot moves: they hold what was counted "
        "since the row before, or a speed, and not running totals: write the sum of all rows so "
        "far (of a speed times the time since the row before)"
    )


def _no_signs(ticks: Ticks, found: _Windows) -> str:
    if any((np.diff(counts) < 0).any() for counts in (ticks.left, ticks.right)):
        return ""
    both = found.steps[0] > 0.5 * np.abs(found.steps[1])  # both wheels count up
    way, turn = found.moved[0], np.abs(found.moved[1])
    spins = both & (turn > SPIN_TURN) & (way < SPIN_RADIUS * turn)
    if np.count_nonzero(spins) < SPINS:
        return ""
    return (
        "left_ticks and right_ticks never decrease, also where the robot turns on the spot, so "
        "that one wheel rolls backwards: the encoders tell no direction; give each step the sign "
        "of its motor's command before it is summed"
    )


def _windows(ticks: Ticks, reference: Reference) -> _Windows | None:
    counts = np.stack([ticks.left, ticks.right]).astype(np.float64)
    read = np.isfinite(counts).all(axis=0)
    time, seen = (np.maximum.accumulate(each) for each in (ticks.time[read], reference.time))
    counts = counts[:, read]
    if min(time.size, seen.size) < FEWEST:
        return None
    begin, end = max(time[0], seen[0]), min(time[-1], seen[-1])
    wide = max(WINDOW, 3.0 * float(np.median(np.diff(time))))
    wide = max(wide, float(np.median(np.diff(seen))))
    if end - begin < FEWEST * wide:
        return None
    edges = instants(begin, end, wide, time, 2.0 * wide)
    rows = np.searchsorted(time, edges)
    whole = np.diff(rows) > 0
    counts = np.stack([counts.mean(axis=0), counts[1] - counts[0]])
    sums = np.cumsum(np.concatenate([np.zeros((2, 1)), counts], axis=1), axis=1)
    values = np.diff(sums[:, rows], axis=1)[:, whole] / np.diff(rows)[whole]
    at = counts[:, np.minimum(rows, time.size - 1)]
    nearest = np.minimum(np.searchsorted(seen, edges), seen.size - 1)
    x, y, yaw = (part[nearest] for part in (reference.x, reference.y, reference.yaw))
    moved = np.stack([np.hypot(np.diff(x), np.diff(y)), wrap_all(np.diff(yaw))])
    return _Windows(values, np.diff(at, axis=1)[:, whole], moved[:, whole])


def _related(one: Floats, other: Floats, without: int = 0) -> float:
    """Correlation where both are known; 0 if there are too few values, or none varies.

    `without`: number of the most influential values that are left out.
    """
    known = np.isfinite(one) & np.isfinite(other)
    if without and np.count_nonzero(known) > without:
        products = np.abs((one - one[known].mean()) * (other - other[known].mean()))
        known[np.argsort(np.where(known, products, -1.0))[-without:]] = False
    if np.count_nonzero(known) < FEWEST or not np.ptp(one[known]) or not np.ptp(other[known]):
        return 0.0
    return abs(float(np.corrcoef(one[known], other[known])[0, 1]))


def wraps_words(ticks: Ticks) -> str:
    """Which counter wraps, and how to say so; "" if none does."""
    name, period = _wrapping(ticks)
    if not period:
        return ""
    bits = _bits(period)
    mend = (
        f"wraps at {bits} bits: write encoder_bits: {bits} into the robot file"
        if bits
        else f"begins anew after {period} counts: unwrap both (numpy.unwrap, period={period})"
    )
    return (
        f"{name} leaps from one end of its range to the other while its wheel rolls on: it {mend}"
    )


def bits_of_wraps(ticks: Ticks) -> int:
    """Width at which the counters wrap; 0 if they do not, or at no power of two."""
    return _bits(_wrapping(ticks)[1])


def _wrapping(ticks: Ticks) -> tuple[str, int]:
    """The counter that wraps, and after how many counts; 0 if none does."""
    sides = (("left_ticks", ticks.left), ("right_ticks", ticks.right))
    return max(((name, _period(counts)) for name, counts in sides), key=lambda item: item[1])


def _bits(period: int) -> int:
    bits = period.bit_length() - 1
    return bits if bits > 1 and period == 1 << bits else 0


def _period(counts: Counts) -> int:
    """Counts after which a counter begins anew; 0 if it does not."""
    values = counts[np.isfinite(counts)].astype(np.float64)
    if values.size < FEWEST or not (values == np.rint(values)).all():
        return 0
    steps = np.diff(values)
    reach = int(np.ptp(values))
    leaps = np.abs(steps) > 0.5 * reach
    count = int(leaps.sum())
    if count == 0 or count > AT_MOST * steps.size:
        return 0
    near = np.convolve(~leaps, np.ones(3), "same")[leaps]
    beside = np.convolve(np.where(leaps, 0.0, steps), np.ones(3), "same")[leaps]
    # The wheel rolls on as before and after.
    leapt = np.abs(steps[leaps] - beside / np.maximum(near, 1.0))
    usual = float(np.quantile(np.abs(steps[~leaps]), USUAL))
    about = float(np.median(leapt))
    of_bits = 1 << round(math.log2(about))
    bits = of_bits > reach and abs(about - of_bits) <= usual / math.sqrt(count)
    period = of_bits if bits else max(round(about), reach + 1)
    against = np.mean(np.sign(beside) == -np.sign(steps[leaps]))
    left_over = float(np.abs(period - np.abs(steps[leaps])).max())
    sure = max(left_over, usual) <= 0.5 * period and against >= AGAINST
    return period if sure and (bits or count >= SEVERAL) else 0
