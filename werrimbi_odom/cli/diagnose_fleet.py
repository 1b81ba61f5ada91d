# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi diagnose --fleet`: many robots in one table, locally or on a Dask cluster."""

from __future__ import annotations

import argparse
import shutil
from collections import Counter
from collections.abc import Mapping, Sequence
from contextlib import closing
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING

from werrimbi_odom.cli.options import how_of, number, read_effects, warn
from werrimbi_odom.cli.outputs import tell_written, write_figures
from werrimbi_odom.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Generator

    from werrimbi_odom.fleet.members import Member
    from werrimbi_odom.fleet.robot_task import Task
    from werrimbi_odom.report.fleet import Fleet, Row

_NARROW, _WIDE = 80, 140
"""Limits of the table's width in columns; 100 without a terminal."""


def add_fleet_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare --fleet, --jobs and --scheduler."""
    fleet = parser.add_argument_group("many robots at once (docs/fleet.md)")
    fleet.add_argument(
        "--fleet",
        metavar="FOLDER",
        type=Path,
        help="in place of --robot and RUN: a folder with a sub-folder for each robot, in it "
        "robot.yaml and its runs (in train/ and holdout/, or beside it)",
    )
    fleet.add_argument(
        "--jobs",
        metavar="N",
        type=number(int, 1, inf, "not a whole number greater than zero"),
        help="robots at a time, each in a process; as many as there are processors if not given",
    )
    fleet.add_argument(
        "--scheduler",
        metavar="tcp://HOST:PORT",
        help="in place of --jobs: do it on the Dask cluster of this scheduler",
    )


def refuse_mixing(arguments: argparse.Namespace) -> None:
    """Check: one robot or a fleet, processes or a cluster.

    InputError if options contradict each other.
    """
    if arguments.fleet is None:
        for name in ("jobs", "scheduler"):
            if getattr(arguments, name) is not None:
                raise InputError(f"--{name} is for many robots; give --fleet FOLDER with it")
        return
    own = ("robot", "--robot"), ("runs", "RUN"), ("holdout", "--holdout")
    for name, word in (*own, ("reference", "--reference")):
        if getattr(arguments, name):
            raise InputError(
                f"--fleet brings robot files and runs of its own; leave out {word}, or --fleet"
            )
    if arguments.jobs is not None and arguments.scheduler is not None:
        raise InputError("--jobs is for this machine, --scheduler for a cluster; leave out one")


def run_fleet(arguments: argparse.Namespace) -> int:
    """Diagnose all robots, report; return 0.

    InputError if the folder or the cluster is not usable; results so far are reported and written.
    KeyboardInterrupt on Ctrl-C; results so far are reported and written.
    """
    from werrimbi_odom.cli.progress import share_done
    from werrimbi_odom.files.recordings import Asked
    from werrimbi_odom.fleet.members import members_of
    from werrimbi_odom.fleet.robot_task import Task, failed

    members = members_of(arguments.fleet)
    read_effects(arguments)  # an error in them is not specific to a robot
    how = how_of(arguments)
    tasks = [Task(each.name, Asked(each.robot, each.runs, each.holdout, how)) for each in members]
    rows, ready = [], []
    for member, task in zip(members, tasks, strict=True):
        if member.problem:
            rows.append(failed(task, member.problem))
        else:
            ready.append(task)
    stopped: BaseException | None = None
    done = len(rows)
    try:
        with share_done("diagnosing") as show, closing(_spread(arguments, ready)) as coming:
            show(done / len(tasks), f"{done} of {len(tasks)} robots")
            for row in coming:
                rows.append(row)
                show(len(rows) / len(tasks), f"{len(rows)} of {len(tasks)} robots")
    except (InputError, KeyboardInterrupt) as error:
        if len(rows) == done:
            raise
        stopped = error
    _tell(arguments, _fleet(rows, members))
    if stopped is not None:
        raise stopped
    return 0


def _spread(arguments: argparse.Namespace, tasks: Sequence[Task]) -> Generator[Row, None, None]:
    """Yield rows as they arrive."""
    if arguments.scheduler is not None:
        from werrimbi_odom.fleet.cluster import on_cluster

        yield from on_cluster(tasks, arguments.scheduler, warn)
        return
    from werrimbi_odom.fleet.process_pool import processors, spread
    from werrimbi_odom.fleet.robot_task import failed, row_of

    yield from spread(tasks, arguments.jobs or processors(), row_of, failed)


def _fleet(rows: Sequence[Row], members: Sequence[Member]) -> Fleet:
    from werrimbi_odom.report.fleet import Fleet, ordered

    done = {row.robot for row in rows}
    names = [member.name for member in members]
    texts = {member.name: text for member in members if (text := _bytes(member.robot))}
    times = Counter(texts.values())
    return Fleet(
        ordered(rows, names),
        tuple(name for name in names if name not in done),
        frozenset(name for name, text in texts.items() if times[text] > 1),
    )


def _bytes(path: Path) -> bytes:
    """Content of a file; empty if unreadable, which the robot's row reports."""
    try:
        return path.read_bytes()
    except OSError:
        return b""


def _tell(arguments: argparse.Namespace, fleet: Fleet) -> None:
    """Write the requested files, then print words and table."""
    from werrimbi_odom.report.fleet import fleet_json, words_of
    from werrimbi_odom.report.fleet_document import fleet_table, write_fleet_page
    from werrimbi_odom.report.terminal import as_text

    def report(path: Path, made: Mapping[str, str]) -> list[Path]:
        return write_fleet_page(fleet, path, {"fleet": str(arguments.fleet), **made})

    written = write_figures(arguments, lambda: fleet_json(fleet), report)
    columns = shutil.get_terminal_size((100, 24)).columns
    print(as_text(words_of(fleet)))
    print()
    print(fleet_table(fleet, min(max(columns, _NARROW), _WIDE)))
    tell_written(written)
