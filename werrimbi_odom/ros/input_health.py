# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""State of the input, for /diagnostics: rates, rejections with their cause, silent topics."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus

from werrimbi_odom.model.encoder_online import EncoderTally
from werrimbi_odom.ros.diagnostics import diagnostic

OK, WARN = DiagnosticStatus.OK, DiagnosticStatus.WARN
ERROR, STALE = DiagnosticStatus.ERROR, DiagnosticStatus.STALE

_OTHERS = 8
"""Joints that are named in a message, at most."""

OF_POSE, NOT_LEARNT = "refused set_pose", "not learnt from"
_REFUSED = {"refused": "input refused", OF_POSE: "set_pose refused", NOT_LEARNT: NOT_LEARNT}
"""What is rejected, as it is counted and as it is logged."""
_BY_CAUSE = tuple(f"{what}: " for what in _REFUSED)
_WORTH_A_WARNING = ("resets", "jumps", "implausible", "clock jumps", "out of order", "gaps")
_UNUSABLE = {
    "duplicates": "their stamps stand still",
    "out of order": "older than the last",
    "not finite": "no numbers",
    "implausible": "faster than max_wheel_speed",
    "unpaired": "left and right farther apart than pairing_window",
}
"""Readings that yield no odometry, with the cause if all readings are of this kind."""
MISSED = 0.1
"""Share of published messages that were not received from which a warning is given: a lost message
loses no motion, and a radio link loses some."""


