# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Commands for the same robot and drives, as one would type them: to be pasted into a shell."""

from __future__ import annotations

import argparse
import shlex
from collections.abc import Sequence
from pathlib import Path

_GIVEN = {"reference_kind": "absolute", "leg": 1.0}
"""Options that are left out where they say what is usual."""

_OPTIONS = (
    "reference_kind",
    "leg",
    "ticks_topic",
    "reference_topic",
    "reference_sigma_xy",
    "reference_sigma_yaw",
)


def command(
    verb: Sequence[str],
    arguments: argparse.Namespace,
    *,
    robot: Path | None = None,
    out: str | None = None,
    holdout: bool = True,
) -> str:
    """`werrimbi VERB` with all that was given, over several lines.

    Parameters
    ----------
    verb
        Words after `werrimbi`.
    robot
        Another robot file than the one given.
    out
        For `--out`.
    holdout : bool
        Whether the verb takes `--holdout`.
    """
    same = ["--robot", str(robot or arguments.robot)]
    for option in _OPTIONS:
        value = getattr(arguments, option, None)
        if value not in (None, _GIVEN.get(option)):
            text = f"{value:g}" if isinstance(value, float) else str(value)
            same += [f"--{option.replace('_', '-')}", text]
    for file in arguments.effects:
        same += ["--effects", str(file)]
    lines = [shlex.join(["werrimbi", *verb, *same]), _paths(arguments.runs)]
    if holdout and arguments.holdout:
        lines.append(f"--holdout {_paths(arguments.holdout)}")
    if out is not None:
        lines.append(shlex.join(["--out", out]))
    return " \\\n      ".join(lines)


def _paths(paths: Sequence[Path]) -> str:
    """Paths as given; all of one folder as FOLDER/*."""
    folders = {path.parent for path in paths}
    if len(paths) > 1 and len(folders) == 1:
        (folder,) = folders
        there = {path.name for path in folder.iterdir() if not path.name.startswith(".")}
        if there == {path.name for path in paths}:
            return f"{shlex.quote(str(folder))}/*"
    return shlex.join(map(str, paths))
