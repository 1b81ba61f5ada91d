# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi history`: a robot's parameters over weeks or months, and when one changed."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Iterator, Sequence
from functools import partial
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING

from werrimbi_odom.cli.options import add_recording_arguments, how_of, number, read_effects, remark
from werrimbi_odom.cli.outputs import write_and_tell

if TYPE_CHECKING:
    from werrimbi_odom.api.history import DriveTask, Looked

HELP = "what changed on the robot over months of drives, and when: base, radii, mount, effects"

_FEW = 6  # drives that are processed faster than another process starts


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `werrimbi history`."""
    parser.description = (
        "Fits each drive by itself, puts the drives in the order of their dates, and says which "
        "number of the robot changed when: base, radii, how the reference is mounted, the sizes of "
        "the effects in the robot file. The fit of each drive is kept on disk, so that one drive "
        "more takes seconds."
    )
    add_recording_arguments(parser)
    parser.add_argument(
        "--like",
        metavar="OTHER",
        dest="other",
        type=Path,
        help="robot file of a sound robot of the same kind, or of this one when it was sound: "
        "lists what differs from it",
    )
    parser.add_argument(
        "--jobs",
        metavar="N",
        type=number(int, 1, inf, "not a whole number greater than zero"),
        default=0,
        help="processes; if not given, one for each processor",
    )
    parser.add_argument(
        "--cache",
        metavar="DIR",
        type=Path,
        default=_cache(),
        help="folder to keep what each drive tells (default: %(default)s)",
    )


def run(arguments: argparse.Namespace) -> int:
    """Process the drives, combine and report them; return 0."""
    from werrimbi_odom.api.history import history
    from werrimbi_odom.cli.progress import share_done
    from werrimbi_odom.files.robot_files.robot_file import read_robot_file

    collection = read_effects(arguments)
    robot, like = (
        None if path is None else read_robot_file(path, collection)
        for path in (arguments.robot, arguments.other)
    )
    assert robot is not None
    remark(robot)

    with share_done("looking at the drives") as show:
        result = history(
            robot,
            arguments.runs,
            like=like,
            cache=arguments.cache,
            spread=partial(_spread, arguments.jobs),
            show=show,
            **vars(how_of(arguments)),
        )
    write_and_tell(arguments, result)
    return 0


def _spread(jobs: int, tasks: Sequence[DriveTask]) -> Iterator[Looked]:
    from werrimbi_odom.api.history import told_of_task, unusable_task
    from werrimbi_odom.fleet.process_pool import processors, spread

    jobs = jobs or processors()
    if jobs == 1 or len(tasks) < _FEW:
        return map(told_of_task, tasks)
    return spread(tasks, jobs, told_of_task, unusable_task)


def _cache() -> Path:
    """The user's cache folder."""
    default = Path.home() / ".cache" if sys.platform != "win32" else Path.home()
    return Path(os.environ.get("XDG_CACHE_HOME") or default) / "werrimbi_odom" / "history"
