# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi add`: more physical effects in the model, fitted together, judged, written."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from werrimbi_odom.cli.commands import command
from werrimbi_odom.cli.json_file import write_json
from werrimbi_odom.cli.recordings import add_recording_arguments, read_recordings
from werrimbi_odom.errors import InputError

if TYPE_CHECKING:
    from werrimbi_odom.files.asked import Recordings
    from werrimbi_odom.inference.adding.added import Added
    from werrimbi_odom.model.effect import Effect

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
        "effect",
        metavar="EFFECT",
        help="its name, or several: A,B,C; werrimbi explain lists all",
    )
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
    from werrimbi_odom.inference.adding.adding import add_effects
    from werrimbi_odom.report.adding.words import words_of

    given = read_recordings(arguments)
    effects = _asked(arguments, given)
    with share_done("fitting") as show:
        added = add_effects(
            effects,
            given.runs,
            given.source.robot,
            holdout=given.holdout,
            **given.judging,
            show=show,
        )
    if added.objection is not None and not arguments.force:
        raise InputError(_refused(arguments, added))
    print(words_of(added))
    written = _write(arguments, given, added)
    print(f"\nwritten: {', '.join(map(str, written))}")
    print(f"Is more missing?\n    {_next(arguments)}")
    return 0


def _asked(arguments: argparse.Namespace, given: Recordings) -> list[Effect]:
    """The effects of A,B,C, each once."""
    names = [name.strip() for name in arguments.effect.split(",")]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice:
        raise InputError(f"{arguments.effect} names {twice} twice")
    return [given.collection.find(name) for name in names]


def _refused(arguments: argparse.Namespace, added: Added) -> str:
    """What speaks against which effect, and what can be added without it."""
    good = [effect.name for effect in added.effects if effect.name not in added.objections]
    it = "it" if len(added.effects) == 1 else "them"
    text = f"{added.objection}; nothing is written (--force writes {it} all the same"
    if not good:
        return f"{text})"
    rest = ",".join(good)
    return f"{text}, without {' and '.join(added.objections)}: werrimbi add {rest} ...)"


def _write(arguments: argparse.Namespace, given: Recordings, added: Added) -> list[Path]:
    """The robot file, then the JSON and the page that were asked for; returns what was written."""
    from werrimbi_odom.files.robot_file import write_robot_file
    from werrimbi_odom.inference.fitting.knobs import MULTIPLIERS
    from werrimbi_odom.report.adding.words import json_of

    changes = {name: float(getattr(added.robot, name)) for name in MULTIPLIERS}
    if added.explained:
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


def _next(arguments: argparse.Namespace) -> str:
    """The command that looks for more in the same drives, to be pasted."""
    return command(["diagnose"], arguments, robot=arguments.out)
