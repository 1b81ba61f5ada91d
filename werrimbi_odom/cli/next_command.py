# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The command that follows, for the same files and options: to be pasted as it is printed."""

from __future__ import annotations

import argparse
import shlex
from collections.abc import Sequence
from pathlib import Path

_JUDGED_BY = {"leg": 1.0, "reference_kind": "absolute"}
"""Options that change what is found, and their defaults; those below have none."""
_READ_BY = ("ticks_topic", "reference_topic", "reference_sigma_xy", "reference_sigma_yaw")


def next_command(
    verb: Sequence[str],
    arguments: argparse.Namespace,
    *,
    robot: Path | None = None,
    effects: Sequence[Path] = (),
    out: str = "",
    holdout: bool = True,
    one_line: bool = False,
) -> str:
    """A command over lines that a shell takes, indented.

    Parameters
    ----------
    verb
        The words behind `werrimbi`.
    robot, effects
        The robot file, if it is another one than was given, and effects beside those given.
    out
        For --out; "" for none.
    holdout
        Whether the held-out drives go with it.
    one_line
        For the middle of a sentence.
    """
    words = ["werrimbi", *verb, "--robot", str(robot or arguments.robot)]
    for name in (*_JUDGED_BY, *_READ_BY):
        value = getattr(arguments, name, None)
        if value is not None and value != _JUDGED_BY.get(name):
            said = f"{value:g}" if isinstance(value, float) else str(value)
            words += [f"--{name.replace('_', '-')}", said]
    for file in dict.fromkeys((*arguments.effects, *effects)):
        words += ["--effects", str(file)]
    lines = [shlex.join(words), _paths(arguments.runs)]
    if holdout and getattr(arguments, "holdout", None):
        lines.append(f"--holdout {_paths(arguments.holdout)}")
    if out:
        lines.append(shlex.join(["--out", out]))
    return " ".join(lines) if one_line else "    " + " \\\n      ".join(lines)


def beside(robot: Path, word: str) -> str:
    """A name for a new robot file, beside the one that was given."""
    return str(robot.with_name(f"{robot.stem}_{word}{robot.suffix}"))


def _paths(paths: Sequence[Path]) -> str:
    """Paths as given; all of one folder as FOLDER/*."""
    whole = shlex.join(map(str, paths))
    folders = {path.parent for path in paths}
    if len(paths) > 1 and len(folders) == 1:
        (folder,) = folders
        there = {path.name for path in folder.iterdir() if not path.name.startswith(".")}
        if there == {path.name for path in paths}:
            return f"{shlex.quote(str(folder))}/*"
    return whole
