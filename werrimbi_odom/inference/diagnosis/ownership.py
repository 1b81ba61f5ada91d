# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What an effect looks at and what it acts on, found by trying it: nobody has to declare it."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from werrimbi_odom.inference.fitting.candidates import Candidate
from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.motion import BodyMotion, WheelTravel
from werrimbi_odom.model.pose import Floats


class Grasp(NamedTuple):
    """How far an effect's law reaches."""

    fields: frozenset[str]
    """Quantities of `Drive`, and extra channels, that it looks at."""
    channels: frozenset[str]
    """Errors that it can explain: left, right, along, sideways, heading."""


class _Watched:
    """A `Drive` that remembers what was asked of it."""

    def __init__(self, drive: Drive[Floats]) -> None:
        self._drive = drive
        self.asked: set[str] = set()

    def __getattr__(self, name: str) -> Any:
        value = getattr(self._drive, name)
        if name == "channels":
            return _WatchedChannels(value, self.asked)
        self.asked.add(name)
        return value


class _WatchedChannels(dict[str, Any]):
    def __init__(self, channels: Any, asked: set[str]) -> None:
        super().__init__(channels)
        self._asked = asked

    def __getitem__(self, name: str) -> Any:
        self._asked.add(name)
        return super().__getitem__(name)


def grasp_of(candidate: Candidate, drive: Drive[Floats]) -> Grasp:
    """What a candidate looks at and acts on, tried on the steps of recorded runs."""
    effect = candidate.effect
    if effect.stage not in ("wheels", "body"):
        return Grasp(frozenset(), frozenset())
    watched = _Watched(drive)
    one = np.ones(drive.left_angle.start.shape)
    acts: set[str] = set()
    for coordinate in candidate.coordinates:
        values = candidate.with_value(coordinate, 1.0).values
        if effect.stage == "wheels":
            before = WheelTravel(one, one)
            after = effect.apply(before, watched, **values)
            left = not np.allclose(after.left, one, rtol=0.0, atol=1e-15)
            right = not np.allclose(after.right, one, rtol=0.0, atol=1e-15)
            acts |= {"left"} if left and not right else {"right"} if right and not left else set()
            acts |= {"left", "right", "along", "heading"} if left and right else set()
        else:
            motion = BodyMotion(one, one, one)
            moved = effect.apply(motion, watched, **values)
            for name, part in zip(("along", "sideways", "heading"), moved, strict=True):
                if not np.allclose(part, one, rtol=0.0, atol=1e-15):
                    acts.add(name)
    return Grasp(frozenset(watched.asked), frozenset(acts))
