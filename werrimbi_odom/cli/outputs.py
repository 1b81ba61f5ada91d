# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What a verb reads and writes, looked at before it begins: for all verbs alike, by their options.

What could not be written at the end of long work is said at its beginning, and no file that is read
is ever written over, not even with --force.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping
from pathlib import Path

from werrimbi_odom.cli.packages import refuse_without
from werrimbi_odom.errors import InputError

READ = ("robot", "run", "runs", "holdout", "results", "after", "effects", "reference", "other")
WRITTEN = ("out", "json", "report")
FOLDERS = {"draft": "with --force", "simulate": "never"}
"""Verbs whose --out is a folder, and when that may hold something already."""
REPLACED = ("odom",)
"""Verbs whose --out is a table: it is replaced, as --json and --report are."""

Place = str | tuple[int, int]


def refuse_files(arguments: argparse.Namespace) -> None:
    """Whether all that is to be written can be.

    Raises
    ------
    InputError
        When --out, --json or --report is (or leads to) a file that is read, or another output, or
        cannot be written: a folder, in no folder, no permission, there already and not to be
        overwritten, of an ending that no report has.
    """
    outputs = [(name, Path(value)) for name in WRITTEN if (value := getattr(arguments, name, None))]
    if not outputs:
        return
    try:
        taken = {
            place: f"{path}, which is read"
            for path in files_read(arguments)
            for place in _places(path)
        }
        for name, path in outputs:
            option = f"--{name} {path}"
            if name == "out" and arguments.verb in FOLDERS:
                _refuse_folder(option, path, arguments, taken)
            else:
                _refuse_file(option, path, arguments, taken)
            taken.update(dict.fromkeys(_places(path), option))
    except (OSError, ValueError) as error:  # ValueError: a NUL byte in the name
        if isinstance(error, InputError):
            raise
        raise InputError(f"the files that were given cannot be used: {error}") from error


def files_read(arguments: argparse.Namespace) -> Iterator[Path]:
    """Files that a verb reads, and folders of which all files may be."""
    for name in READ:
        value = getattr(arguments, name, None) or ()
        yield from [value] if isinstance(value, Path) else value
    if getattr(arguments, "fleet", None) is not None:
        from werrimbi_odom.fleet.members import members_of

        for member in members_of(arguments.fleet):
            yield from (member.robot, *member.runs, *member.holdout)


def _places(path: Path) -> Iterator[Place]:
    """Where a path leads to in the end, by name and by number; of a folder, its files' too."""
    from werrimbi_odom.files.replacing import place_of

    for each in (path, *(path.iterdir() if path.is_dir() else ())):
        yield place_of(each)
        if each.exists():
            found = each.stat()
            yield (found.st_dev, found.st_ino)


def _refuse_file(
    option: str, path: Path, arguments: argparse.Namespace, taken: Mapping[Place, str]
) -> None:
    from werrimbi_odom.files.replacing import place_of, refuse_unwritable

    if path.is_dir():
        raise InputError(f"{option} is a folder; give a file name in it")
    for place in taken.keys() & set(_places(path)):
        raise InputError(f"{option} would overwrite {taken[place]}")
    if option.startswith("--report"):
        refuse_without("plotly", "--report")
        from werrimbi_odom.report.save import PICTURES, refuse_report

        refuse_report(path)
        if path.suffix.lower() in PICTURES:  # a file for each figure: NAME.png, NAME-more.png
            refuse_without("kaleido", option)
            for place, what in taken.items():
                stem, kind = place_of(path.with_suffix("")), path.suffix
                if str(place).startswith(f"{stem}-") and str(place).endswith(kind):
                    raise InputError(f"{option} may overwrite {what}; give it another name")
    kept = option.startswith("--out") and arguments.verb not in REPLACED
    if kept and path.exists() and not arguments.force:
        raise InputError(f"{option} exists; --force overwrites it, another --out keeps it")
    refuse_unwritable(path, option)


def _refuse_folder(
    option: str, folder: Path, arguments: argparse.Namespace, taken: Mapping[Place, str]
) -> None:
    from werrimbi_odom.files.replacing import place_of, refuse_unwritable

    if folder.exists() and not folder.is_dir():
        raise InputError(f"{option} is a file; give a new or empty folder")
    within = [folder, *(folder.rglob("*") if folder.is_dir() else ())]
    if len(within) > 1 and not (getattr(arguments, "force", False)):
        may = FOLDERS[arguments.verb] == "with --force"
        mend = "--force writes into it, another --out keeps it" if may else "give another one"
        raise InputError(f"{option} is not empty; {mend}")
    below = f"{place_of(folder)}/"
    held = {place for path in within for place in _places(path)}
    for place, what in taken.items():
        if place in held or str(place).startswith(below):
            raise InputError(f"{option} holds {what}; give a folder of its own")
    there = next(path for path in (folder, *folder.absolute().parents) if path.exists())
    refuse_unwritable(there / folder.name, option)
