# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Reads a run of any kind: a folder with ticks.csv, a rosbag2 folder, a single bag file."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

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
    bag = bag_at(Path(path))
    if bag is None:
        robot_file.refuse_counts(Path(path) / TICKS)
        run = read_run_folder(path)
    else:
        run = read_run_bag(
            bag,
            robot_file,
            ticks_topic=ticks_topic,
            reference_topic=reference_topic if reference is None else NONE,
            force=force,
            progress=progress,
        )
    run = without_held_counts(run)
    if reference is not None:
        found = _reference_at(Path(reference), robot_file, reference_topic, force)
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
    try:
        if path.is_dir():
            return None if (path / table).exists() else _bag_in(path)
        if path.exists():
            return _bag_file(path)
    except InputError:
        raise
    except (OSError, ValueError) as error:  # ValueError: a NUL byte in the name
        raise InputError(f"{path} cannot be read: {error}") from error
    raise InputError(f"{path}: there is no such run")


def _reference_at(path: Path, robot_file: RobotFile, topic: Topics, force: bool) -> FoundReference:
    bag = bag_at(path, REFERENCE)
    if bag is not None:
        return read_reference_bag(bag, robot_file, topic, force)
    reference, damage = read_reference(path / REFERENCE)
    return FoundReference(reference, (), damage=tuple(f"{path}: {each}" for each in damage))


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
