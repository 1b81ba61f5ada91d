# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi odom`: dead reckoning of a run, a row of pose and covariance for each of ticks."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from werrimbi_odom.errors import InputError

if TYPE_CHECKING:
    from werrimbi_odom.files.robot_file import RobotFile
    from werrimbi_odom.files.run import Run
    from werrimbi_odom.model.pose import Floats, Pose
    from werrimbi_odom.model.trajectory import Trajectory

HELP = "dead reckoning of a recorded run, with its covariance"
COLUMNS = "t_s,x_m,y_m,yaw_rad,xx,xy,xyaw,yy,yyaw,yawyaw"
_BLOCK = 32768  # rows that are text at once


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `werrimbi odom`."""
    parser.description = (
        "Dead reckoning of a run, started at the reference's first pose. Writes a row for each row "
        f"of ticks: {COLUMNS} (the covariance in m², m·rad and rad²; a row of ticks that could not "
        "be used repeats the latest estimate). An existing --out is replaced."
    )
    parser.add_argument("run", metavar="RUN", type=Path, help="run folder, or ROS 2 bag")
    parser.add_argument("--robot", metavar="R", type=Path, required=True, help="robot file")
    parser.add_argument("--out", metavar="CSV", type=Path, required=True, help="file to write")
    parser.add_argument("--json", metavar="FILE", type=Path, help="write the figures here too")
    parser.add_argument(
        "--ticks-topic", metavar="T", help="of a bag with several; LEFT,RIGHT for one a wheel"
    )
    parser.add_argument(
        "--reference-topic",
        metavar="T",
        help="of a bag with several; T:CHILD_FRAME among transforms, `none` for no reference",
    )


def run(arguments: argparse.Namespace) -> int:
    """Read, reckon, write, tell; 0 on success.

    Raises
    ------
    InputError
        When robot file or run cannot be used, or a file cannot be written.
    """
    from werrimbi_odom.cli.odom_figures import figures_of
    from werrimbi_odom.cli.progress import share_done
    from werrimbi_odom.cli.table import print_figures
    from werrimbi_odom.files.reading import read_run
    from werrimbi_odom.files.robot_file import read_robot_file
    from werrimbi_odom.files.start_pose import start_of

    with share_done("reading") as show:
        robot_file = read_robot_file(arguments.robot)
        recorded = read_run(
            arguments.run,
            robot_file,
            ticks_topic=arguments.ticks_topic,
            reference_topic=arguments.reference_topic,
            progress=lambda share: show(0.5 * share, "reading"),
        )
        _refuse_own_inputs(arguments, recorded)
        show(0.5, "reckoning")
        start = start_of(recorded, robot_file)
        driven = _reckoned(recorded, robot_file, start.pose)
        figures = figures_of(recorded, start, driven)
        _write(arguments, recorded, driven, figures.as_json(), show)
    print_figures(f"{recorded.name}: wheel odometry of {arguments.robot}", list(figures.rows()))
    written = [arguments.out, *([arguments.json] if arguments.json else [])]
    print(f"written: {', '.join(map(str, written))}")
    return 0


def _reckoned(recorded: Run, robot_file: RobotFile, start: Pose) -> Trajectory:
    import numpy as np

    from werrimbi_odom.model.trajectory import trajectory

    ticks = recorded.ticks
    try:
        with np.errstate(all="ignore"):  # absurd numbers are found below, and said once
            driven = trajectory(
                robot_file.robot,
                ticks.time,
                ticks.left,
                ticks.right,
                start=start,
                tolerance=robot_file.tolerance,
                limits=robot_file.limits,
            )
    except ValueError as error:
        raise InputError(f"{recorded.path}: {error}") from error
    for values in (driven.x, driven.y, driven.yaw, *driven.covariance):
        wrong = np.flatnonzero(~np.isfinite(values))
        if wrong.size:
            row = int(driven.row[wrong[0]]) + 1
            raise InputError(
                f"{recorded.path}: the pose grows beyond all numbers at row {row} of the ticks; "
                "are the counts, and wheel_radius, right?"
            )
    return driven


def _write(
    arguments: argparse.Namespace,
    recorded: Run,
    driven: Trajectory,
    figures: dict[str, object],
    show: Callable[[float, str], None],
) -> None:
    """Both files, or neither."""
    from contextlib import ExitStack

    from werrimbi_odom.cli.calibration_files import plain
    from werrimbi_odom.files.replacing import replacing

    with ExitStack() as files:
        if arguments.json is not None:
            file = files.enter_context(replacing(arguments.json))
            json.dump(plain(figures), file, indent=2, allow_nan=False)
            file.write("\n")
        _write_rows(files.enter_context(replacing(arguments.out)), recorded, driven, show)


def _write_rows(
    file: TextIO, recorded: Run, driven: Trajectory, show: Callable[[float, str], None]
) -> None:
    import numpy as np

    time = recorded.ticks.time
    entry = driven.expanded(time.size)
    estimates = (driven.x, driven.y, _half_open(driven.yaw), *driven.covariance)
    file.write(COLUMNS + "\n")
    for first in range(0, time.size, _BLOCK):
        rows = slice(first, first + _BLOCK)
        table = np.stack([time[rows], *(values[entry[rows]] for values in estimates)], axis=1)
        # repr is the shortest text that reads back as the same number
        file.writelines(",".join(map(repr, row)) + "\n" for row in table.tolist())
        show(0.5 + 0.5 * first / time.size, "writing")


def _half_open(yaw: Floats) -> Floats:
    """The same directions in (-pi, pi]."""
    import numpy as np

    from werrimbi_odom.model.pose import wrap_all

    wrapped = wrap_all(yaw)
    return np.minimum(np.where(wrapped <= -np.pi, wrapped + 2.0 * np.pi, wrapped), np.pi)


def _refuse_own_inputs(arguments: argparse.Namespace, recorded: Run) -> None:
    """An existing --out is replaced, so it must not be what was just read."""
    read = [arguments.robot, recorded.path]
    for names in ("ticks.csv", "reference.csv", "metadata.yaml", "*.mcap", "*.db3"):
        read += recorded.path.glob(names)
    for name in ("out", "json"):
        path = getattr(arguments, name)
        if path is None or not path.exists():
            continue
        if path.is_dir():
            raise InputError(f"--{name} {path} is a folder; give a file name in it")
        if any(path.samefile(each) for each in read):
            raise InputError(f"--{name} {path} would overwrite what it is made from")
    if arguments.json is not None and arguments.json.resolve() == arguments.out.resolve():
        raise InputError(f"--out and --json are the same file, {arguments.out}")
