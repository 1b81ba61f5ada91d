# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Which values of an array message are counters: its places have no names."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING

import numpy as np

from werrimbi_odom.files.robot_files.parameters import WHOLE_COUNTS
from werrimbi_odom.model.pose import Floats

if TYPE_CHECKING:
    from werrimbi_odom.files.bags.bag import Bag

Sides = tuple[tuple[int, ...], tuple[int, ...]]
"""Places of the counters of either side."""

_MOST = 64
"""Values of an array that are looked at; one with more is a map, a picture or a scan."""
_RUNS_ON = 0.1
"""Largest usual step of a counter (nine tenths of them), as a share of its range. A command or a
speed comes through its range within a few messages."""
_ALIKE = 0.5
"""Largest difference between counters of one side, as a share of the least between the sides."""
_SAMPLE = 5000
"""Messages that are looked at, or about twice as many."""
_CLOCK = 2.0
"""Distance from a straight line over time, in usual steps, up to which a value is a clock or the
number of the message."""


def counting_sides(bag: Bag, topic: str, values: int) -> Sides | None:
    """Places, from 0, of the values that count as a wheel's counter does, in two groups.

    More than two are told apart by turning alike: the wheels of a side do. The group of the first
    place comes first; None if there are no two. `values`: how many its messages hold; others are
    not looked at.
    """
    if values > _MOST:
        return None
    rows = [
        (message.received / 1e9, *map(float, message.content.data))
        for message in bag.sampled(topic, _SAMPLE)
        if len(message.content.data) == values
    ]
    table = np.array(rows, dtype=np.float64)
    table = table[np.isfinite(table).all(axis=1)]
    time, columns = table[:, 0], table[:, 1:].T
    places = [place for place, each in enumerate(columns) if _counts(time, each)]
    return _sides(places, columns) if len(places) > 1 else None


def _sides(places: list[int], columns: Floats) -> Sides | None:
    """Two groups of counters that turn alike; None if they do not fall into two."""
    from_middle = columns - columns.mean(axis=1, keepdims=True)

    def apart(one: tuple[int, ...], other: tuple[int, ...]) -> list[float]:
        return [_apart(from_middle[a], from_middle[b]) for a in one for b in other if a != b]

    groups: list[tuple[int, ...]] = [(place,) for place in places]
    while len(groups) > 2:
        pairs = itertools.combinations(groups, 2)
        nearest = min(pairs, key=lambda pair: max(apart(*pair)))
        groups = [each for each in groups if each not in nearest]
        groups.append(tuple(sorted((*nearest[0], *nearest[1]))))
    left, right = sorted(groups)
    within = max([*apart(left, left), *apart(right, right)], default=0.0)
    return (left, right) if within <= _ALIKE * min(apart(left, right)) else None


def _apart(one: Floats, other: Floats) -> float:
    """Largest difference, whichever way round either counts [counts]."""
    return float(min(np.abs(one - other).max(), np.abs(one + other).max()))


def _counts(time: Floats, column: Floats) -> bool:
    whole = bool((column == np.rint(column)).all())
    if not whole or np.unique(column).size < WHOLE_COUNTS:
        return False
    steps = np.abs(np.diff(column))
    usual = float(np.quantile(steps, 0.9))
    if usual > _RUNS_ON * float(np.ptp(column)):
        return False
    after = time - time[0]
    line = np.polynomial.Polynomial.fit(after, column, 1)
    return float(np.sqrt(np.mean((line(after) - column) ** 2))) > _CLOCK * usual
