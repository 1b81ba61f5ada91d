# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Which values of an array message are counters: its places have no names."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from werrimbi_odom.files.parameters import WHOLE_COUNTS
from werrimbi_odom.model.pose import Floats

if TYPE_CHECKING:
    from werrimbi_odom.files.bag import Bag

_MOST = 64
"""Values of an array that are looked at; one with more is a map, a picture or a scan."""
_RUNS_ON = 0.1
"""Largest usual step of a counter (nine tenths of them), as a share of its range. A command or a
speed comes through its range within a few messages."""
_CLOCK = 2.0
"""Distance from a straight line over time, in usual steps, up to which a value is a clock or the
number of the message."""


def counting_places(bag: Bag, topic: str, values: int) -> tuple[int, ...]:
    """Places, from 0, of the values that count as a wheel's counter does.

    `values`: how many its messages hold; others are not looked at.
    """
    if values > _MOST:
        return ()
    rows = [
        (message.received / 1e9, *map(float, message.content.data))
        for message in bag.messages([topic])
        if len(message.content.data) == values
    ]
    table = np.array(rows, dtype=np.float64)
    table = table[np.isfinite(table).all(axis=1)]
    time, columns = table[:, 0], table[:, 1:].T
    return tuple(place for place, each in enumerate(columns) if _counts(time, each))


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
