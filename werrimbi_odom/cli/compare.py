# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi compare`: model against measurement; where it fails."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from werrimbi_odom.cli.json_file import write_json
from werrimbi_odom.cli.next_command import next_command
from werrimbi_odom.cli.recordings import add_recording_arguments, read_recordings

if TYPE_CHECKING:
    from werrimbi_odom.inference.comparison.compare import Comparison

HELP = "model against measurement: where it fails, and whether its covariance is honest"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `werrimbi compare`."""
    parser.description = (
        "Cuts recorded drives into legs and compares what the model predicts for each with what "
        "the reference measured: in words, in tables, and with --json in full."
    )
    add_recording_arguments(parser)


def run(arguments: argparse.Namespace) -> int:
    """Read, compare, tell; 0 on success.

    Raises
    ------
    InputError
        When robot file or runs cannot be used, or a file cannot be written.
    """
    from werrimbi_odom.cli.progress import share_done
    from werrimbi_odom.inference.comparison.compare import compare
    from werrimbi_odom.report.comparison.tables import tables_of
    from werrimbi_odom.report.comparison.words import words_of

    given = read_recordings(arguments)
    with share_done("comparing") as show:
        comparison = compare(
            given.runs,
            given.source.robot,
            **given.judging,
            show=show,
        )
    words = words_of(comparison, next_step="`werrimbi diagnose`")
    print(words)
    if "`werrimbi diagnose`" in words:
        print(next_command(["diagnose"], arguments))
    print()
    print(tables_of(comparison))
    written = _write(arguments, comparison)
    if written:
        print(f"\nwritten: {', '.join(map(str, written))}")
    return 0


def _write(arguments: argparse.Namespace, comparison: Comparison) -> list[Path]:
    """The JSON and the page that were asked for; returns what was written."""
    from werrimbi_odom.report.comparison.as_json import json_of

    written = []
    if arguments.json is not None:
        write_json(arguments.json, json_of(comparison))
        written.append(arguments.json)
    if arguments.report is not None:
        from werrimbi_odom.cli.report_made import made_of
        from werrimbi_odom.report.comparison.page import write_compare_page

        written += write_compare_page(
            comparison,
            arguments.report,
            made=made_of(arguments),
        )
    return written
