# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Stamps of a bag's topics: those of the headers against when the recorder got the messages."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from werrimbi_odom.files.bag import Bag
from werrimbi_odom.model.pose import Floats

_BURST = 0.2
"""Share of the usual interval, below which two messages were received at once."""
_LATE = 0.1
"""By how much more than usual a message must be late to be counted [s]."""
_FEWEST = 3
_ALIKE = 1.1
"""Times as uneven as the other clock, below which it is told to be as even."""


@dataclass(frozen=True, kw_only=True)
class Stamps:
    """Stamps of one topic; times in seconds."""

    messages: int
    rate: float
    """Of the stamps that are believed [Hz]."""
    jitter: float | None
    """Half of the span that nine tenths of the intervals between header stamps are in; None where
    there are no headers."""
    received_jitter: float
    """The same of the times of receipt."""
    longest: float
    """Longest interval of the stamps that are believed."""
    offset: float | None
    """Median of receipt after stamp."""
    wander: float | None
    """Span that 98 of 100 of these are in."""
    latest: float | None
    """The largest of them."""
    bursts: float
    """Share of the messages that were received together with the one before."""
    late: float
    """Share of the messages that are late by a tenth of a second more than usual."""
    back: int
    """Times that the stamps went back."""

    @property
    def believed(self) -> Literal["header", "received"]:
        """The clock whose intervals are the evener; the headers where neither is by much."""
        if self.jitter is None:
            return "received"
        return "header" if self.jitter <= _ALIKE * self.received_jitter else "received"


def stamps_of(bag: Bag, topics: Sequence[str]) -> dict[str, Stamps]:
    """Stamps of some topics of an open bag; of those with three messages and more.

    Of transforms those of the one that comes most seldom: several send on one topic, each with
    stamps of its own, and what measures is slower than the odometry below it.
    """
    times: dict[str, dict[tuple[str, ...], list[tuple[float, float]]]] = {}
    for message in bag.messages(topics):
        stamp = _stamp(message.content)
        sender = times.setdefault(message.topic, {}).setdefault(_frames(message.content), [])
        sender.append((stamp or np.nan, message.received / 1e9))
    found = {}
    for topic, senders in times.items():
        enough = [rows for rows in senders.values() if len(rows) >= _FEWEST]
        if enough:
            found[topic] = _judged(*np.array(min(enough, key=len)).T)
    return found


def _frames(content: Any) -> tuple[str, ...]:
    """Of a message's first transform, from and to; empty where it has none."""
    for each in getattr(content, "transforms", ())[:1]:
        return str(each.header.frame_id), str(each.child_frame_id)
    return ()


def _stamp(content: Any) -> float:
    """Of the header, of a message or of its first transform; 0 where there is none."""
    for part in (content, *getattr(content, "transforms", ())[:1]):
        stamp = getattr(getattr(part, "header", None), "stamp", None)
        if stamp is not None:
            return float(stamp.sec + stamp.nanosec / 1e9)
    return 0.0


def _judged(header: Floats, received: Floats) -> Stamps:
    gaps = np.diff(received)
    has_header = bool(np.isfinite(header).all())
    told = np.diff(np.sort(header)) if has_header else gaps  # one may overtake another
    after = received - header
    usual = float(np.median(told))
    return Stamps(
        messages=header.size,
        rate=1.0 / usual if usual > 0.0 else 0.0,
        jitter=_spread(told) if has_header else None,
        received_jitter=_spread(gaps),
        longest=float(told.max()),
        offset=float(np.median(after)) if has_header else None,
        wander=float(np.subtract(*np.quantile(after, [0.99, 0.01]))) if has_header else None,
        latest=float(after.max()) if has_header else None,
        bursts=float(np.mean(gaps < _BURST * usual)),
        late=float(np.mean(after > np.median(after) + _LATE)) if has_header else 0.0,
        back=int(np.count_nonzero(np.diff(header) < 0.0)) if has_header else 0,
    )


def _spread(intervals: Floats) -> float:
    return 0.5 * float(np.subtract(*np.quantile(intervals, [0.95, 0.05])))
