# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`history`: drives over weeks or months in order of date, and when a parameter changed.

Each drive is read, fitted separately, and reduced to a few numbers, which are cached by the content
of its files. So ten thousand drives need no more memory than one, and for an additional drive only
that drive is read.
"""

from __future__ import annotations

import json
import warnings
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from functools import cache as cached
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from werrimbi_odom.api.drives import Drives, Options, collection_of, how_of, refuse_circles
from werrimbi_odom.api.one_blas_thread import with_one_blas_thread
from werrimbi_odom.api.result import Result
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.content_hash import code_mark, mark_of, written_at
from werrimbi_odom.files.recordings import DriveOptions, gathered, reference_of_each, refuse_twice
from werrimbi_odom.files.robot_files.robot_file import RobotFile, robot_file_of_text
from werrimbi_odom.files.run import Run
from werrimbi_odom.files.text_files import replacing
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.changes.dated_drives import Dated, History, Unusable, in_order
from werrimbi_odom.inference.changes.drive_estimate import DriveEstimate, estimate_of_drive
from werrimbi_odom.inference.changes.history import course_of
from werrimbi_odom.progress import Show, silent

if TYPE_CHECKING:
    from typing_extensions import Unpack


@dataclass(frozen=True)
class DriveTask:
    """A drive to process; can be sent to another process."""

    run: Path
    robot: Path
    text: str
    """Of the robot file."""
    how: DriveOptions
    """With the reference of this drive only."""
    keep: Path | None
    """Cache file for the result."""


Looked = Dated | Unusable
"""A processed drive, successful or not."""

Spread = Callable[[Sequence[DriveTask]], Iterable[Looked]]
"""Processes tasks, in any order."""


def history(
    robot: RobotFile,
    runs: Drives,
    *,
    like: RobotFile | None = None,
    cache: str | Path | None = None,
    spread: Spread | None = None,
    show: Show = silent,
    **options: Unpack[Options],
) -> Result[History]:
    """Estimate the parameters of a robot over its drives, and when they changed.

    Parameters
    ----------
    like
        A sound robot of the same kind, or this one when it was sound, for comparison.
    cache
        Folder for the results of drives, by the content of their files. None: no cache.
    spread
        Processes drives, for example in several processes. None: one after the other.
    show
        Callback for progress.

    Raises
    ------
    InputError
        If no drive is usable; the message gives the reason for the first.
    """
    how = how_of(**options)
    given = [runs] if isinstance(runs, Run | str | Path) else list(runs)
    if not given:
        raise InputError("no drives were given")
    refuse_twice(each if isinstance(each, Run) else Path(each) for each in given)
    paths = [Path(each) for each in given if not isinstance(each, Run)]
    found: list[Looked] = [_told_of(each, robot, how) for each in given if isinstance(each, Run)]
    found += _known_or_done(
        _tasks(paths, robot, how, cache), spread or partial(map, told_of_task), show
    )
    unusable = [each for each in found if isinstance(each, Unusable)]
    drives = in_order(_as_given([each for each in found if isinstance(each, Dated)], given))
    if not drives:
        raise InputError(f"no drive can be used; {unusable[0].run}: {unusable[0].why}")
    show(1.0, "putting the drives together")
    time = np.array([drive.date for drive in drives])
    course = course_of([drive.estimate for drive in drives], robot.robot, time)
    against = None if like is None else like.robot
    told = History(robot.robot, drives, course, tuple(unusable), against)
    from werrimbi_odom.report.history import document_of, json_of

    return Result(
        found=told, document=lambda: document_of(told), figures_of_json=lambda: json_of(told)
    )


def _told_of(run: Run, robot: RobotFile, how: DriveOptions) -> Looked:
    """Process a drive that was read already."""
    try:
        return _looked_at(run, robot, how)
    except InputError as error:
        return _unusable(run.path, error)


def told_of_task(task: DriveTask) -> Looked:
    """Process a drive, and cache the result."""
    try:
        effects = task.how.effects
        robot = _parsed(task.robot, task.text, effects, mark_of(effects))
        found = _looked_at(task.run, robot, task.how)
    except (InputError, OSError) as error:
        return _unusable(task.run, error)
    if task.keep is not None:
        with suppress(InputError), replacing(task.keep) as file:  # else it is processed again
            json.dump(_plain(found.estimate), file)
    return found


def unusable_task(task: DriveTask, why: str) -> Unusable:
    """A drive that could not be processed."""
    return _unusable(task.run, why)


def _unusable(run: Path, why: object) -> Unusable:
    return Unusable(run, " ".join(str(why).removeprefix(f"{run}: ").split()))


@with_one_blas_thread
def _looked_at(run: Run | Path, robot: RobotFile, how: DriveOptions) -> Dated:
    collection = _collected(how.effects, mark_of(how.effects))
    given = gathered(robot, collection, [run], (), how)
    for words in refuse_circles(given):
        warnings.warn(words, stacklevel=2)
    told = estimate_of_drive(given.runs[0], given.robot, given.evaluation)
    return _dated(given.runs[0].path, told)


def _tasks(
    paths: Sequence[Path], robot: RobotFile, how: DriveOptions, cache: str | Path | None
) -> list[DriveTask]:
    references = reference_of_each(paths, how.references)
    folder = None if cache is None else Path(cache)
    with suppress(OSError):
        if folder is not None:
            folder.mkdir(parents=True, exist_ok=True)
    common = replace(how, references=(), effects=())
    values = repr(sorted(robot.values.items()))  # also joints and frames, which a bag is read by
    words = (repr(common), repr(robot.robot), values, code_mark())
    found = []
    for path, reference in zip(paths, references, strict=True):
        own = (path,) if reference is None else (path, reference)
        keep = None
        if folder is not None:
            with suppress(OSError):  # unreadable files are reported when the drive is processed
                keep = folder / f"{mark_of((*own, *how.effects), *words)}.json"
        of_drive = replace(how, references=own[1:])
        found.append(DriveTask(path, robot.path, robot.text, of_drive, keep))
    return found


def _known_or_done(tasks: Sequence[DriveTask], spread: Spread, show: Show) -> list[Looked]:
    found: list[Looked] = []
    left = []
    for task in tasks:
        told = _kept(task.keep)
        if told is None:
            left.append(task)
        else:
            found.append(replace(_dated(task.run, told), kept=True))
    for number, each in enumerate(spread(left) if left else ()):
        found.append(each)
        show((number + 1) / len(left), f"{number + 1} of {len(left)} drives")
    return found


def _dated(run: Path, told: DriveEstimate) -> Dated:
    if told.begin > rules.DATED:
        return Dated(run, told, told.begin, "stamp")
    try:
        return Dated(run, told, written_at(run), "file")
    except OSError:
        return Dated(run, told, 0.0, "order")


def _as_given(drives: Sequence[Dated], given: Sequence[Run | str | Path]) -> list[Dated]:
    places = {str(each.path if isinstance(each, Run) else each): n for n, each in enumerate(given)}
    return sorted(drives, key=lambda drive: places.get(str(drive.run), 0))


@cached
def _collected(effects: tuple[Path, ...], content: str) -> Any:
    return collection_of(effects)


@cached
def _parsed(robot: Path, text: str, effects: tuple[Path, ...], content: str) -> RobotFile:
    return robot_file_of_text(text, robot, _collected(effects, content).find)


def _plain(told: DriveEstimate) -> dict[str, Any]:
    return {
        name: value.tolist() if isinstance(value, np.ndarray) else value
        for name, value in asdict(told).items()
    }


def _kept(place: Path | None) -> DriveEstimate | None:
    if place is None:
        return None
    try:
        values = json.loads(place.read_text(encoding="utf-8"))
        return DriveEstimate(
            tuple(values["names"]),
            np.array(values["information"]),
            np.array(values["weighted"]),
            *(values[name] for name in ("begin", "data", "way")),
        )
    except (OSError, ValueError, KeyError, TypeError):
        return None  # missing or damaged: processed again
