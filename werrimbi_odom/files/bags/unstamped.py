# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Messages whose header has no stamp, though others of the same sender have one.

A driver that starts before there is a clock stamps its first message with zero. When such a message
was received is a time by another clock than the stamps' where these are of a simulation or of
another computer.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from typing import Any

from werrimbi_odom.files.bags.bag import BagMessage

ONE_CLOCK = 0.1
"""Time from stamp to receipt up to which both are by one clock [s]."""
NEVER_STAMPS = 1000
"""Messages without a stamp, and none with one, from which a sender is taken for one that never
stamps: to wait to the end would hold a whole recording in memory."""


def with_stamps(messages: Iterable[BagMessage], left_out: Counter[str]) -> Iterator[BagMessage]:
    """Yield messages without those that have no stamp while others of their sender have one.

    Where receipt is by the clock of the stamps, it stands for a stamp that lacks, and all come. Of
    a sender that never stamps, all come, at the end or from `NEVER_STAMPS` on: times of receipt are
    used then. `left_out` counts what does not come by topic.
    """
    one_clock: dict[tuple[Any, ...], bool] = {}
    waiting: dict[tuple[Any, ...], list[BagMessage]] = {}
    for message in messages:
        header = getattr(message.content, "header", None)
        if header is None:
            yield message
            continue
        # Several nodes send joints to one topic; each has its own stamps, or none.
        names = getattr(message.content, "name", ())
        sender = (message.topic, getattr(header, "frame_id", ""), *names)
        stamp = header.stamp.sec + header.stamp.nanosec / 1e9
        if stamp:
            one_clock[sender] = abs(message.received / 1e9 - stamp) <= ONE_CLOCK
            if sender in waiting:
                before = waiting.pop(sender)
                if one_clock[sender]:
                    yield from before
                else:
                    left_out[message.topic] += len(before)
            yield message
        elif one_clock.get(sender):
            yield message
        elif sender in one_clock:
            left_out[message.topic] += 1
        else:
            waiting.setdefault(sender, []).append(message)
            if len(waiting[sender]) >= NEVER_STAMPS:
                one_clock[sender] = True
                yield from waiting.pop(sender)
    for each in waiting.values():
        yield from each


def unstamped_words(left_out: Counter[str]) -> tuple[str, ...]:
    """What was left out, in words."""
    return tuple(
        f"{topic}: {count} of its messages {'has' if count == 1 else 'have'} no stamp in the "
        "header, while others do; left out"
        for topic, count in left_out.items()
        if count
    )
