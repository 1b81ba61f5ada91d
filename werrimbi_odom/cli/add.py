# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi add`: fit physical effects, evaluate them, and write the extended robot file."""

from __future__ import annotations

import argparse

from werrimbi_odom.cli.options import add_recording_arguments, declare, read_recordings
from werrimbi_odom.cli.outputs import write_and_tell

HELP = "add physical effects to the model: fit them, judge them on held-out drives, write them"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `werrimbi add`."""
    parser.description = (
        "Fits one physical effect, or several at once, together with all calibration parameters to "
        "recorded drives, shows the error before and after on drives that took no part in the fit, "
        "and writes a new robot file. Sizes that the drives do not move stay as the file has them. "
        "An effect that does not earn its place is refused by name. Without --holdout parts of the "
        "drives are put aside for judging."
    )
    parser.add_argument(
        "effect", metavar="EFFECT", help="its name, or several: A,B,C; werrimbi explain lists all"
    )
    add_recording_arguments(
        parser,
        holdout=True,
        force="write even an effect that does not help, and over an existing --out",
    )
    declare(parser, "--out")


def run(arguments: argparse.Namespace) -> int:
    """Read, fit, evaluate, write; return 0."""
    from werrimbi_odom.api.compare_diagnose_add import added, effects_of, refuse_unearned
    from werrimbi_odom.api.next_command import next_command
    from werrimbi_odom.cli.progress import share_done

    given = read_recordings(arguments)
    effects = effects_of(arguments.effect, given)
    with share_done("fitting") as show:
        result = added(given, effects, show)
    if not arguments.force:
        refuse_unearned(result.found, "--force writes")
    write_and_tell(arguments, result)
    print("Is more missing?")
    print(next_command(["diagnose"], given, robot=arguments.out))
    return 0
