# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Counter jumps: outliers that return (a corrupted message), permanent steps, and resets.

An encoder model takes any step but a fall to zero for motion, unless it knows the wheel's top
speed. The record itself shows it: a speed that a wheel keeps for several intervals is possible.
Where it saw a reset it knows no motion, and a record has it from before and after, as of a step.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference import rules
from werrimbi_odom.model.pose import Floats


class CounterJump(NamedTuple):
    """Steps of a record in which a counter jumped."""

    first: int
    last: int
    """Its last step, inclusive."""
    turns: float
    """Largest of these steps, in turns of the wheel; 0 of a reset, which is no step."""
    left: bool
    """Whether the left wheel jumped."""
    back: bool
    """Whether the counter came back."""


class Bridged(NamedTuple):
    """Steps with jumps removed; n steps, some of which may be merged."""

    kept: NDArray[np.bool_]
    """Steps that still end at a reading, shape (n,)."""
    left: Floats
    """Travel in turns of a step and the dropped steps before it, shape (n,)."""
    right: Floats
    leaps: tuple[CounterJump, ...]


def bridged(time: Floats, left: Floats, right: Floats, reset: NDArray[np.bool_]) -> Bridged:
    """Remove jumps from the steps of a record.

    A counter that came back kept counting: only the readings in between are dropped. One that did
    not has lost its counts: the wheel is assumed to have moved as before and after. `time` (n +
    1,): stamps, ascending [s]. `left`, `right` (n,): travel between them, in turns of the wheel.
    `reset` (n,): steps in which the encoder model saw a counter fall to zero.
    """
    anew = (CounterJump(row, row, 0.0, True, False) for row in np.flatnonzero(reset).tolist())
    found = tuple(sorted((*counter_jumps_in(time, left, right), *anew)))
    kept = np.ones(left.size, dtype=np.bool_)
    sides = [left.copy(), right.copy()] if found else [left, right]
    for leap in found:
        first, last = leap.first, leap.last
        kept[first:last] = False
        lasted = time[last + 1] - time[first]
        for side in sides:
            net = float(side[first : last + 1].sum())
            if not leap.back:
                near = [at for at in (first - 1, last + 1) if 0 <= at < left.size]
                durations = [time[at + 1] - time[at] for at in near]
                net = lasted * float(np.mean([side[at] for at in near]) / np.mean(durations))
            side[first : last + 1] = 0.0
            side[last] = net
    return Bridged(kept, sides[0], sides[1], found)


def counter_jumps_in(time: Floats, left: Floats, right: Floats) -> tuple[CounterJump, ...]:
    """Find where counters jumped; see `bridged`."""
    lasted = np.diff(time)
    turns = np.maximum(np.abs(left), np.abs(right))
    moving = turns > 0.0
    if np.count_nonzero(moving) < rules.LEAP_FEWEST:
        return ()
    lasted = np.maximum(lasted, np.median(lasted))  # two stamps may be close by accident
    speed = turns / lasted
    usual = float(np.quantile(speed[moving], rules.LEAP_USUAL))
    fastest = max(rules.LEAP_TIMES * usual, rules.LEAP_SPEED)
    fast = np.flatnonzero(speed > fastest)
    if fast.size == 0:
        return ()
    groups = np.split(fast, np.flatnonzero(np.diff(fast) > 1) + 1)
    found = []
    for group in groups:
        if group.size > rules.LEAP_LASTS:
            continue  # a speed that lasts this long is real
        first, last = int(group[0]), int(group[-1])
        of_left = np.abs(left[group]).max() >= np.abs(right[group]).max()
        reach = fastest * float(lasted[group].sum())
        net = max(abs(float(side[group].sum())) for side in (left, right))
        size = float(turns[group].max())
        found.append(CounterJump(first, last, size, bool(of_left), group.size > 1 and net <= reach))
    return tuple(found)
