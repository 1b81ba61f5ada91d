# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""UMBmark: base and radii from squares (section 3 of the paper)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from werrimbi_odom.api.result import Found, NewRobot, Result
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.robot_files.robot_file import RobotFile
from werrimbi_odom.files.tables.results_table import read_results
from werrimbi_odom.inference.calibration.recorded_square import (
    SquareRecording,
    recorded_square,
    squares_of,
)
from werrimbi_odom.inference.calibration.squares import Squares
from werrimbi_odom.inference.calibration.umbmark import Umbmark, corrected, recomputed, umbmark
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.progress import Show, silent
from werrimbi_odom.report.calibration.document import calibration_document, umbmark_figure
from werrimbi_odom.report.calibration.umbmark_words import (
    found_in_words,
    gained_in_words,
    umbmark_json,
)
from werrimbi_odom.report.document import paragraphs

if TYPE_CHECKING:
    import plotly.graph_objects as go


@dataclass(frozen=True)
class _Reading:
    """Options for reading squares."""

    side: float
    """[m]"""
    ticks_topic: str | None
    reference_topic: str | None
    show: Show
    notes: list[str] = field(default_factory=list)
    """Remarks of the readers."""


def calibrate_umbmark(
    robot: RobotFile,
    results: str | Path | Sequence[str | Path],
    side: float,
    *,
    after: str | Path | Sequence[str | Path] = (),
    ticks_topic: str | None = None,
    reference_topic: str | None = None,
    show: Show = silent,
) -> Result[Umbmark]:
    """Estimate base and radii from squares in both senses: UMBmark, section 3 of the paper.

    Parameters
    ----------
    results
        A table `sense,x_m,y_m` (measured minus odometry at the end of each square), or recorded
        drives of one square each, with a reference.
    side
        Side of the squares [m].
    after
        The same for squares driven with the new robot file, to measure the improvement.

    Raises
    ------
    InputError
        If a table or drive is not usable; the message gives the place.
    """
    old = robot.robot
    read = _Reading(side, ticks_topic, reference_topic, show)
    squares = _squares(_paths(results), robot, old, read)
    found = umbmark(squares, old)
    new = corrected(old, found.factors)
    driven_after = _paths(after)
    later = _squares(driven_after, robot, new, read) if driven_after else None
    again = recomputed(squares, old, found.factors) if squares.driven_cw else None
    # Rounded far below the resolution of any tape.
    changes = {name: round(each.value, 9) for name, each in found.multipliers(old).items()}
    words = [
        *found_in_words(squares, found, old),
        *gained_in_words(found, squares, later, again),
        *paragraphs(read.notes, apart=True),
    ]

    def figure() -> go.Figure:
        shown, name = (later, "after") if later else (again, "same runs, corrected")
        return umbmark_figure(squares, shown, name)

    return calibration(
        robot,
        found,
        changes,
        lambda: umbmark_json(squares, found, old, later, again),
        title="UMBmark: base and radii from squares",
        words=words,
        heading=f"UMBmark: squares of {squares.side:g} m",
        see="Where squares ended, clockwise and anticlockwise, measured minus odometry. After the "
        "calibration both clouds should lie about the origin; the circle is the larger offset.",
        figure=figure,
    )


def calibration(
    robot: RobotFile,
    found: Found,
    changes: dict[str, float],
    figures: Callable[[], dict[str, Any]],
    **told: Any,
) -> Result[Found]:
    """Result of a calibration; `told` are the other parts of its document."""
    before_after = {
        name: (float(getattr(robot.robot, name)), value)
        for name, value in changes.items()
        if hasattr(robot.robot, name)
    }
    return Result(
        found=found,
        document=lambda: calibration_document(**told, changes=before_after),
        figures_of_json=figures,
        new_robot=NewRobot(robot, changes),
    )


def _paths(given: str | Path | Sequence[str | Path]) -> list[Path]:
    several = [given] if isinstance(given, str | Path) else list(given)
    return [Path(each) for each in several]


def _squares(paths: Sequence[Path], source: RobotFile, robot: Robot, read: _Reading) -> Squares:
    """Squares from a table, or from recorded runs with the odometry of `robot`."""
    tables = [path for path in paths if path.suffix.lower() == ".csv"]
    if not tables:
        return _recorded(paths, source, robot, read)
    if len(paths) > 1:
        raise InputError(f"{tables[0]}: give one table, or recorded runs, not both and not several")
    return _from_table(tables[0], read.side)


def _from_table(path: Path, side: float) -> Squares:
    table = read_results(path, ("x_m", "y_m"), word="sense", choices=("cw", "ccw"))
    senses = np.array(table.words, dtype=str)
    try:
        return Squares(side, table.numbers[senses == "cw"], table.numbers[senses == "ccw"])
    except InputError as error:
        raise InputError(f"{path}: {error}") from None


def _recorded(paths: Sequence[Path], source: RobotFile, robot: Robot, read: _Reading) -> Squares:
    found = []
    for number, path in enumerate(paths):
        read.show(number / len(paths), f"reading {path.name}")
        drive = read_run(
            path, source, ticks_topic=read.ticks_topic, reference_topic=read.reference_topic
        )
        read.notes.extend(f"{path}: {note}" for note in drive.notes)
        if drive.reference is None:
            raise InputError(f"{path}: there is no reference to compare the odometry with")
        ticks, seen = drive.ticks, drive.reference
        poses = seen.time, seen.x, seen.y, seen.yaw
        record = SquareRecording(str(path), ticks.time, ticks.left, ticks.right, *poses)
        found.append(recorded_square(record, robot, read.side, source.limits))
    return squares_of(found, read.side)
