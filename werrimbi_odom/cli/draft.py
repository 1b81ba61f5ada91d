# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi draft`: draft a new effect where no known effect explains the errors."""

from __future__ import annotations

import argparse
import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Any

from werrimbi_odom.cli.options import add_recording_arguments, declare, on_recordings
from werrimbi_odom.cli.outputs import tell_written, write_figures

if TYPE_CHECKING:
    from werrimbi_odom.files.recordings import Recordings

HELP = "where no known effect explains the errors: write one from what they depend on"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `werrimbi draft`."""
    parser.description = (
        "Where the diagnosis says unknown: writes a small package with one effect file, whose law "
        "is the dependence that the drives show, to be read, renamed and added."
    )
    add_recording_arguments(
        parser, holdout=True, force="draft whatever the verdict is, and over an existing package"
    )
    declare(parser, "--out", metavar="DIR", help="folder for the package")


def run(arguments: argparse.Namespace) -> int:
    """Diagnose, draft, test, write; return 0."""
    from werrimbi_odom.api.compare_diagnose_add import as_judged
    from werrimbi_odom.api.draft import drafted

    insist = "" if arguments.force else "--force drafts"
    given, result = on_recordings(
        arguments, "diagnosing", lambda given, show: drafted(given, insist, show)
    )
    files = result.write_package(arguments.out)

    def figures() -> dict[str, Any]:
        found = result.to_dict()
        found["draft"]["files"] = list(map(str, files))
        return found

    written = write_figures(arguments, figures, result.write_report)
    print(result.summary())
    tell_written([*files, *written])
    given = as_judged(given, result.found.diagnosis)
    print(_next(arguments.out, given, result.found.name))
    return 0


def _next(folder: Path, given: Recordings, name: str) -> str:
    """Commands to test and to install the draft.

    What no effect of the library is may have been told as several of them, and these added. Beside
    the law they are needless, but a model that holds them finds no fault with them.
    """
    from werrimbi_odom.api.next_command import next_command
    from werrimbi_odom.files.robot_files.earlier_robot_file import earlier_robot_file
    from werrimbi_odom.files.text_files import beside
    from werrimbi_odom.report.number_format import listed

    file = folder / f"{name}.py"
    explain = shlex.join(["werrimbi", "explain", name, "--effects", str(file)])
    new = beside(given.source.path, "new")
    add = next_command(["add", name], given, effects=[file], out=new)
    tried = f"Try it:\n{add}"
    held = [each.name for each in given.source.effects if not each.effect.is_mistake]
    before = earlier_robot_file(given.source, given.collection)
    if before is not None:
        kept = [each.name for each in before.effects]
        held = [each for each in held if each not in kept]
        again = next_command(["diagnose"], given, robot=before.path, effects=[file])
        tried = (
            f"Try it with the robot file from before {listed(held)}, which may have stood in for "
            f"it:\n{again}\nOr beside them:\n{add}"
        )
    elif held:
        tried += (
            f"\nIf {listed(held)} came into the robot file by these drives, it may have stood in "
            "for this law: then diagnose the file from before, with --effects as here."
        )
    return (
        f"\nRead it:\n    {explain}\n{tried}\nInstall it, and robot files may name it:\n"
        f"    {shlex.join(['pip', 'install', _place(folder)])}"
    )


def _place(folder: Path) -> str:
    """As pip takes it for a folder; a bare name it looks for on PyPI."""
    return str(folder) if len(folder.parts) > 1 else f"./{folder}"
