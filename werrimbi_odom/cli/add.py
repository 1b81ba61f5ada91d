# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi add`: one more physical effect in the model, fitted, judged, written."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from werrimbi_odom.cli.json_file import write_json
from werrimbi_odom.cli.next_command import next_command
from werrimbi_odom.cli.recordings import add_recording_arguments, read_recordings
from werrimbi_odom.errors import InputError

if TYPE_CHECKING:
    from werrimbi_odom.files.asked import Recordings
    from werrimbi_odom.inference.adding.added import Added

HELP = "add a physical effect to the model: fit it, judge it on held-out drives, write it"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `werrimbi add`."""
    parser.description = (
        "Fits one physical effect together with all calibration parameters to recorded drives, "
        "shows the error before and after on drives that took no part in the fit, and writes a new "
        "robot file. An effect that does not lower that error is refused. Without --holdout some "
        "of the drives are put aside for judging."
    )
    parser.add_argument("effect", metavar="EFFECT", help="its name; werrimbi explain lists all")
    add_recording_arguments(parser, holdout=True)
    parser.add_argument(
        "--out", metavar="NEW", type=Path, required=True, help="robot file to write"
    )
    parser.add_argument(
        "--force",
        action="store_true",
        help="write even an effect that does not help, and over an existing --out",
    )


def run(arguments: argparse.Namespace) -> int:
    """Read, fit, judge, write; 0 on success.

    Raises
    ------
    InputError
        When something cannot be used or written, or the effect does not lower the held-out error.
    """
    from werrimbi_odom.cli.progress import share_done
    from werrimbi_odom.inference.adding.adding import add_effect
    from werrimbi_odom.report.adding.words import words_of

    given = read_recordings(arguments)
    effect = given.collection.find(arguments.effect)
    with share_done("fitting") as show:
        added = add_effect(
            effect,
            given.runs,
            given.source.robot,
            holdout=given.holdout,
            **given.judging,
            show=show,
        )
    if added.objection is not None and not arguments.force:
        raise InputError(f"{added.objection}; nothing is written (--force writes it all the same)")
    print(words_of(added))
    written = _write(arguments, given, added)
    print(f"\nwritten: {', '.join(map(str, written))}")
    print("Is more missing?")
    print(next_command(["diagnose"], arguments, robot=arguments.out))
    return 0


def _write(arguments: argparse.Namespace, given: Recordings, added: Added) -> list[Path]:
    """The robot file, then the JSON and the page that were asked for; returns what was written."""
    from werrimbi_odom.files.robot_file import write_robot_file
    from werrimbi_odom.inference.fitting.knobs import MULTIPLIERS
    from werrimbi_odom.report.adding.words import json_of

    changes = {name: float(getattr(added.robot, name)) for name in MULTIPLIERS}
    if added.noise_written:
        for name in ("left_wheel_noise", "right_wheel_noise"):
            if added.noises[name].determined:
                changes[name] = float(f"{added.noises[name].value:.4g}")
    write_robot_file(
        given.source,
        changes,
        arguments.out,
        force=arguments.force,
        effects=added.robot.effects,
    )
    written = [arguments.out]
    if arguments.json is not None:
        write_json(arguments.json, json_of(added))
        written.append(arguments.json)
    if arguments.report is not None:
        from werrimbi_odom.cli.report_made import made_of
        from werrimbi_odom.report.adding.page import write_adding_page

        written += write_adding_page(added, arguments.report, made=made_of(arguments))
    return written
