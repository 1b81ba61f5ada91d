# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Clocks of two computers, by when one recorder received what both had stamped.

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

from werrimbi_odom.files.bags.bag import BagMessage
from werrimbi_odom.files.bags.frames import is_static
from werrimbi_odom.files.bags.stamps import header_stamp
from werrimbi_odom.files.run import Collected, Ticks
from werrimbi_odom.files.run_checks import APART, span_in_words
from werrimbi_odom.model.pose import Floats

STEADY = 1.0
"""Largest range of nine tenths of the times from stamp to receipt [s] for which they tell a clock:
less than what is mended, more than networks take."""
_COPIED = 1e-4
"""Range of the times from stamp to receipt up to which one was copied from the other [s]."""
_PARTS = 10
"""Parts of a drive in which the soonest message is looked for."""
_HALF = 5
"""Least number of these in which both were received: a topic may be silent for a while."""
_GAINS = 0.03
"""What one clock gains on the other in a drive up to which they run at one rate [s]: the usual
`reference_delay`, which a delay that does not grow takes up but for a part."""
_SURE = 2.0
"""Standard deviations of that gain which are added to it before."""


class Lateness:
    """Passes messages to a collector, and notes how long after its stamp each was received.

    Of transforms that come beside other messages (where the lidar of the scans sits) nothing is
    noted: several nodes send them, each by its clock.
    """

    def __init__(self, taker: Any) -> None:
        self._taker = taker
        self._late = array("d")
        self._received = array("d")
        self._many = False
        self._others = False

    def take(self, message: BagMessage) -> None:
        """Add a message."""
        self._taker.take(message)
        transforms = hasattr(message.content, "transforms")
        if is_static(message.topic) or (transforms and self._others):
            return
        if not transforms and not self._others:
            self._others = True
            self._late, self._received = array("d"), array("d")
        received = message.received / 1e9
        self._received.append(received)
        self._late.append(received - (header_stamp(message.content) or received))
        self._many = transforms

    @property
    def usual(self) -> float:
        """Median time from stamp to receipt [s]; zero without stamps, NaN if it is not steady."""
        late = np.array(self._late)
        if not late.size or np.subtract(*np.quantile(late, [0.95, 0.05])) > STEADY:
            return np.nan
        return float(np.median(late))

    @property
    def tells_a_clock(self) -> bool:
        """Whether receipt was noted by a clock of its own, and all was stamped by one sender.

        A bag that was made from a log has its stamps as times of receipt. Several nodes send
        transforms on one topic.
        """
        late = np.array(self._late)
        return not self._many and bool(late.size) and float(np.ptp(late)) > _COPIED

    def soonest(self, edges: Floats) -> Floats:
        """Least time from stamp to receipt between times of receipt, (n,): (n - 1,), NaN if none.

        The least, since a queue only adds.
        """
        received, late = np.array(self._received), np.array(self._late)
        part = np.searchsorted(edges, received, side="right") - 1
        least = np.full(edges.size - 1, np.inf)
        inside = (part >= 0) & (part < least.size)
        np.minimum.at(least, part[inside], late[inside])
        return np.where(np.isfinite(least), least, np.nan)

    @property
    def span(self) -> tuple[float, float]:
        """First and last time of receipt [s]."""
        return min(self._received), max(self._received)


def of_one_rate(wheels: Lateness, reference: Lateness) -> bool:
    """Whether by the recorder's clock neither of two clocks gains on the other.

    How long after its stamp a message is received has the recorder's clock in it, which cancels,
    and the way to it. What a driver holds back before it stamps does not show. False if receipt
    tells nothing.
    """
    if not (wheels.tells_a_clock and reference.tells_a_clock):
        return False
    begin = max(wheels.span[0], reference.span[0])
    end = min(wheels.span[1], reference.span[1])
    if end <= begin:
        return False
    edges = np.linspace(begin, end, _PARTS + 1)
    apart = reference.soonest(edges) - wheels.soonest(edges)
    known = np.isfinite(apart)
    if known.sum() < _HALF:
        return False
    along = np.linspace(-0.5, 0.5, _PARTS)
    (gain, _), spread = np.polyfit(along[known], apart[known], 1, cov=True)
    std = float(np.sqrt(spread[0, 0]))
    return abs(float(gain)) + _SURE * std < _GAINS


def on_one_clock(
    ticks: Ticks, found: Sequence[Collected], late: Sequence[float]
) -> tuple[Ticks, list[Collected], tuple[str, ...]]:
    """Ticks and references by the recorder's clock, if they are further apart than a search covers.

    `late`: `Lateness.usual` of the ticks, then of each reference; one of which nothing is known is
    taken to have the ticks' clock. Result: ticks and references as given, or moved; then what was
    done, in words for the user, empty if nothing was.
    """
    late = [late[0] if np.isnan(each) else each for each in late]
    apart = np.abs(np.subtract(late[1:], late[0]))
    if not (apart > APART).any():  # also if nothing is known of the ticks
        return ticks, list(found), ()
    far = found[int(np.argmax(apart))].reference
    told = (
        f"the stamps of wheels (t_s {span_in_words(ticks)}) and reference ({span_in_words(far)}) "
        f"are of two clocks, {apart.max():.4g} s apart by when both were received: both are "
        "put on the recorder's clock, and what the messages took to come is left, as a delay"
    )
    moved = [
        each._replace(
            reference=each.reference.earlier(-by),
            taken_out=tuple((begin + by, end + by) for begin, end in each.taken_out),
        )
        for each, by in zip(found, late[1:], strict=True)
    ]
    return replace(ticks, time=ticks.time + late[0]), moved, (told,)
