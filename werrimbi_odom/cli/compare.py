# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi compare`: model against measurement."""

from __future__ import annotations

import argparse

from werrimbi_odom.cli.options import add_recording_arguments, on_recordings
from werrimbi_odom.cli.outputs import write_and_tell

HELP = "model against measurement: where it fails, and whether its covariance is honest"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `werrimbi compare`."""
    parser.description = (
        "Cuts recorded drives into legs and compares what the model predicts for each with what "
        "the reference measured: in words, in tables, and with --json in full."
    )
    add_recording_arguments(parser)


def run(arguments: argparse.Namespace) -> int:
    """Read, compare, report; return 0."""
    from werrimbi_odom.api.compare_diagnose_add import compared

    _, result = on_recordings(arguments, "comparing", compared)
    write_and_tell(arguments, result)
    return 0
