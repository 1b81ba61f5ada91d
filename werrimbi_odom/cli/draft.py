# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi draft`: where no known effect explains the errors, one written from the evidence."""

from __future__ import annotations

import argparse
import shlex
from pathlib import Path
from typing import TYPE_CHECKING

from werrimbi_odom.cli.commands import command
from werrimbi_odom.cli.json_file import write_json
from werrimbi_odom.cli.recordings import add_recording_arguments, read_recordings
from werrimbi_odom.errors import InputError

if TYPE_CHECKING:
    from werrimbi_odom.inference.adding.added import Added
    from werrimbi_odom.inference.adding.drafting import Draft
    from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis

HELP = "where no known effect explains the errors: write one from what they depend on"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `werrimbi draft`."""
    parser.description = (
        "Where the diagnosis says unknown: writes a small package with one effect file, whose law "
        "is the dependence that the drives show, to be read, renamed and added."
    )
    add_recording_arguments(parser, holdout=True)
    parser.add_argument(
        "--out", metavar="DIR", type=Path, required=True, help="folder for the package"
    )
    parser.add_argument(
        "--force",
        action="store_true",
        help="draft whatever the verdict is, and over an existing package",
    )


def run(arguments: argparse.Namespace) -> int:
    """Diagnose, draft, try, write; 0 on success.

    Raises
    ------
    InputError
        When something cannot be used or written, or the verdict is not unknown.
    """
    from werrimbi_odom.cli.progress import share_done
    from werrimbi_odom.inference.adding.adding import add_effect
    from werrimbi_odom.inference.adding.draft_package import package_of
    from werrimbi_odom.inference.adding.drafting import draft_effect
    from werrimbi_odom.inference.diagnosis.diagnosis import diagnose

    given = read_recordings(arguments)
    known = given.collection.effects
    with share_done("diagnosing") as show:
        robot = given.source.robot
        diagnosis = diagnose(
            given.runs, robot, known, holdout=given.holdout, show=show, **given.judging
        )
        if diagnosis.verdict != "unknown" and not arguments.force:
            raise InputError(_known(diagnosis, arguments))
        draft = draft_effect(diagnosis, show)
        files = package_of(draft)
        tried = add_effect(
            draft.effect,
            given.runs,
            diagnosis.robot,
            given=robot,
            holdout=given.holdout,
            show=show,
            **given.judging,
        )
    _write(arguments.out, files)
    print(_words(draft, tried))
    print()
    print(draft.source.partition("\n\n\n")[2].rstrip())
    print(f"\nwritten: {', '.join(str(arguments.out / name) for name in files)}")
    if arguments.json is not None:
        _write_json(arguments.json, draft, tried, [str(arguments.out / name) for name in files])
        print(f"         {arguments.json}")
    if arguments.report is not None:
        from werrimbi_odom.cli.report_made import made_of
        from werrimbi_odom.report.adding.page import write_adding_page

        pages = write_adding_page(tried, arguments.report, made=made_of(arguments))
        print(f"         {', '.join(map(str, pages))}")
    print(_next(arguments, draft))
    return 0


def _known(diagnosis: Diagnosis, arguments: argparse.Namespace) -> str:
    """Why nothing is drafted, and what to do instead."""
    force = "; --force drafts the strongest dependence all the same"
    if diagnosis.verdict == "none":
        return f"the verdict is none: the model explains these drives to their noise{force}"
    if diagnosis.verdict == "ambiguous":
        names = ", ".join(diagnosis.rivals)
        return f"the verdict is ambiguous between effects of the library ({names}){force}"
    names = ",".join(diagnosis.found)
    add = shlex.join(["werrimbi", "add", names, "--robot", str(arguments.robot)])
    return (
        f"the verdict is named: {names}, which the library holds ({add} ...); add it, and draft "
        f"with the new robot file what then remains{force}"
    )


def _write(folder: Path, files: dict[str, str]) -> None:
    from werrimbi_odom.files.replacing import replacing

    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{folder} cannot be made: {error.strerror}") from error
    for name, text in files.items():
        with replacing(folder / name) as file:
            file.write(text)


def _words(draft: Draft, tried: Added) -> str:
    from werrimbi_odom.report.printed import filled

    cell, sides = draft.dependence, tried.holdout.sides
    alone = tried.noise_alone(tried.holdout)
    floor = f"noise alone: {1e3 * alone:.2f} mm; " if tried.explained else ""
    text = (
        f"No effect of the library explains these drives. Their {cell.channel} error goes with "
        f"{cell.name}, and a {draft.form} in it explains them best among the simple laws. With it, "
        f"the error of the held-out drives is {1e3 * sides.after:.2f} mm where it was "
        f"{1e3 * sides.before:.2f} mm ({floor}rms over "
        f"legs of {tried.holdout.after.leg:g} m). Why it is so, the data cannot know: read the "
        "law, find the physics, give it its name."
    )
    return filled(text)


def _next(arguments: argparse.Namespace, draft: Draft) -> str:
    """The commands that try it, and that install it."""
    file = arguments.out / f"{draft.name}.py"
    shown = shlex.quote(str(file))
    tried = command(["add", draft.name, "--effects", str(file)], arguments, out="new.yaml")
    return (
        f"\nRead it:     werrimbi explain {draft.name} --effects {shown}\n"
        f"Try it:      {tried}\n"
        f"Install it:  pip install {shlex.quote(str(arguments.out))}    (then robot files and the "
        "node know its name)"
    )


def _write_json(path: Path, draft: Draft, tried: Added, files: list[str]) -> None:
    from werrimbi_odom.report.adding.words import json_of

    cell = draft.dependence
    figures = {
        **json_of(tried),
        "verdict": draft.diagnosis.verdict,
        "draft": {
            "channel": cell.channel,
            "per": cell.amount.per,
            "variable": cell.name,
            "p_value": cell.p_value,
            "form": draft.form,
            "files": files,
            "tried": [
                {"effect": name, "form": form, "cost_beyond_best": cost}
                for name, form, cost in draft.tried
            ],
        },
    }
    write_json(path, figures)
