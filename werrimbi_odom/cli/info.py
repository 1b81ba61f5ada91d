# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi info`: what a recording holds and allows, and the command that comes next."""

from __future__ import annotations

import argparse
from pathlib import Path

HELP = "what a recording holds and allows, and the command that comes next"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `werrimbi info`."""
    parser.description = (
        "Looks at any recording: what tells the wheels, what measures the robot and whether that "
        "is independent of them, stamps, where the robot stood, drove, was held or carried, what "
        "can be told with it and what not. With --out it writes a first robot file, from the URDF "
        "in the bag or from a diff_drive_controller's parameters."
    )
    parser.add_argument(
        "runs", metavar="RUN", nargs="+", type=Path, help="recorded drives: run folders or bags"
    )
    parser.add_argument(
        "--robot",
        metavar="R",
        type=Path,
        help="robot file, or the parameter file of a diff_drive_controller",
    )
    parser.add_argument("--out", metavar="NEW", type=Path, help="first robot file to write")
    parser.add_argument(
        "--ticks-topic", metavar="T", help="topic of the wheels, where not what seems best"
    )
    parser.add_argument(
        "--reference-topic", metavar="T", help="topic of the reference, where not what seems best"
    )
    parser.add_argument("--json", metavar="F", type=Path, help="write the numbers to this file")
    parser.add_argument("--force", action="store_true", help="overwrite --out if it exists")


def run(arguments: argparse.Namespace) -> int:
    """Look, tell; 0 on success.

    Raises
    ------
    InputError
        When a recording cannot be read at all, or a file cannot be written.
    """
    from werrimbi_odom.api.info import info
    from werrimbi_odom.cli.result_files import tell_written, write_json
    from werrimbi_odom.files.recordings import refuse_twice

    refuse_twice(arguments.runs)
    result = info(
        arguments.runs,
        robot=arguments.robot,
        out=arguments.out,
        ticks_topic=arguments.ticks_topic,
        reference_topic=arguments.reference_topic,
        force=arguments.force,
    )
    print(result.summary())
    written = [each for each in (arguments.out, arguments.json) if each is not None]
    if arguments.json is not None:
        write_json(arguments.json, result.to_dict())
    tell_written(written)
    return 0
