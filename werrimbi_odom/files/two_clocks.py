# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Puts wheels and reference on one clock if their computers' clocks were apart.

A robot's computer without a battery or a network begins at some date of its own. The recorder
received all messages by one clock, so how long before receipt each topic is stamped, as a rule,
tells how far apart the clocks are, but for what the messages took to come.
"""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from werrimbi_odom.files.bag import BagMessage
from werrimbi_odom.files.frames import is_static
from werrimbi_odom.files.run import Collected, Reference, Ticks
from werrimbi_odom.files.run_checks import APART, span_in_words
from werrimbi_odom.files.stamps import header_stamp

STEADY = 1.0
"""Largest range of nine tenths of the times from stamp to receipt [s] for which they tell a clock:
less than what is mended, more than networks take."""


class Lateness:
    """Passes messages to a collector, and notes how long after its stamp each was received."""

    def __init__(self, taker: Any) -> None:
        self._taker = taker
        self._late = array("d")

    def take(self, message: BagMessage) -> None:
        """Add a message."""
        self._taker.take(message)
        if not is_static(message.topic):
            received = message.received / 1e9
            self._late.append(received - (header_stamp(message.content) or received))

    @property
    def usual(self) -> float:
        """Median time from stamp to receipt [s]; zero without stamps, NaN if it is not steady."""
        late = np.array(self._late)
        if not late.size or np.subtract(*np.quantile(late, [0.95, 0.05])) > STEADY:
            return np.nan
        return float(np.median(late))


def on_one_clock(
    ticks: Ticks, found: Sequence[Collected], late: Sequence[float]
) -> tuple[Ticks, list[Collected], tuple[str, ...]]:
    """Ticks and references by the recorder's clock, if they are further apart than a search covers.

    Parameters
    ----------
    late
        `Lateness.usual` of the ticks, then of each reference.

    Returns
    -------
    ticks, found
        As given, or moved.
    told : tuple of str
        What was done, in words for the user; empty if nothing was.
    """
    apart = np.abs(np.subtract(late[1:], late[0]))
    if not (apart > APART).any():  # also if one is unknown
        return ticks, list(found), ()
    far = found[int(np.nanargmax(apart))].reference
    told = (
        f"the stamps of wheels (t_s {span_in_words(ticks)}) and reference ({span_in_words(far)}) "
        f"are of two clocks, {np.nanmax(apart):.4g} s apart by when both were received: both are "
        "put on the recorder's clock, and what the messages took to come is left, as a delay"
    )
    moved = [
        each._replace(
            reference=_moved(each.reference, by),
            taken_out=tuple((begin + by, end + by) for begin, end in each.taken_out),
        )
        for each, by in zip(found, late[1:], strict=True)
    ]
    return replace(ticks, time=ticks.time + late[0]), moved, (told,)


def _moved(reference: Reference, by: float) -> Reference:
    return reference.earlier(-by)
