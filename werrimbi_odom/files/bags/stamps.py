# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Stamps of a bag's topics: header stamps against times of recording, and bursts of messages."""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.bags.bag import Bag
from werrimbi_odom.model.pose import Floats

_BURST = 0.2
"""Share of the usual interval below which two messages arrived in a burst."""
_MOSTLY = 0.5
"""Share of intervals within bursts from which on a topic counts as sent in bursts: then the usual
interval is next to nothing, and every pause between two bursts would look like a loss."""
_HEELS = 0.5
"""Share of the usual interval below which a message came on the heels of another, in a queue that
a pause had made."""
_LOST = 1.5
"""Interval, in usual ones, from which on something was lost or waited."""
_TOLD = 0.01
"""Share of messages that were left out above which it is said."""
_TELLING = 20
"""Intervals that it takes to know the usual one."""
_PAUSE = 0.5
"""Least pause before such messages, beyond their number, in usual intervals: pairs and triples that
are always sent together have none."""
_SLOW = 1.0
"""Usual interval from which on readings close together were taken so [s], by a person."""
_SILENT = 3.0
"""Interval, in medians, from which on messages that come less often than that are silent."""
_LATE = 0.1
"""Delay beyond the usual one above which a message counts as late [s]."""
_FEWEST = 3
_ALIKE = 1.1
"""Largest ratio of jitters at which the header clock is still preferred."""
_MILLISECOND = 5e-4
"""Jitter that rounds to no millisecond [s]."""
_EVEN = 0.02
"""Jitter, as a share of the usual interval, up to which the header clock is even enough: a
simulation stamps to the millisecond, and what it receives is not evener for a rounding less."""


@dataclass(frozen=True, kw_only=True)
class Stamps:
    """Statistics of one topic's stamps; times in seconds."""

    messages: int
    rate: float
    """Rate by the preferred stamps [Hz]."""
    jitter: float | None
    """Half of the range of nine tenths of the intervals between header stamps; None without
    headers."""
    received_jitter: float
    """The same for the times of recording."""
    longest: float
    """Longest interval of the preferred stamps."""
    offset: float | None
    """Median delay from stamp to recording."""
    wander: float | None
    """Range of 98 % of these delays."""
    latest: float | None
    """Largest of these delays."""
    bursts: float
    """Share of messages that arrived in a burst with the previous one."""
    late: float
    """Share of messages with a delay 0.1 s above the usual one."""
    back: int
    """Number of times that the stamps went back."""

    @property
    def believed(self) -> Literal["header", "received"]:
        """The clock with the more even intervals; the headers if they differ little."""
        if self.jitter is None:
            return "received"
        enough = _EVEN / self.rate if self.rate > 0.0 else 0.0
        alike = max(_ALIKE * self.received_jitter, enough)
        return "header" if self.jitter <= alike else "received"

    @property
    def alike(self) -> bool:
        """Whether both clocks are as even, but for a tenth, or for less than is printed."""
        if self.jitter is None:
            return False
        less, more = sorted((self.jitter, self.received_jitter))
        return more <= max(_ALIKE * less, _MILLISECOND)


def stamps_of(bag: Bag, topics: Sequence[str]) -> dict[str, Stamps]:
    """Stamp statistics of some topics of an open bag, for topics with at least three messages.

    For transforms, those of the rarest one: several nodes send on one topic, each with its own
    stamps, and a measurement is slower than the odometry below it.
    """
    times: dict[str, dict[tuple[str, ...], array[float]]] = {}
    for message in bag.messages(topics):
        stamp = header_stamp(message.content)
        sender = times.setdefault(message.topic, {}).setdefault(
            _frames(message.content), array("d")
        )
        sender.extend((stamp or np.nan, message.received / 1e9))
    found = {}
    for topic, senders in times.items():
        enough = [rows for rows in senders.values() if len(rows) >= 2 * _FEWEST]
        if enough:
            found[topic] = _judged(*np.array(min(enough, key=len)).reshape(-1, 2).T)
    return found


def _frames(content: Any) -> tuple[str, ...]:
    """Parent and child of a message's first transform; empty if it has none."""
    for each in getattr(content, "transforms", ())[:1]:
        return str(each.header.frame_id), str(each.child_frame_id)
    return ()


def header_stamp(content: Any) -> float:
    """Header stamp of a message or of its first transform; 0 if there is none."""
    for part in (content, *getattr(content, "transforms", ())[:1]):
        stamp = getattr(getattr(part, "header", None), "stamp", None)
        if stamp is not None:
            return float(stamp.sec + stamp.nanosec / 1e9)
    return 0.0


def _judged(header: Floats, received: Floats) -> Stamps:
    stamped = np.isfinite(header)
    has_header = int(stamped.sum()) >= _FEWEST
    if has_header:  # a message without a stamp among others is not used
        header, received = header[stamped], received[stamped]
    gaps = np.diff(received)
    told = np.diff(np.sort(header)) if has_header else gaps  # messages may overtake one another
    after = received - header
    usual = _mean_interval(told)
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


def newest_of_bursts(time: Floats) -> tuple[NDArray[np.bool_], str]:
    """Rows to keep where stamps are of arrival in bursts, shape (n,): the last of each burst.

    What came before it in a burst was measured up to a whole pause earlier than it is stamped.
    Where most come so, all bursts count; else those of a pause that is long enough for its rows.

    Returns
    -------
    keep : ndarray
    told : str
        What was left out, in words; empty if nothing was, or next to nothing.
    """
    gaps = np.abs(np.diff(time))
    keep = np.ones(time.size, dtype=np.bool_)
    mean = _mean_interval(gaps)
    apart = gaps >= _BURST * mean
    if mean >= _SLOW or mean == 0.0:
        return keep, ""
    if apart.mean() < 1.0 - _MOSTLY:
        keep[:-1] = apart
        together = keep.size / keep.sum()
        return keep, f"all come {together:.0f} at a time, of which the last is kept"
    if gaps.size < _TELLING:
        return keep, ""
    usual = float(np.mean(gaps[gaps < _LOST * np.median(gaps[apart])]))
    ends = np.flatnonzero(np.append(gaps >= _HEELS * usual, True))  # the last row of each burst
    waiting = np.diff(ends) - 1  # rows of each burst beside its last
    queued = (waiting > 0) & (waiting <= gaps[ends[:-1]] / usual - _PAUSE)
    for last, rows in zip(ends[1:][queued], waiting[queued], strict=True):
        keep[last - rows : last] = False
    late = int(np.sum(~keep))
    told = f"{late} of {keep.size} waited and came at once, and are left out: they are stamped late"
    return keep, told if late > _TOLD * keep.size else ""


def _mean_interval(intervals: Floats) -> float:
    """Mean interval; the median would be next to nothing where messages come in bursts.

    A silence (between two tests in one file) counts as no more than a pause does.
    """
    if not intervals.size:
        return 0.0
    pause = max(_SLOW, _SILENT * float(np.median(intervals)))
    return float(np.mean(np.minimum(intervals, pause)))


def _spread(intervals: Floats) -> float:
    return 0.5 * float(np.subtract(*np.quantile(intervals, [0.95, 0.05])))
