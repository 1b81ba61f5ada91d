# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Stamps of a recording in words: which clock is believed, and how far clocks are apart."""

from __future__ import annotations

from collections.abc import Iterator

from werrimbi_odom.files.bags.bag_chain import POSTDATED
from werrimbi_odom.files.bags.stamps import Stamps
from werrimbi_odom.inference.recording_info import Held
from werrimbi_odom.report.number_format import TIME_OF_DAY, counted

_WANDERS = 0.1  # reported variation of the delay from stamp to receipt [s]
_BY_HAND = ("carried", "held")


def stamps_words(held: Held) -> Iterator[str]:
    """Which clocks are believed, and how evenly they run."""
    for name, stamps in held.stamps.items():
        chosen = [held.wheels and held.wheels.name, *held.topics]
        if any(each and name in (*each.split(","), each.partition(":")[0]) for each in chosen):
            yield clock_words(name, stamps)
    yield from _apart(held)


def clock_words(name: str, stamps: Stamps) -> str:
    """Which clock a topic is believed by, and why."""
    if stamps.jitter is None:
        words = (
            f"{name} has no stamps: the times of receipt are used, whose intervals vary by "
            f"± {milliseconds(stamps.received_jitter)}"
        )
    else:
        own, receipt = milliseconds(stamps.jitter), milliseconds(stamps.received_jitter)
        pair = f"± {own} against ± {receipt} of receipt"
        if stamps.alike:
            both = own if own == receipt else f"{own} and {receipt}"
            words = (
                f"Stamps of {name}: the headers are used; by their evenness either clock will do "
                f"(intervals vary by ± {both})"
            )
        elif stamps.believed == "header":
            words = f"Stamps of {name}: believe the headers, whose intervals vary by {pair}"
        else:
            words = (
                f"Stamps of {name}: the headers are used, though their intervals vary by {pair}: "
                "the times of receipt are the evener"
            )
        if abs(stamps.offset or 0.0) > TIME_OF_DAY:
            apart = "they are of another clock than receipt (a simulation's, or one that began"
            return f"{words}; {apart} when a computer was switched on)."
        if (stamps.wander or 0.0) > _WANDERS:
            words += (
                f"; from stamp to receipt it takes {stamps.offset:.2g} s as a rule and "
                f"{stamps.latest:.2g} s at most, and wanders by {stamps.wander:.2g} s"
            )
            if (stamps.offset or 0.0) < 0.0:
                words += " (negative: two clocks that differ)"
    extras = []
    if stamps.bursts > 0.01:
        extras.append(f"{100 * stamps.bursts:.0f} % come together with the one before")
    if stamps.late > 0.01:
        extras.append(f"{100 * stamps.late:.0f} % are late by a tenth of a second and more")
    if stamps.back:
        extras.append(f"the stamps go back {counted(stamps.back, 'time')}")
    return f"{words}{'; ' if extras else ''}{', '.join(extras)}."


def _apart(held: Held) -> Iterator[str]:
    both = (each for each in (held.wheels, held.reference) if each is not None)
    names = [each.name.split(",")[0].partition(":")[0] for each in both]
    offsets = [held.stamps[name].offset for name in names if name in held.stamps]
    if len(offsets) == 2 and offsets[0] is not None and offsets[1] is not None:
        apart = offsets[0] - offsets[1]
        if apart > POSTDATED and held.reference is not None and held.reference.through_wheels:
            yield (
                f"The reference's transforms are stamped {apart:.3g} s ahead of the wheels, by "
                "when both were received: a localiser's transform_tolerance, or a clock. They are "
                "set back by that, or the odometry of that time would be in each of its poses. "
                "Better still are the localiser's own poses (/amcl_pose): record them too."
            )
        elif abs(apart) > _WANDERS:
            yield (
                f"Their clocks are apart: the reference's stamps are {abs(apart):.3g} s "
                f"{'later' if apart > 0 else 'earlier'} than those of the wheels, by when both "
                f"were received.{_mixed_up(held)}"
            )


def milliseconds(seconds: float) -> str:
    """A time in words."""
    return f"{1e3 * seconds:.{1 if 0.05 <= 1e3 * seconds < 0.95 else 0}f} ms"


def _mixed_up(held: Held) -> str:
    """What clocks that are apart make of a robot that starts and stops."""
    if held.driven is None or not any(each.what in _BY_HAND for each in held.driven.spans):
        return ""
    return (
        " So a robot that starts or stops may look carried or held below; `diagnose` finds the "
        "delay, and judges without it."
    )
