# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Data for a worker without a shared disk: a robot's files, and the required code version.

In the results, temporary paths are replaced by those of the user.
"""

from __future__ import annotations

import json
import os
import pickle
import platform
import tempfile
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from importlib.metadata import PackageNotFoundError, entry_points, version
from pathlib import Path

from werrimbi_odom.effects.lookup import GROUP
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.content_hash import code_mark, files_of
from werrimbi_odom.files.recordings import Asked
from werrimbi_odom.fleet.robot_task import Task, row_of
from werrimbi_odom.report.fleet import Row

MOST = 2**30
"""Size limit of a robot's files [bytes]; for larger bags, run the diagnosis where they are."""


@dataclass(frozen=True)
class Item:
    """A file, or a folder with the files that its reader uses."""

    path: str
    """As given by the user."""
    name: str
    files: Mapping[str, bytes] | bytes | None
    """None if it does not exist: the worker then reports the same error as this machine."""


@dataclass(frozen=True)
class Parcel:
    """A task with all its files."""

    name: str
    asked: Asked
    items: tuple[Item, ...]
    """Robot file, effect files, separate references, runs, held-out runs."""


def packed(task: Task) -> bytes:
    """Serialise a task and its files.

    InputError if a file cannot be read, or they are too large.
    """
    asked = task.asked
    how = asked.how
    paths = [asked.robot, *how.effects, *how.references, *asked.runs, *asked.holdout]
    room = MOST
    items = []
    for path in paths:
        try:
            size = sum(file.stat().st_size for file in files_of(path))
            room -= size
            if room < 0:
                raise InputError(
                    f"{path}: the files of {task.name} are larger than {MOST >> 20} MiB, too large "
                    "to be sent; cut bags to their ticks and reference, or leave out --scheduler"
                )
            items.append(_item(path))
        except (OSError, ValueError) as error:
            if isinstance(error, InputError):
                raise
            raise InputError(f"{path} cannot be read: {error}") from error
    return zlib.compress(pickle.dumps(Parcel(task.name, asked, tuple(items))), 1)


def row_of_parcel(data: bytes) -> Row:
    """Unpack and diagnose; the row has the paths of the user."""
    parcel: Parcel = pickle.loads(zlib.decompress(data))
    with tempfile.TemporaryDirectory(prefix="werrimbi-") as made:
        folder = Path(os.path.realpath(made))
        places = [_unpacked(item, folder / str(n)) for n, item in enumerate(parcel.items)]
        row = row_of(_moved(parcel, places))
    given = {str(place): item.path for place, item in zip(places, parcel.items, strict=True)}
    return _with_paths(row, given)


def _item(path: Path) -> Item:
    name = path.resolve().name  # a run has the name of its target, also behind a symbolic link
    if path.is_dir():
        return Item(str(path), name, {file.name: file.read_bytes() for file in files_of(path)})
    if not name.endswith(path.suffix):  # readers decide by the given suffix
        name = path.name
    return Item(str(path), name, path.read_bytes() if path.is_file() else None)


def _unpacked(item: Item, folder: Path) -> Path:
    """Below `folder`, in folders of the user's names: they tell drives of one name apart."""
    given = Path(item.path)
    above = [part for part in given.parts[:-1] if part not in (given.anchor, "..")]
    place = folder.joinpath(*above, item.name)
    place.parent.mkdir(parents=True)
    if isinstance(item.files, bytes):
        place.write_bytes(item.files)
    elif item.files is not None:
        place.mkdir()
        for name, content in item.files.items():
            (place / name).write_bytes(content)
    return place


def _moved(parcel: Parcel, places: list[Path]) -> Task:
    """The task with the present paths of its files."""
    asked = parcel.asked
    rest = iter(places)

    def as_many_as(paths: tuple[Path, ...]) -> tuple[Path, ...]:
        return tuple(next(rest) for _ in paths)

    robot = next(rest)
    how = asked.how
    how = replace(how, effects=as_many_as(how.effects), references=as_many_as(how.references))
    runs, holdout = as_many_as(asked.runs), as_many_as(asked.holdout)
    return Task(parcel.name, Asked(robot, runs, holdout, how))


def _with_paths(row: Row, given: Mapping[str, str]) -> Row:
    """The row with the user's paths in its texts."""
    error, figures = row.error, row.figures
    text = json.dumps(figures)
    for place, path in given.items():
        error = error.replace(place, path)
        text = text.replace(json.dumps(place)[1:-1], json.dumps(path)[1:-1])
    return replace(row, error=error, figures=json.loads(text))


PACKAGE = "werrimbi_odom"
EFFECTS = "installed effects"
_DECIDES = (PACKAGE, EFFECTS)
"""Entries that must be equal; the others may change the last digits."""


@cache
def code_here() -> Mapping[str, str]:
    """Names and versions of this package (with a digest of its code) and of its dependencies."""
    offered = (
        f"{point.name} ({point.dist.name} {point.dist.version})" if point.dist else point.name
        for point in entry_points(group=GROUP)
    )
    return {
        PACKAGE: f"{_version(PACKAGE)} (code {code_mark()})",
        EFFECTS: ", ".join(sorted(offered)) or "none",
        "Python": platform.python_version(),
        "numpy": _version("numpy"),
        "scipy": _version("scipy"),
    }


def refusal(here: Mapping[str, str], there: Mapping[str, str]) -> str:
    """Differences for which results would not be comparable; "" for none."""
    return _differences(_DECIDES, here, there)


def doubts(here: Mapping[str, str], there: Mapping[str, str]) -> str:
    """Differences that may change the last digits; "" for none."""
    return _differences([name for name in here if name not in _DECIDES], here, there)


def _differences(names: Sequence[str], here: Mapping[str, str], there: Mapping[str, str]) -> str:
    return "; ".join(
        f"{name} {there.get(name, 'none')}, here {here[name]}"
        for name in names
        if there.get(name) != here[name]
    )


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "not installed" if name != PACKAGE else "from a checkout"
