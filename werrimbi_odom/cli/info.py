# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi info`: contents of a recording, what it allows, and the next command."""

from __future__ import annotations

import argparse
from functools import partial

from werrimbi_odom.cli.options import declare
from werrimbi_odom.errors import InputError

HELP = "what a recording holds, what it can show, and the next command"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `werrimbi info`."""
    parser.description = (
        "Looks into any recording: which topic holds the wheels, what measures the robot and "
        "whether that is independent of them, stamps, when the robot stood, drove, was held or "
        "carried, what can be diagnosed with it and what not. With --out it writes a first robot "
        "file, from the URDF in the bag or from a diff_drive_controller's parameters."
    )
    declare(parser, "runs")
    words = "robot file, or the parameter file of a diff_drive_controller"
    declare(parser, "--robot", required=False, help=words)
    declare(parser, "--out", required=False, help="first robot file to write")
    for what, topic in (("wheels", "--ticks-topic"), ("reference", "--reference-topic")):
        declare(parser, topic, help=f"topic of the {what}, if not the one that is chosen")
    declare(parser, "--reference", "--json", "--force")


def run(arguments: argparse.Namespace) -> int:
    """Analyse, report; return 0."""
    from werrimbi_odom.api.info import info
    from werrimbi_odom.cli.outputs import tell_written, write_json
    from werrimbi_odom.files.recordings import refuse_twice

    refuse_twice(arguments.runs)
    look = partial(
        info,
        arguments.runs,
        robot=arguments.robot,
        ticks_topic=arguments.ticks_topic,
        reference_topic=arguments.reference_topic,
        references=arguments.reference,
        force=arguments.force,
    )
    try:
        result = look(out=arguments.out)
    except InputError:
        if arguments.out is not None:  # contents are reported even if no file can be written
            print(look().summary())
        raise
    written = [each for each in (arguments.out, arguments.json) if each is not None]
    if arguments.json is not None:
        write_json(arguments.json, result.to_dict())
    print(result.summary())
    tell_written(written)
    return 0
