# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What the calibrations have in common on the command line: options, and the files they write."""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from werrimbi_odom.cli.json_file import write_json

if TYPE_CHECKING:
    from werrimbi_odom.api.result import Result


def add_file_arguments(parser: argparse.ArgumentParser) -> None:
    """--robot, --out, --json, --report and --force."""
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


def write_all(arguments: argparse.Namespace, result: Result[Any]) -> None:
    """The new robot file, then the JSON and the page that were asked for; says what it wrote."""
    result.write_robot(arguments.out, force=arguments.force)
    written = [arguments.out]
    if arguments.json is not None:
        write_json(arguments.json, result.to_dict())
        written.append(arguments.json)
    if arguments.report is not None:
        from werrimbi_odom.cli.report_made import made_of
        from werrimbi_odom.report.save import save_report

        written += save_report(replace(result.page(), made=made_of(arguments)), arguments.report)
    print(f"\nwritten: {', '.join(str(path) for path in written)}")
