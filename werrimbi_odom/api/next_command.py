# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The next command for the same files and options, ready to paste."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from werrimbi_odom.api.drives import refuse_circles
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.recordings import DriveOptions, Recordings
from werrimbi_odom.files.run import Run

NOT_STORED = Path("RUN...")
"""In place of drives that are in no file: where their parts have paths below it, as placeholder."""


def next_command(
    verb: Sequence[str],
    given: Recordings,
    *,
    robot: Path | None = None,
    effects: Sequence[Path] = (),
    out: str = "",
    one_line: bool = False,
) -> str:
    """Shell command over several indented lines, or in `one_line` for a sentence.

    `verb` are the words after `werrimbi`, `given` is the input of the current verb. `robot` is the
    robot file, if it differs from the input; `effects` are additional ones; `out` is the value of
    --out.
    """
    words = ["werrimbi", *verb, "--robot", str(robot or given.source.path), *_options(given)]
    if _needs_force(given):
        words.append("--force")
    for file in dict.fromkeys((*given.how.effects, *effects)):
        words += ["--effects", str(file)]
    in_order = bool(given.how.references)
    lines = [shlex.join(words), _paths(given.runs, in_order)]
    if given.holdout:
        lines.append(f"--holdout {_paths(given.holdout, in_order)}")
    if out:
        lines.append(shlex.join(["--out", out]))
    return " ".join(lines) if one_line else "    " + " \\\n      ".join(lines)


def _needs_force(given: Recordings) -> bool:
    """Whether a reference is computed from the wheels, and taken because that was asked for."""
    if not given.how.force_reference:
        return False
    try:
        refuse_circles(replace(given, how=replace(given.how, force_reference=False)))
    except InputError:
        return True
    return False


def _options(given: Recordings) -> Iterator[str]:
    """Options that differ from their defaults."""
    how, runs = given.how, (*given.runs, *given.holdout)
    own = {run.reference.kind for run in runs if run.reference is not None}
    plain = DriveOptions(reference_kind="absolute" if own <= {None, "absolute"} else None)
    for name in (
        "leg",
        "reference_kind",
        "ticks_topic",
        "reference_topic",
        "references",
        "reference_sigma_xy",
        "reference_sigma_yaw",
    ):
        value = getattr(how, name)
        if value in (None, getattr(plain, name)):
            continue
        for each in value if isinstance(value, list | tuple) else [value]:
            yield f"--{name.removesuffix('s').replace('_', '-')}"
            yield str(each).removesuffix(".0") if isinstance(each, float) else str(each)


def _paths(runs: Sequence[Run], in_order: bool) -> str:
    """Paths as given; a complete folder as FOLDER/*, unless they must stay `in_order`."""
    paths = [NOT_STORED if run.path.parent == NOT_STORED else run.path for run in runs]
    paths = list(dict.fromkeys(paths))
    folders = {path.parent for path in paths}
    if len(paths) > 1 and len(folders) == 1 and paths[0].exists() and not in_order:
        (folder,) = folders
        there = {path.name for path in folder.iterdir() if not path.name.startswith(".")}
        if there == {path.name for path in paths}:
            return f"{shlex.quote(str(folder))}/*"
    return shlex.join(map(str, paths))
