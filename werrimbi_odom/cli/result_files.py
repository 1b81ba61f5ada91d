# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The files that a verb writes of its result, and the options that name them."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from werrimbi_odom.cli.json_file import write_json

if TYPE_CHECKING:
    from werrimbi_odom.api.result import Result


def add_file_arguments(parser: argparse.ArgumentParser) -> None:
    """--robot, --out, --json, --report and --force of a calibration."""
    parser.add_argument(
        "--robot", metavar="R", type=Path, required=True, help="robot file to start from"
    )
    parser.add_argument(
        "--out", metavar="NEW", type=Path, required=True, help="robot file to write"
    )
    parser.add_argument("--json", metavar="F", type=Path, help="write the numbers to this file")
    parser.add_argument(
        "--report",
        metavar="F",
        type=Path,
        help="write a page with plots (.html), or the plots (.pdf, .png)",
    )
    parser.add_argument("--force", action="store_true", help="overwrite --out if it exists")


def write_asked(arguments: argparse.Namespace, result: Result[Any]) -> list[Path]:
    """The new robot file, if there is one, then JSON and page that were asked for; returns them."""
    written = []
    if result.new_robot is not None:
        result.write_robot(arguments.out, force=arguments.force)
        written.append(arguments.out)
    if arguments.json is not None:
        write_json(arguments.json, result.to_dict())
        written.append(arguments.json)
    if arguments.report is not None:
        from werrimbi_odom.cli.report_made import made_of

        written += result.write_report(arguments.report, made_of(arguments))
    return written


def tell_written(written: Sequence[Path]) -> None:
    """A line of what was written; none where nothing was."""
    if written:
        print(f"\nwritten: {', '.join(map(str, written))}")
