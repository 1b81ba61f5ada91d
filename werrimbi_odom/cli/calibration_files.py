# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What the calibrations have in common on the command line: options, and the files they write."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from werrimbi_odom.cli.json_file import write_json

if TYPE_CHECKING:
    import plotly.graph_objects as go

    from werrimbi_odom.files.robot_file import RobotFile


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


def write_all(
    arguments: argparse.Namespace,
    source: RobotFile,
    changes: Mapping[str, float],
    figures: Mapping[str, Any],
    figure: go.Figure | None,
    *,
    title: str = "Calibration",
    words: str = "",
    heading: str = "",
    see: str = "",
) -> None:
    """The new robot file, then the JSON and the page that were asked for; says what it wrote.

    Parameters
    ----------
    title, words
        Of the page: its heading, and what was found.
    heading, see
        Of the figure: its heading, and what to see in it.
    """
    from werrimbi_odom.files.robot_file import write_robot_file

    write_robot_file(source, changes, arguments.out, force=arguments.force)
    written = [arguments.out]
    if arguments.json is not None:
        write_json(arguments.json, figures)
        written.append(arguments.json)
    if arguments.report is not None and figure is not None:
        from werrimbi_odom.cli.report_made import made_of
        from werrimbi_odom.report.calibration.page import calibration_page
        from werrimbi_odom.report.save import save_report

        before_after = {
            name: (float(getattr(source.robot, name)), value)
            for name, value in changes.items()
            if hasattr(source.robot, name)
        }
        made = made_of(arguments)
        page = calibration_page(title, words, heading, see, figure, before_after, made)
        written += save_report(page, arguments.report)
    print(f"\nwritten: {', '.join(str(path) for path in written)}")
