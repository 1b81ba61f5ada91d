# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The interval of the twist: the last step, or the last few where messages come much too early.

A driver that blocks and then sends several messages at once makes steps of a few microseconds, and
travel divided by these is no speed. Such a step is combined with those before it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from werrimbi_odom.model.encoder_online import WheelStep
from werrimbi_odom.model.motion import BodyMotion
from werrimbi_odom.model.pace import CLOSE


class MovedStep(NamedTuple):
    """Travel of the wheels over an interval, and the motion of the body."""

    wheels: WheelStep
    motion: BodyMotion[float]

    def and_then(self, later: MovedStep) -> MovedStep:
        """Both in one."""
        _, *earlier = self.wheels
        time, *rest = later.wheels
        sums = (one + more for one, more in zip(earlier, rest, strict=True))
        moved = (one + more for one, more in zip(self.motion, later.motion, strict=True))
        return MovedStep(WheelStep(time, *sums), BodyMotion(*moved))


@dataclass(slots=True)
class TwistInterval:
    """The last steps that make an interval long enough for a speed."""

    _first: MovedStep | None = None
    """The last step that is long enough by itself, or steps that together are."""
    _early: MovedStep | None = None
    """What came after it, much too early."""

    def add(self, step: MovedStep, usual: float) -> MovedStep:
        """Add a step; return what the twist is the mean of. `usual`: the usual interval [s]."""
        if self._first is None or step.wheels.duration >= CLOSE * usual:
            return self.begin(step)
        self._early = step if self._early is None else self._early.and_then(step)
        if self._early.wheels.duration >= usual:  # not a burst: messages come faster than before
            return self.begin(self._early)
        return self._first.and_then(self._early)

    def begin(self, step: MovedStep) -> MovedStep:
        """Begin anew with a step that is long enough."""
        self._first, self._early = step, None
        return step
