# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi calibrate fit`: base, radii and noise from any driving with a reference."""

from __future__ import annotations

import argparse
from pathlib import Path

from werrimbi_odom.cli.recordings import add_recording_arguments, read_recordings
from werrimbi_odom.cli.result_files import tell_written, write_asked


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    parser.description = (
        "Maximum likelihood of wheel separation, both radii and the noise of both wheels, from "
        "recorded drives with a reference, several at once. What the driving does not determine is "
        "left alone; when calibration is not what is missing, that is said."
    )
    add_recording_arguments(parser, holdout=True, force="overwrite --out if it exists")
    parser.add_argument(
        "--out", metavar="NEW", type=Path, required=True, help="robot file to write"
    )


def run(arguments: argparse.Namespace) -> int:
    """Calibrate; 0 on success."""
    from werrimbi_odom.api.calibrate_fit import calibrated

    result = calibrated(read_recordings(arguments))
    print(result.summary())
    tell_written(write_asked(arguments, result))
    return 0
