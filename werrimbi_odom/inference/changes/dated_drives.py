# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Drives with their dates, and the history that they make: the course of a robot's parameters."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.changes.drive_estimate import DriveEstimate
from werrimbi_odom.inference.changes.history import Course
from werrimbi_odom.model.robot import Robot

DateFrom = Literal["stamp", "file", "order"]
"""Source of a date: first message, file system, or none (the order of the drives)."""


@dataclass(frozen=True)
class Unusable:
    """A drive that cannot be used, with the reason."""

    run: Path
    why: str


@dataclass(frozen=True)
class Dated:
    """A drive with its date and its information."""

    run: Path
    estimate: DriveEstimate
    date: float
    """Date [s since 1970]; the number of the drive if it is unknown."""
    date_from: DateFrom
    kept: bool = False
    """Whether it is from the cache."""


@dataclass(frozen=True)
class History:
    """The course of a robot's parameters over its drives."""

    robot: Robot
    drives: tuple[Dated, ...]
    """In the order of their dates."""
    course: Course
    unusable: tuple[Unusable, ...] = ()
    like: Robot | None = None
    """Robot to compare with."""

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the drives; with their folders if some names are equal."""
        names = [drive.run.name for drive in self.drives]
        if len(set(names)) == len(names):
            return tuple(names)
        return tuple(str(drive.run) for drive in self.drives)


def in_order(drives: Sequence[Dated]) -> tuple[Dated, ...]:
    """Sort by date; keep the given order if the dates are those of copied files."""
    dates = [drive.date for drive in drives]
    copied = any(drive.date_from != "stamp" for drive in drives)
    if dates and copied and max(dates) - min(dates) < rules.COPIED_WITHIN:
        return tuple(
            replace(drive, date=float(number), date_from="order")
            for number, drive in enumerate(drives)
        )
    return tuple(sorted(drives, key=lambda drive: drive.date))
