# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What the verbs that work on recorded drives share: their options, and the reading of it all."""

from __future__ import annotations

import argparse
import math
import os
import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from werrimbi_odom.errors import InputError

if TYPE_CHECKING:
    from werrimbi_odom.effects.collection import Collection
    from werrimbi_odom.files.robot_file import RobotFile
    from werrimbi_odom.files.run import Run
    from werrimbi_odom.inference.fitting.likelihood import ReferenceKind

_NAMED = 8  # runs of a folder that are named before "..."


@dataclass(frozen=True)
class Recordings:
    """Everything that was given on the command line, read."""

    source: RobotFile
    collection: Collection
    """Effects that a robot file may name, those of --effects among them."""
    runs: tuple[Run, ...]
    holdout: tuple[Run, ...]
    """Runs to judge on alone; empty where none were given."""
    kind: ReferenceKind
    leg: float
    """Length of a leg [m]."""
    sigma_xy: float | None
    """Noise of the reference's position, if it was given as an option [m]."""
    sigma_yaw: float | None
    """The same of its heading [rad]."""


def add_recording_arguments(
    parser: argparse.ArgumentParser, holdout: bool = False, report: bool = True
) -> None:
    """RUN..., --robot and how to read and judge them, --json and --report.

    Parameters
    ----------
    holdout : bool
        Offer --holdout too.
    report : bool
        Offer --report.
    """
    parser.add_argument(
        "runs", metavar="RUN", nargs="+", type=Path, help="recorded drives: run folders or bags"
    )
    if holdout:
        parser.add_argument(
            "--holdout",
            metavar="RUN",
            nargs="+",
            default=[],
            type=Path,
            help="drives to judge on, that take no part in the fit",
        )
    parser.add_argument("--robot", metavar="R", type=Path, required=True, help="robot file")
    parser.add_argument(
        "--leg",
        metavar="M",
        type=_positive,
        default=1.0,
        help="length of a leg [m], 1 if not given",
    )
    parser.add_argument(
        "--reference-kind",
        choices=("absolute", "incremental"),
        default="absolute",
        help="each pose has noise of its own (motion capture), or noise adds up (scan matcher)",
    )
    parser.add_argument(
        "--reference-sigma-xy",
        metavar="M",
        type=_positive,
        help="its noise in x and in y [m], if known",
    )
    parser.add_argument(
        "--reference-sigma-yaw", metavar="RAD", type=_positive, help="in heading [rad], if known"
    )
    parser.add_argument(
        "--ticks-topic", metavar="T", help="of a bag with several; LEFT,RIGHT for one a wheel"
    )
    parser.add_argument(
        "--reference-topic", metavar="T", help="of a bag with several; T:CHILD_FRAME of transforms"
    )
    parser.add_argument(
        "--effects",
        metavar="FILE",
        action="append",
        default=[],
        type=Path,
        help="file with effects of your own, to try them; may be given again",
    )
    parser.add_argument("--json", metavar="F", type=Path, help="write the figures to this file")
    if report:
        parser.add_argument("--report", metavar="F", type=Path, help="write a page with the plots")


def read_recordings(arguments: argparse.Namespace) -> Recordings:
    """Read robot file, effects and runs; a bar on the terminal while it lasts.

    Raises
    ------
    InputError
        When something cannot be used, a run is given twice, or an output would overwrite an input.
    """
    from werrimbi_odom.cli.progress import share_done
    from werrimbi_odom.effects.collection import all_effects
    from werrimbi_odom.files.robot_file import read_robot_file

    holdout: Sequence[Path] = getattr(arguments, "holdout", None) or []
    paths = [*arguments.runs, *holdout]
    _refuse_twice(paths)
    _refuse_own_inputs(arguments, paths)
    collection = all_effects(arguments.effects)
    for warning in collection.warnings:
        print(f"warning: {warning}", file=sys.stderr)
    source = read_robot_file(arguments.robot, effects=collection)
    with share_done("reading") as show:
        read = []
        for number, path in enumerate(paths):
            show(number / len(paths), f"reading {path.name}")
            read.append(_run(path, source, arguments))
    count = len(arguments.runs)
    return Recordings(
        source,
        collection,
        tuple(read[:count]),
        tuple(read[count:]),
        arguments.reference_kind,
        arguments.leg,
        arguments.reference_sigma_xy,
        arguments.reference_sigma_yaw,
    )


def _run(path: Path, source: RobotFile, arguments: argparse.Namespace) -> Run:
    from werrimbi_odom.files.reading import read_run
    from werrimbi_odom.files.run_folder import TICKS

    if path.is_dir() and not any((path / name).exists() for name in (TICKS, "metadata.yaml")):
        within = sorted(
            {
                found.parent.name
                for name in (TICKS, "metadata.yaml")
                for found in path.glob(f"*/{name}")
            }
        )
        if within:
            more = " ..." if len(within) > _NAMED else ""
            raise InputError(
                f"{path} is no run but a folder of {len(within)} "
                f"({', '.join(within[:_NAMED])}{more}); give each of them: {path}/*"
            )
    return read_run(
        path,
        source,
        ticks_topic=arguments.ticks_topic,
        reference_topic=arguments.reference_topic,
    )


def _refuse_twice(paths: Iterable[Path]) -> None:
    """A drive that counts twice makes every figure surer than it is."""
    seen: set[str] = set()
    for path in paths:
        place = _place(path)
        if place in seen:
            raise InputError(f"{path} is given twice; a drive counts once, in RUN or in --holdout")
        seen.add(place)


def _refuse_own_inputs(arguments: argparse.Namespace, runs: Sequence[Path]) -> None:
    """What is written must not be what is read."""
    read = [arguments.robot, *runs, *arguments.effects]
    for run in runs:
        if run.is_dir():
            read += run.iterdir()
    taken = {_place(path) for path in read}
    for name in ("json", "report"):
        path: Path | None = getattr(arguments, name, None)
        if path is None:
            continue
        if path.is_dir():
            raise InputError(f"--{name} {path} is a folder; give a file name in it")
        if _place(path) in taken:
            raise InputError(f"--{name} {path} would overwrite what is read, or written, already")
        taken.add(_place(path))


def _place(path: Path) -> str:
    try:
        return os.path.realpath(path)
    except ValueError:  # a NUL byte in the name; whoever opens the file says so
        return str(path)


def _positive(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not (math.isfinite(value) and value > 0.0):
        raise argparse.ArgumentTypeError(f"{text!r} is not a number greater than zero")
    return value
