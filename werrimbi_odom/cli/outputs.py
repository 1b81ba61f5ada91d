# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Checks a verb's input and output files before it starts, for all verbs by their options.

An output that cannot be written is reported before long work and not after it. A file that is read
is never overwritten, not even with --force.
"""

from __future__ import annotations

import argparse
import json
import shlex
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from datetime import datetime, timezone
from pathlib import Path
from typing import TYPE_CHECKING, Any

from werrimbi_odom.cli.options import declare
from werrimbi_odom.cli.packages import refuse_without
from werrimbi_odom.errors import InputError

if TYPE_CHECKING:
    from werrimbi_odom.api.result import Result


READ = ("robot", "run", "runs", "holdout", "results", "after", "effects", "reference", "other")
WRITTEN = ("out", "json", "report")
FOLDERS = {"draft": "with --force", "simulate": "never"}
"""Verbs with a folder as --out, and when it may be non-empty."""
REPLACED = ("odom",)
"""Verbs with a table as --out: it is replaced, as are --json and --report."""

Place = str | tuple[int, int]


def refuse_files(arguments: argparse.Namespace) -> None:
    """Check that all outputs can be written.

    InputError if --out, --json or --report is (or resolves to) an input or another output, or is
    not writable: a folder, a missing parent folder, no permission, an existing file without
    --force, an unknown file type for a report.
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
    """Files that a verb reads, and folders whose files it may read."""
    for name in READ:
        value = getattr(arguments, name, None) or ()
        yield from [value] if isinstance(value, Path) else value
    if getattr(arguments, "fleet", None) is not None:
        from werrimbi_odom.fleet.members import members_of

        for member in members_of(arguments.fleet):
            yield from (member.robot, *member.runs, *member.holdout)


def _places(path: Path) -> Iterator[Place]:
    """Resolved name and inode of a path; for a folder, also of its files."""
    from werrimbi_odom.files.text_files import place_of

    for each in (path, *(path.iterdir() if path.is_dir() else ())):
        yield place_of(each)
        if each.exists():
            found = each.stat()
            yield (found.st_dev, found.st_ino)


def _refuse_file(
    option: str, path: Path, arguments: argparse.Namespace, taken: Mapping[Place, str]
) -> None:
    from werrimbi_odom.files.text_files import place_of, refuse_unwritable

    if path.is_dir():
        raise InputError(f"{option} is a folder; give a file name in it")
    for place in taken.keys() & set(_places(path)):
        raise InputError(f"{option} would overwrite {taken[place]}")
    if option.startswith("--report"):
        refuse_without("plotly", "--report")
        from werrimbi_odom.report.save import PICTURES, refuse_report

        refuse_report(path)
        if path.suffix.lower() in PICTURES:  # one file per figure: NAME.png, NAME-more.png
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
    from werrimbi_odom.files.text_files import place_of, refuse_unwritable

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


def add_file_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare --robot, --out, --json, --report and --force of a calibration."""
    declare(parser, "--robot", help="robot file to start from")
    declare(parser, "--out", "--json", "--report", "--force")


def write_and_tell(arguments: argparse.Namespace, result: Result[Any]) -> None:
    """Write new robot file, JSON and page as requested, then print.

    Files come first, because the reader of the text may stop early (`| head`).
    """
    written: list[Path] = []
    try:
        if result.new_robot is not None:
            result.write_robot(arguments.out, force=arguments.force)
            written.append(arguments.out)
        written += write_figures(arguments, result.to_dict, result.write_report)
    finally:
        print(result.summary())
    tell_written(written)


def write_figures(
    arguments: argparse.Namespace,
    figures: Callable[[], Mapping[str, Any]],
    report: Callable[[Path, Mapping[str, str]], Sequence[Path]],
) -> list[Path]:
    """Write JSON and page if requested, the latter with its provenance; return the paths."""
    written = []
    if arguments.json is not None:
        write_json(arguments.json, figures())
        written.append(arguments.json)
    if arguments.report is not None:
        written += report(arguments.report, made_of(arguments))
    return written


def tell_written(written: Sequence[Path]) -> None:
    """Print the written paths in one line, if any."""
    if written:
        print(f"\nwritten: {', '.join(map(str, written))}")


def write_json(path: Path, figures: Mapping[str, Any]) -> None:
    """Write figures as JSON; values that are not finite become null.

    InputError if the file cannot be written.
    """
    from werrimbi_odom.files.text_files import replacing
    from werrimbi_odom.report.number_format import plain

    with replacing(path) as file:
        json.dump(plain(figures), file, indent=2, allow_nan=False)
        file.write("\n")


def made_of(arguments: argparse.Namespace) -> dict[str, str]:
    """Command, files and options, for `report.html_page`."""
    made = {"command": shlex.join(["werrimbi", *sys.argv[1:]])}
    for name, word in (
        ("robot", "robot file"),
        ("runs", "drives"),
        ("holdout", "held-out drives"),
        ("results", "results"),
        ("effects", "effects of your own"),
    ):
        value = getattr(arguments, name, None)
        if value:
            made[word] = ", ".join(map(str, _each(value)))
    if hasattr(arguments, "leg"):
        made["legs"] = f"{arguments.leg:g} m"
    if getattr(arguments, "reference_kind", None):
        made["reference"] = arguments.reference_kind
    made["made on"] = datetime.now(timezone.utc).strftime("%Y-%m-%d %H:%M UTC")
    return made


def _each(value: Path | Iterable[Path]) -> Iterable[Path]:
    return [value] if isinstance(value, Path) else value
