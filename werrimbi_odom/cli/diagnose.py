# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi diagnose`: which physical effect is missing; for fleets see `diagnose_fleet`."""

from __future__ import annotations

import argparse

from werrimbi_odom.cli.diagnose_fleet import add_fleet_arguments, refuse_mixing, run_fleet
from werrimbi_odom.cli.options import add_recording_arguments, on_recordings
from werrimbi_odom.cli.outputs import write_and_tell
from werrimbi_odom.errors import InputError

HELP = "which physical effect is missing, how sure that is, and what to do about it"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `werrimbi diagnose`."""
    parser.description = (
        "Finds out which physical effect a model is missing: set-up mistakes first, then one "
        "effect after the other, each judged on drives that took no part in its fit. It says what "
        "is missing, how sure that is, how large, how to check it with a ruler, and what to do "
        "next; or that nothing is missing, or that these drives cannot tell, or that no effect of "
        "the library is what it is."
    )
    add_recording_arguments(parser, holdout=True, required=False)
    add_fleet_arguments(parser)


def run(arguments: argparse.Namespace) -> int:
    """Read, diagnose, report; return 0."""
    refuse_mixing(arguments)
    if arguments.fleet is not None:
        return run_fleet(arguments)
    _ask_for_robot_and_runs(arguments)
    from werrimbi_odom.api.compare_diagnose_add import diagnosed

    _, result = on_recordings(arguments, "diagnosing", diagnosed)
    write_and_tell(arguments, result)
    return 0


def _ask_for_robot_and_runs(arguments: argparse.Namespace) -> None:
    """Raise as argparse would; a fleet needs neither RUN nor --robot."""
    lacking = [] if arguments.runs else ["RUN"]
    lacking += [] if arguments.robot is not None else ["--robot"]
    if lacking:
        raise InputError(
            f"the following arguments are required: {', '.join(lacking)} (see werrimbi diagnose "
            "--help)"
        )
