# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi odom`: dead reckoning of a run, a row of pose and covariance for each of ticks."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, TextIO, TypeVar

from werrimbi_odom.cli.json_file import plain
from werrimbi_odom.cli.recordings import remark
from werrimbi_odom.errors import InputError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from werrimbi_odom.cli.odom_figures import Figures
    from werrimbi_odom.files.robot_file import RobotFile
    from werrimbi_odom.files.run import Run
    from werrimbi_odom.model.pose import Floats, Pose
    from werrimbi_odom.model.shown import Path as ShownPath
    from werrimbi_odom.model.trajectory import Trajectory

HELP = "dead reckoning of a recorded run, with its covariance"
COLUMNS = "t_s,x_m,y_m,yaw_rad,xx,xy,xyaw,yy,yyaw,yawyaw"
Result = TypeVar("Result")

_BLOCK = 32768  # rows that are text at once


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `werrimbi odom`."""
    parser.description = (
        "Dead reckoning of a run, started where the reference shows its first pose. Writes a row "
        f"for each row of ticks: {COLUMNS} (the covariance in m², m·rad and rad²; a row of ticks "
        "that could not be used repeats the latest estimate). An existing --out is replaced."
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
    parser.add_argument(
        "--as-reference",
        action="store_true",
        help="write what the reference is predicted to show (its lever arm, yaw offset, delays and "
        "mirror, as the robot file has them) instead of the axle's midpoint",
    )
    parser.add_argument(
        "--effects",
        metavar="FILE",
        action="append",
        default=[],
        type=Path,
        help="file with effects of your own, which the robot file may name; may be given again",
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
    from werrimbi_odom.files.learnt import with_learnt_phases
    from werrimbi_odom.files.reading import read_run
    from werrimbi_odom.files.start_pose import start_of
    from werrimbi_odom.model.effect import view_of
    from werrimbi_odom.model.shown import shown

    with share_done("reading") as show:
        robot_file = _robot_file(arguments)
        recorded = read_run(
            arguments.run,
            robot_file,
            ticks_topic=arguments.ticks_topic,
            reference_topic=arguments.reference_topic,
            progress=lambda share: show(0.5 * share, "reading"),
        )
        show(0.5, "reckoning")
        robot_file, learnt = _usable(recorded, lambda: with_learnt_phases(recorded, robot_file))
        start = _usable(recorded, lambda: start_of(recorded, robot_file))
        driven = _reckoned(recorded, robot_file, start.pose)
        seen = shown(driven, view_of(robot_file.robot.effects))
        figures = figures_of(recorded, start, driven, seen, learnt)
        _write(arguments, recorded, driven, figures, show)
    remark(robot_file, *(f"{recorded.path}: {words}" for words in recorded.damage))
    print_figures(f"{recorded.name}: wheel odometry of {arguments.robot}", list(figures.rows()))
    written = [arguments.out, *([arguments.json] if arguments.json else [])]
    print(f"written: {', '.join(map(str, written))}")
    return 0


def _robot_file(arguments: argparse.Namespace) -> RobotFile:
    """The robot, with effects of the user's own files where these are given."""
    from werrimbi_odom.files.robot_file import read_robot_file

    if not arguments.effects:
        return read_robot_file(arguments.robot)
    from werrimbi_odom.effects.collection import all_effects

    return read_robot_file(arguments.robot, all_effects(arguments.effects))


def _usable(recorded: Run, work: Callable[[], Result]) -> Result:
    """The result of some work on a run; what is wrong with the run names it."""
    import numpy as np

    try:
        with np.errstate(all="ignore"):  # absurd numbers are found in the end, and said once
            return work()
    except ValueError as error:
        raise InputError(f"{recorded.path}: {error}") from error


def _reckoned(recorded: Run, robot_file: RobotFile, start: Pose) -> Trajectory:
    import numpy as np

    from werrimbi_odom.model.trajectory import trajectory

    ticks = recorded.ticks
    driven = _usable(
        recorded,
        lambda: trajectory(
            robot_file.robot,
            ticks.time,
            ticks.left,
            ticks.right,
            start=start,
            tolerance=robot_file.tolerance,
            limits=robot_file.limits,
            channels=ticks.channels,
        ),
    )
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
    figures: Figures,
    show: Callable[[float, str], None],
) -> None:
    """Both files, or neither."""
    from contextlib import ExitStack

    from werrimbi_odom.files.replacing import replacing

    with ExitStack() as files:
        if arguments.json is not None:
            file = files.enter_context(replacing(arguments.json))
            json.dump(plain(figures.as_json()), file, indent=2, allow_nan=False)
            file.write("\n")
        out = files.enter_context(replacing(arguments.out))
        entry = driven.expanded(recorded.ticks.rows)
        path = figures.shown if arguments.as_reference else driven
        _write_rows(out, recorded.ticks.time, entry, path, show)


def _write_rows(
    file: TextIO,
    time: Floats,
    entry: NDArray[np.intp],
    driven: Trajectory | ShownPath,
    show: Callable[[float, str], None],
) -> None:
    import numpy as np

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
