# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The robots of a fleet from its folder: one sub-folder each, with robot.yaml and drives."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.bags.bag import SUFFIXES
from werrimbi_odom.files.recordings import BAG, refuse_twice
from werrimbi_odom.files.run_folder import TICKS
from werrimbi_odom.files.text_files import readable

ROBOT = "robot.yaml"
TRAIN, RUNS, HOLDOUT = "train", "runs", "holdout"
_LAYOUT = f"each robot is a sub-folder with {ROBOT} and its runs (in {TRAIN}/ and {HOLDOUT}/)"


@dataclass(frozen=True)
class Member:
    """A robot of the fleet; its files are not read yet."""

    name: str
    robot: Path
    runs: tuple[Path, ...]
    """In the order of a shell's listing."""
    holdout: tuple[Path, ...] = ()
    problem: str = ""
    """Why it cannot be diagnosed; "" if it can be tried."""


def members_of(fleet: Path) -> tuple[Member, ...]:
    """The robots in a folder in natural order, robot_2 before robot_10.

    Folders with neither a robot file nor runs are ignored; one with only one of them is a robot
    with a problem. InputError if it is no folder, has no robot, or no robot in it has a run.
    """
    try:
        if not fleet.is_dir():
            raise InputError(f"--fleet {fleet}: there is no such folder")
        folders = [each for each in _seen(fleet) if each.is_dir()]
    except (OSError, ValueError) as error:  # ValueError: a NUL byte in the name
        if isinstance(error, InputError):
            raise
        raise InputError(f"--fleet {fleet} cannot be read: {error}") from error
    members = tuple(
        member
        for folder in sorted(folders, key=lambda folder: natural(folder.name))
        if (member := _member(folder)) is not None
    )
    if (fleet / ROBOT).is_file() and not any(member.robot.exists() for member in members):
        raise InputError(
            f"--fleet {fleet} is one robot ({ROBOT} lies in it); give the folder above it, or "
            f"--robot {fleet / ROBOT} and its runs"
        )
    if not members:
        raise InputError(f"--fleet {fleet}: no robot is in it; {_LAYOUT}")
    if all(member.problem for member in members):
        raise InputError(f"--fleet {fleet}: no robot in it is complete: {members[0].problem}")
    return members


def natural(name: str) -> tuple[Any, ...]:
    """Sort key for natural order, in which digits compare as numbers."""
    parts = re.split(r"(\d+)", name)  # text and digits alternate, text first
    return tuple(int(part) if number % 2 else part for number, part in enumerate(parts))


def _member(folder: Path) -> Member | None:
    try:
        return _looked_at(folder)
    except OSError as error:
        problem = f"{folder} cannot be read: {error.strerror}"
        return Member(readable(folder.name), folder / ROBOT, (), problem=problem)


def _looked_at(folder: Path) -> Member | None:
    robot = folder / ROBOT
    runs = [path for path in _seen(folder) if is_run(path)]
    runs += [path for name in (RUNS, TRAIN) for path in _drives(folder / name)]
    holdout = _drives(folder / HOLDOUT)
    there = robot.exists() or robot.is_symlink()
    if not (there or runs or holdout):
        return None
    problem = ""
    if not there:
        problem = f"{folder} holds runs but no {ROBOT}"
    elif not runs and not holdout:
        problem = f"{folder} holds no runs; put them in {folder / TRAIN}, or beside {ROBOT}"
    elif not runs:
        problem = f"all runs of {folder} are in {HOLDOUT}/; the fit needs some in {TRAIN}/"
    else:
        try:
            refuse_twice([*runs, *holdout])
        except InputError as error:
            problem = str(error)
    return Member(readable(folder.name), robot, tuple(runs), tuple(holdout), problem)


def is_run(path: Path) -> bool:
    """Whether a path looks like a recorded drive."""
    if not path.is_dir():
        return path.suffix in SUFFIXES
    return any(each.name in (TICKS, BAG) or each.suffix in SUFFIXES for each in path.iterdir())


def _drives(folder: Path) -> list[Path]:
    """All entries that should be runs, so that one without its ticks.csv is reported."""
    if not folder.is_dir():
        return []
    return [path for path in _seen(folder) if path.is_dir() or path.suffix in SUFFIXES]


def _seen(folder: Path) -> Iterable[Path]:
    return sorted(path for path in folder.iterdir() if not path.name.startswith("."))
