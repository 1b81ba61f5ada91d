# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi calibrate umbmark`: base and radii from squares, by tape measure or as recorded."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from werrimbi_odom.cli.calibration_files import add_file_arguments, write_all
from werrimbi_odom.cli.recordings import remark
from werrimbi_odom.errors import InputError

if TYPE_CHECKING:
    from werrimbi_odom.files.robot_file import RobotFile
    from werrimbi_odom.inference.calibration.squares import Squares
    from werrimbi_odom.inference.calibration.umbmark import Umbmark
    from werrimbi_odom.model.robot import Robot


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    parser.description = (
        "Drive squares from a mark on the floor, at least 2 (better 5) clockwise and as many "
        "anticlockwise, all corners turned, the last one too. Measure where each ends, subtract "
        "where the odometry says it ends (x along the first leg, y to its left, in metres), and "
        "write a line for each: sense,x_m,y_m with sense cw or ccw. Or give recorded runs."
    )
    parser.add_argument(
        "results",
        metavar="RESULTS.csv|RUN",
        nargs="+",
        type=Path,
        help="a table of offsets, or recorded runs of one square each, with a reference",
    )
    parser.add_argument(
        "--side", metavar="D", type=float, required=True, help="side of the square [m]"
    )
    parser.add_argument(
        "--after",
        metavar="RESULTS2.csv|RUN",
        nargs="+",
        type=Path,
        help="squares driven with the new robot file: says what the calibration gained",
    )
    parser.add_argument("--ticks-topic", metavar="T", help="of a bag, where it has several")
    parser.add_argument("--reference-topic", metavar="T", help="of a bag, where it has several")
    add_file_arguments(parser)


def run(arguments: argparse.Namespace) -> int:
    """Calibrate; 0 on success."""
    from werrimbi_odom.files.robot_file import read_robot_file
    from werrimbi_odom.inference.calibration.umbmark import corrected, recomputed, umbmark
    from werrimbi_odom.report.calibration.figures import OffsetCloud, umbmark_figure
    from werrimbi_odom.report.calibration.umbmark_words import found_in_words, gained_in_words

    source = read_robot_file(arguments.robot)
    remark(source)
    old = source.robot
    squares = _squares(arguments.results, source, old, arguments)
    result = umbmark(squares, old)
    new = corrected(old, result.factors)
    later = None
    if arguments.after:
        later = _squares(arguments.after, source, new, arguments)
    again = recomputed(squares, old, result.factors) if squares.driven_cw else None
    multipliers = result.multipliers(old)

    found = found_in_words(squares, result, old)
    words = f"{found}\n\n{gained_in_words(result, squares, later, again)}"
    print(words)

    shown, name = (later, "after") if later else (again, "same runs, corrected")
    figure = umbmark_figure(
        OffsetCloud("before", squares.cw, squares.ccw),
        OffsetCloud(name, shown.cw, shown.ccw) if shown else None,
    )
    changes = {name: _rounded(estimate.value) for name, estimate in multipliers.items()}
    write_all(
        arguments,
        source,
        changes,
        _json(squares, result, old, later, again),
        figure,
        title="UMBmark: base and radii from squares",
        words=words,
        heading=f"UMBmark: squares of {squares.side:g} m",
        see="Where squares ended, clockwise and anticlockwise, measured minus odometry. After the "
        "calibration both clouds should lie about the origin; the circle is the larger offset.",
    )
    return 0


def _rounded(value: float) -> float:
    """For the eye; a thousandth of what any tape could tell."""
    return round(value, 9)


def _squares(
    paths: Sequence[Path], source: RobotFile, robot: Robot, arguments: argparse.Namespace
) -> Squares:
    """From a table, or from recorded runs, whose odometry is worked out with `robot`."""
    tables = [path for path in paths if path.suffix.lower() == ".csv"]
    if not tables:
        return _recorded(paths, source, robot, arguments)
    if len(paths) > 1:
        raise InputError(f"{tables[0]}: give one table, or recorded runs, not both and not several")
    return _from_table(tables[0], arguments.side)


def _from_table(path: Path, side: float) -> Squares:
    import numpy as np

    from werrimbi_odom.files.results_table import read_results
    from werrimbi_odom.inference.calibration.squares import Squares

    table = read_results(path, ("x_m", "y_m"), word="sense", choices=("cw", "ccw"))
    senses = np.array(table.words, dtype=str)
    try:
        return Squares(side, table.numbers[senses == "cw"], table.numbers[senses == "ccw"])
    except InputError as error:
        raise InputError(f"{path}: {error}") from None


def _recorded(
    paths: Sequence[Path], source: RobotFile, robot: Robot, arguments: argparse.Namespace
) -> Squares:
    from werrimbi_odom.cli.progress import with_progress
    from werrimbi_odom.files.reading import read_run
    from werrimbi_odom.inference.calibration.recorded_square import (
        Record,
        recorded_square,
        squares_of,
    )

    found = []
    for path in with_progress(paths, "reading squares"):
        drive = read_run(
            path,
            source,
            ticks_topic=arguments.ticks_topic,
            reference_topic=arguments.reference_topic,
        )
        for note in drive.notes:
            print(f"{path}: {note}")
        if drive.reference is None:
            raise InputError(f"{path}: there is no reference to compare the odometry with")
        ticks, reference = drive.ticks, drive.reference
        record = Record(
            str(path),
            ticks.time,
            ticks.left,
            ticks.right,
            reference.time,
            reference.x,
            reference.y,
            reference.yaw,
        )
        found.append(recorded_square(record, robot, arguments.side, source.limits))
    return squares_of(found, arguments.side)


def _json(
    squares: Squares,
    result: Umbmark,
    old: Robot,
    later: Squares | None,
    again: Squares | None,
) -> dict[str, Any]:
    from werrimbi_odom.inference.calibration.squares import e_max_of_scatter, e_max_syst

    def centres(of: Squares) -> dict[str, list[float]]:
        return {"cw": of.cw.mean(axis=0).tolist(), "ccw": of.ccw.mean(axis=0).tolist()}

    angles, paper = result.angles, result.paper
    return {
        "parameters": {name: asdict(each) for name, each in result.multipliers(old).items()},
        "e_max_syst_m": {
            "before": result.e_max,
            "after": e_max_syst(later) if later else None,
            "same_runs_corrected": e_max_syst(again) if again else None,
        },
        "e_max_of_scatter_m": {
            "before": e_max_of_scatter(squares),
            "after": e_max_of_scatter(later) if later else None,
        },
        "centre_of_gravity": centres(squares),
        "centre_of_gravity_after": centres(later) if later else None,
        "side_m": squares.side,
        "runs": {"cw": len(squares.cw), "ccw": len(squares.ccw)},
        "alpha_rad": asdict(result.alpha),
        "beta_rad": asdict(result.beta),
        "E_d": asdict(result.ratio),
        "C_B": asdict(result.base),
        "C_L": asdict(result.left),
        "C_R": asdict(result.right),
        "first_order": {
            "alpha_rad": angles.alpha,
            "alpha_by_x_rad": angles.alpha_by_x,
            "alpha_by_y_rad": angles.alpha_by_y,
            "beta_rad": angles.beta,
            "beta_by_x_rad": angles.beta_by_x,
            "beta_by_y_rad": angles.beta_by_y,
            "E_d": paper.ratio,
            "C_B": paper.base,
            "C_L": paper.left,
            "C_R": paper.right,
        },
        "disagreement_p": result.disagreement_p,
    }
