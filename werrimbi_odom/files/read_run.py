# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Reads a run of any kind: a folder with ticks.csv, a rosbag2 folder, a single bag file."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.bags.bag import SUFFIXES, named_files
from werrimbi_odom.files.bags.echoed_topics import echoed_files
from werrimbi_odom.files.bags.reference_choice import NONE
from werrimbi_odom.files.bags.unfinished_bag import ending
from werrimbi_odom.files.held_counts import without_held_counts
from werrimbi_odom.files.references.half_turns import without_half_turns
from werrimbi_odom.files.references.stated_noise import without_wrong_noise
from werrimbi_odom.files.robot_files.robot_file import RobotFile
from werrimbi_odom.files.run import Run
from werrimbi_odom.files.run_bag import (
    FoundReference,
    Progress,
    Topics,
    read_reference_bag,
    read_run_bag,
)
from werrimbi_odom.files.run_folder import (
    REFERENCE,
    REFERENCE_COLUMNS,
    TICKS,
    TICKS_COLUMNS,
    read_reference,
    read_run_folder,
)

_TEXT = (".csv", ".txt", ".dat", ".log", ".tsv", ".clf")
_TABLES = (".mat", ".xls", ".xlsx", ".ods", ".npy", ".npz", ".pkl", ".parquet", ".h5", ".json")
"""Ends of names of logs of other programs."""
FROM_TEXT = (
    f"a log of text is read from a folder of its own with {TICKS} ({','.join(TICKS_COLUMNS)}: "
    "seconds, and counts since the start) and, as far as it was measured, "
    f"{REFERENCE} ({','.join(REFERENCE_COLUMNS)}); docs/recordings.md says how speeds and metres "
    "become counts. What `rostopic echo -p` or bagpy wrote is read as it is"
)


def read_run(
    path: str | Path,
    robot_file: RobotFile,
    *,
    ticks_topic: str | None = None,
    reference_topic: Topics = None,
    reference: str | Path | None = None,
    force: bool = False,
    progress: Progress | None = None,
) -> Run:
    """Read a run; see `read_run_folder` and `read_run_bag`. Topics apply to bags only.

    `reference`: separate recording of the reference of this drive: another bag, or a folder with
    reference.csv. InputError if there is no run at `path`, or it is not usable; the message gives
    place and cause.
    """
    own = reference_topic if reference is None else NONE

    def of_folder(folder: Path) -> Run:
        robot_file.refuse_counts(folder / TICKS)
        return read_run_folder(folder)

    run: Run = _of_kind(
        Path(path),
        of_folder,
        lambda bag: read_run_bag(
            bag,
            robot_file,
            ticks_topic=ticks_topic,
            reference_topic=own,
            force=force,
            progress=progress,
        ),
        TICKS,
    )
    run = without_held_counts(run)
    if reference is not None:
        found: FoundReference = _of_kind(
            Path(reference),
            _reference_folder,
            lambda bag: read_reference_bag(bag, robot_file, reference_topic, force),
            REFERENCE,
        )
        run = replace(
            run,
            reference=found.reference,
            notes=(*run.notes, f"reference from {reference}", *found.notes),
            circle=found.circle,
            damage=(*run.damage, *found.damage),
            no_reference="",
            taken_out=found.taken_out,
        )
    return without_wrong_noise(without_half_turns(run, robot_file.robot.encoder_bits))


def bag_at(path: Path, table: str = TICKS) -> Path | None:
    """The bag of a run; None for a folder with `table`.

    InputError if there is no run at `path`.
    """
    found: Path | None = _of_kind(path, lambda folder: None, lambda bag: bag, table)
    return found


def _reference_folder(folder: Path) -> FoundReference:
    reference, damage = read_reference(folder / REFERENCE)
    return FoundReference(reference, (), damage=tuple(f"{folder}: {each}" for each in damage))


def _of_kind(
    path: Path, of_folder: Callable[[Path], Any], of_bag: Callable[[Path], Any], table: str
) -> Any:
    """Content of a folder with a table, or of a bag."""
    try:
        if path.is_dir():
            if (path / table).exists():
                return of_folder(path)
            bag = _bag_in(path)
        elif path.exists():
            bag = _bag_file(path)
        else:
            raise InputError(f"{path}: there is no such run")
    except (OSError, ValueError) as error:  # ValueError: a NUL byte in the name
        if isinstance(error, InputError):
            raise
        raise InputError(f"{path} cannot be read: {error}") from error
    return of_bag(bag)


def _bag_in(folder: Path) -> Path:
    files = sorted(each for each in folder.iterdir() if ending(each) in SUFFIXES)
    if (folder / "metadata.yaml").exists():
        named = named_files(folder) if len(files) == 1 else []
        renamed = named and not any(file.exists() for file in named)
        return files[0] if renamed else folder
    if files:  # the recorder was killed before it wrote the metadata
        return files[0] if len(files) == 1 else folder
    if echoed_files(folder):
        return folder
    hint = ""
    for below in (*sorted(folder.glob(f"*/{TICKS}")), *sorted(folder.glob("*/metadata.yaml"))):
        hint = f"; did you mean {below.parent}?"
        break
    hint = hint or next(filter(None, map(_hint, sorted(folder.iterdir()))), "")
    raise InputError(f"{folder} holds neither {TICKS} nor a bag (metadata.yaml){hint}")


def _bag_file(path: Path) -> Path:
    if ending(path) in SUFFIXES or echoed_files(path):
        return path
    if path.name == TICKS:
        raise InputError(f"{path}: give the folder that holds it, {path.parent}")
    raise InputError(
        f"{path} is neither a run folder nor a bag ({', '.join(SUFFIXES)}){_hint(path)}"
    )


def _hint(path: Path) -> str:
    """How a log that is no bag is read."""
    kind = path.suffix.lower()
    if kind in (".zstd", ".zst"):
        return f"; it is compressed: `zstd -d {path.name}` writes {path.stem}, which is read"
    if kind in SUFFIXES:
        return f"; give it the name {path.stem}{kind}"
    if kind in _TABLES:
        return f"; save what {path.name} holds as text: {FROM_TEXT}"
    return f"; {FROM_TEXT}" if kind in _TEXT else ""
