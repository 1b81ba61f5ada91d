# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi compare`: model against measurement; where it fails."""

from __future__ import annotations

import argparse
import shlex
from pathlib import Path
from typing import TYPE_CHECKING

from werrimbi_odom.cli.json_file import write_json
from werrimbi_odom.cli.recordings import add_recording_arguments, read_recordings

if TYPE_CHECKING:
    from werrimbi_odom.inference.comparison.compare import Comparison

HELP = "model against measurement: where it fails, and whether its covariance is honest"
_LONG = 200  # letters of a command that is worth printing whole


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
    print(words_of(comparison, next_step=_next_step(arguments)))
    print()
    print(tables_of(comparison))
    written = _write(arguments, comparison)
    if written:
        print(f"\nwritten: {', '.join(map(str, written))}")
    return 0


def _next_step(arguments: argparse.Namespace) -> str:
    """The command that diagnoses the same drives, or its beginning where it is long."""
    words = ["werrimbi", "diagnose", "--robot", str(arguments.robot)]
    if arguments.reference_kind != "absolute":
        words += ["--reference-kind", arguments.reference_kind]
    runs = [str(path) for path in arguments.runs]
    whole = shlex.join([*words, *runs])
    return f"`{whole if len(whole) <= _LONG else shlex.join(words) + ' RUN...'}`"


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
            next_step=_next_step(arguments),
            made=made_of(arguments),
        )
    return written
