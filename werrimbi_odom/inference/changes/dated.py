# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The history of a robot: its drives with their dates, and how its numbers went over them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

from werrimbi_odom.inference.changes.history import Course, DriveTold
from werrimbi_odom.inference.rules import COPIED_WITHIN
from werrimbi_odom.model.robot import Robot

DateFrom = Literal["stamp", "file", "order"]
"""Of the first message; of the file system; none: as the drives were given."""


@dataclass(frozen=True)
class Unusable:
    """A drive that tells nothing, and why."""

    run: Path
    why: str


@dataclass(frozen=True)
class Dated:
    """A drive that was looked at."""

    run: Path
    told: DriveTold
    date: float
    """[s since 1970]; the number of the drive where nobody knows."""
    date_from: DateFrom
    kept: bool = False
    """Whether it was known before."""


@dataclass(frozen=True)
class History:
    """How a robot went."""

    robot: Robot
    drives: tuple[Dated, ...]
    """In the order of their dates."""
    course: Course
    unusable: tuple[Unusable, ...] = ()
    like: Robot | None = None
    """What it is held against."""

    @property
    def names(self) -> tuple[str, ...]:
        """Of the drives; with their folders where several are called the same."""
        names = [drive.run.name for drive in self.drives]
        if len(set(names)) == len(names):
            return tuple(names)
        return tuple(str(drive.run) for drive in self.drives)


def in_order(drives: Sequence[Dated]) -> tuple[Dated, ...]:
    """By their dates; in the order given where files that were copied are all that tells one."""
    dates = [drive.date for drive in drives]
    copied = any(drive.date_from != "stamp" for drive in drives)
    if dates and copied and max(dates) - min(dates) < COPIED_WITHIN:
        return tuple(
            replace(drive, date=float(number), date_from="order")
            for number, drive in enumerate(drives)
        )
    return tuple(sorted(drives, key=lambda drive: drive.date))
