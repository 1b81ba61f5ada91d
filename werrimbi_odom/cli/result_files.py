# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The files that a verb writes, the options that name them, and how they were made."""

from __future__ import annotations

import argparse
import json
import shlex
import sys
from collections.abc import Iterable, Mapping, Sequence
from datetime import datetime, timezone
from pathlib import Path
from typing import TYPE_CHECKING, Any

from werrimbi_odom.cli.options import declare

if TYPE_CHECKING:
    from werrimbi_odom.api.result import Result


def add_file_arguments(parser: argparse.ArgumentParser) -> None:
    """--robot, --out, --json, --report and --force of a calibration."""
    declare(parser, "--robot", help="robot file to start from")
    declare(parser, "--out", "--json", "--report", "--force")


def write_and_tell(arguments: argparse.Namespace, result: Result[Any]) -> None:
    """Files first: whoever reads the words may stop reading them (`| head`)."""
    written: list[Path] = []
    try:
        written = _write_asked(arguments, result)
    finally:
        print(result.summary())
    tell_written(written)


def _write_asked(arguments: argparse.Namespace, result: Result[Any]) -> list[Path]:
    """The new robot file, if there is one, then JSON and page that were asked for; returns them."""
    written = []
    if result.new_robot is not None:
        result.write_robot(arguments.out, force=arguments.force)
        written.append(arguments.out)
    if arguments.json is not None:
        write_json(arguments.json, result.to_dict())
        written.append(arguments.json)
    if arguments.report is not None:
        written += result.write_report(arguments.report, made_of(arguments))
    return written


def tell_written(written: Sequence[Path]) -> None:
    """A line of what was written; none where nothing was."""
    if written:
        print(f"\nwritten: {', '.join(map(str, written))}")


def write_json(path: Path, figures: Mapping[str, Any]) -> None:
    """Write figures for programs; what is not finite is null.

    Raises
    ------
    InputError
        When the file cannot be written.
    """
    from werrimbi_odom.files.replacing import replacing
    from werrimbi_odom.report.numbers import plain

    with replacing(path) as file:
        json.dump(plain(figures), file, indent=2, allow_nan=False)
        file.write("\n")


def made_of(arguments: argparse.Namespace) -> dict[str, str]:
    """Command, files and options, for `report.page`."""
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