class Health:
    """Counts since the start of the node, and their evaluation over the last second.

    The first rejection of each cause is logged; the rest is only counted. A topic counts as silent
    `silent_after` seconds without a message.
    """

    def __init__(self, logger: Any, topics: tuple[str, ...], silent_after: float) -> None:
        self.silent_after = silent_after
        self.published = 0
        self.unstamped = 0
        self.foreign = 0
        self.doubts: list[str] = []
        """What the input is suspected of, in words; reported until the node ends."""
        self._others: dict[str, None] = {}
        self._logger = logger
        self._topics = topics
        self._heard = [0] * len(topics)
        self._heard_at = [-float("inf")] * len(topics)
        self._answered = [0] * len(topics)
        self._numbers = [_Numbers() for _ in topics]
        self._missed = 0
        self._refused: dict[str, Counter[str]] = {what: Counter() for what in _REFUSED}
        self._lost = 0
        self._before: dict[str, int] = {}
        self._reported_at = time.monotonic()

    def meet(self, others: Sequence[str]) -> None:
        """Remember joints of messages that hold none of ours."""
        self._others |= dict.fromkeys(others[:_OTHERS])

    def hear(self, topic: int, info: Mapping[str, Any], *, ours: bool = True) -> None:
        """Count a message, with its DDS sequence number."""
        self._numbers[topic].take(info.get("publication_sequence_number"))
        if not ours:
            self.foreign += 1
            return
        self._heard[topic] += 1
        self._heard_at[topic] = time.monotonic()

    def refuse(self, cause: str, detail: str, what: str = "refused") -> None:
        """Count a message that was rejected: of the input, or one of the other `_REFUSED`."""
        tally = self._refused[what]
        if cause not in tally:
            words = f"{_REFUSED[what]}: {cause}: {detail}"
            self._logger.warning(f"{words} (from now on only counted on /diagnostics)")
        tally[cause] += 1

    def lose(self, event: Any) -> None:
        """Store the number of input messages lost by DDS."""
        self._lost = event.total_count

    def report(
        self,
        name: str,
        tally: EncoderTally,
        inputs: Mapping[str, int],
        effects: Mapping[str, str] | None = None,
        crowded: Collection[str] = (),
        wrong: Sequence[str] = (),
    ) -> DiagnosticStatus:
        """Create the status, with the rates since the last report.

        It tells the tally of the model's encoder, further counters of the input, each physical
        effect with its values, input topics with several publishers (`crowded`), and other problems
        in words.
        """
        now = time.monotonic()
        for topic, numbers in zip(self._topics, self._numbers, strict=True):
            self._missed += numbers.missed(alone=topic not in crowded)
        counts = self._counts(tally, inputs)
        new = Counter(counts)
        new.subtract(self._before)
        elapsed = max(now - self._reported_at, 1e-9)
        self._before, self._reported_at = counts, now
        rates = {
            "input rate": f"{new['messages'] / elapsed:.1f} Hz",
            "output rate": f"{new['published'] / elapsed:.1f} Hz",
        }
        level, words = self._verdict(now, new, [*wrong, *self.doubts])
        if new["published"]:
            self._answered = list(self._heard)
        told = rates | counts | dict(effects or {})
        words = words or f"{rates['input rate']} in, {rates['output rate']} out"
        return diagnostic(level, name, words, told)

    def _counts(self, tally: EncoderTally, inputs: Mapping[str, int]) -> dict[str, int]:
        heard = {
            f"messages on {topic}": n for topic, n in zip(self._topics, self._heard, strict=True)
        }
        return {
            "messages": sum(self._heard),
            **(heard if len(heard) > 1 else {}),
            "messages of other joints": self.foreign,
            "lost by DDS": self._lost,
            "never taken": self._missed,
            "without stamp": self.unstamped,
            **inputs,
            "published": self.published,
            **{
                event.replace("_", " "): count
                for event, count in tally.as_dict().items()
                if event not in ("messages", "accepted")
            },
            **dict(self._rejections()),
        }

    def _rejections(self) -> Iterator[tuple[str, int]]:
        """Names and counts: of each kind in all, and by cause."""
        for what, tally in self._refused.items():
            if what != NOT_LEARNT:
                yield what, tally.total()
            for cause, count in tally.items():
                yield f"{what}: {cause}", count

    def _verdict(
        self, now: float, new: Mapping[str, int], wrong: Sequence[str]
    ) -> tuple[bytes, str]:
        """Level and message; no message if all is well."""
        silences = [now - at for at in self._heard_at]
        silent = [
            f"{topic} {_for(silence)}"
            for topic, silence in zip(self._topics, silences, strict=True)
            if silence > self.silent_after
        ]
        if len(silent) == len(silences):
            foreign = new["messages of other joints"]
            if foreign and not any(self._heard):
                names = ", ".join([*self._others][:_OTHERS])
                return ERROR, (
                    f"no odometry: {self._topics[0]} has {names}, and none of the joints in "
                    "left_wheel_names and right_wheel_names"
                )
            messages = "message" if foreign == 1 else "messages"
            but = f"; {foreign} {messages} of other joints came" if foreign else ""
            return STALE, f"no input: {', '.join(silent)}{but}"
        if silent:
            return ERROR, f"no odometry without both wheels: {silent[0]}"
        refusals = [
            f"{key.removeprefix('refused: ')} ({n})"
            for key, n in new.items()
            if n > 0 and key.startswith(_BY_CAUSE)
        ]
        # One message more than answered is normal: the first one only starts an interval.
        unanswered = (a - b for a, b in zip(self._heard, self._answered, strict=True))
        if not new["published"] and min(unanswered) > 1:
            useless = [
                f"{key} ({new[key]}), {means}" for key, means in _UNUSABLE.items() if new[key]
            ]
            causes = "; ".join([*refusals, *useless, *wrong])
            return ERROR, f"no odometry, all input is refused: {causes}"
        events = [f"{key} ({new[key]})" for key in _WORTH_A_WARNING if new[key] > 0]
        if new["never taken"] > MISSED * (new["never taken"] + new["messages"]):
            events.append(f"never taken ({new['never taken']}): more than this node keeps up with")
        happened = ", ".join(refusals + events)
        words = [f"in the last second: {happened}"] if happened else []
        return (WARN, "; ".join([*words, *wrong])) if words or wrong else (OK, "")


class _Numbers:
    """Sequence numbers of a topic's publisher; a gap is a message that was not received.

    If messages arrive faster than they are taken, DDS drops the oldest and reports no loss.
    """

    def __init__(self) -> None:
        self._last: int | None = None
        self._left_out = 0
        self._began_anew = False

    def take(self, number: int | None) -> None:
        """Add a number; None if the middleware gives none."""
        if number is None:
            return
        if self._last is not None and number > self._last:
            self._left_out += number - self._last - 1
        elif self._last is not None:
            self._began_anew = True
        self._last = number

    def missed(self, alone: bool) -> int:
        """Messages missed since the last call; unknown, so 0, with several publishers."""
        missed = self._left_out if alone and not self._began_anew else 0
        self._left_out, self._began_anew = 0, False
        return missed


def _for(silence: float) -> str:
    return "never heard" if silence == float("inf") else f"silent for {silence:.1f} s"
