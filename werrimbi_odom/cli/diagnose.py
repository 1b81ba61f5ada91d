# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi diagnose`: which physical effect is missing; of a fleet, see `diagnose_fleet`."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from werrimbi_odom.cli.commands import command
from werrimbi_odom.cli.diagnose_fleet import add_fleet_arguments, refuse_mixing, run_fleet
from werrimbi_odom.cli.json_file import write_json
from werrimbi_odom.cli.recordings import add_recording_arguments, read_recordings
from werrimbi_odom.errors import InputError

if TYPE_CHECKING:
    from werrimbi_odom.report.diagnosis.words import NextSteps, Told

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
    """Read, diagnose, tell; 0 on success.

    Raises
    ------
    InputError
        When robot file or runs cannot be used, or a file cannot be written.
    """
    refuse_mixing(arguments)
    if arguments.fleet is not None:
        return run_fleet(arguments)
    _ask_for_robot_and_runs(arguments)
    from werrimbi_odom.cli.progress import share_done
    from werrimbi_odom.fleet.one import diagnosed
    from werrimbi_odom.report.diagnosis.as_json import json_of
    from werrimbi_odom.report.diagnosis.tables import tables_of
    from werrimbi_odom.report.diagnosis.words import words_of

    given = read_recordings(arguments)
    with share_done("diagnosing") as show:
        told = diagnosed(given, show)
    print(words_of(told, _steps(arguments)))
    print()
    print(tables_of(told.diagnosis, told.sights))
    written = _write(arguments, told, json_of(told.diagnosis, told.manoeuvre, told.sights))
    if written:
        print(f"\nwritten: {', '.join(map(str, written))}")
    return 0


def _ask_for_robot_and_runs(arguments: argparse.Namespace) -> None:
    """As argparse would, if a fleet did not bring its own."""
    lacking = [] if arguments.runs else ["RUN"]
    lacking += [] if arguments.robot is not None else ["--robot"]
    if lacking:
        raise InputError(
            f"the following arguments are required: {', '.join(lacking)} (see werrimbi diagnose "
            "--help)"
        )


def _steps(arguments: argparse.Namespace) -> NextSteps:
    """The commands that follow, for the same files."""
    from werrimbi_odom.report.diagnosis.words import NextSteps

    new = Path(arguments.robot)
    better = str(new.with_name(f"{new.stem}_better{new.suffix}"))
    return NextSteps(
        add=lambda names: command(["add", ",".join(names)], arguments, out=better),
        draft=command(["draft"], arguments, out="my_effect"),
        diagnose="werrimbi diagnose",
    )


def _write(arguments: argparse.Namespace, told: Told, figures: dict[str, Any]) -> list[Path]:
    """The JSON and the page that were asked for; returns what was written."""
    written = []
    if arguments.json is not None:
        write_json(arguments.json, figures)
        written.append(arguments.json)
    if arguments.report is not None:
        from werrimbi_odom.cli.report_made import made_of
        from werrimbi_odom.report.diagnosis.page import write_diagnosis_page

        written += write_diagnosis_page(
            told.diagnosis,
            arguments.report,
            told=told,
            steps=_steps(arguments),
            made=made_of(arguments),
        )
    return written
