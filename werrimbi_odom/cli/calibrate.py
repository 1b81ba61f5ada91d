# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi calibrate`: a robot file with better parameters, from drives and measurements."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from werrimbi_odom.cli.options import (
    add_recording_arguments,
    add_verb,
    declare,
    read_recordings,
    remark,
)
from werrimbi_odom.cli.outputs import add_file_arguments, write_and_tell

if TYPE_CHECKING:
    from werrimbi_odom.api.result import Result
    from werrimbi_odom.files.robot_files.robot_file import RobotFile

HELP = "base, radii and noise of the wheels, by tape or from drives, with error bars"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the three kinds of calibration and their options."""
    parser.description = (
        "Finds the wheel base, the radii and the noise of the wheels, and writes a new robot file. "
        "umbmark and noise need a tape measure and a typed table; fit needs recorded drives."
    )
    kinds = parser.add_subparsers(dest="kind", metavar="KIND", required=True)
    for kind, (says, add, _) in KINDS.items():
        add(add_verb(kinds, kind, says, f"calibrate {kind}"))


def run(arguments: argparse.Namespace) -> int:
    """Calibrate; return 0."""
    _, _, calibrate = KINDS[arguments.kind]
    write_and_tell(arguments, calibrate(arguments))
    return 0


def _robot(arguments: argparse.Namespace) -> RobotFile:
    from werrimbi_odom.files.robot_files.robot_file import read_robot_file

    source = read_robot_file(arguments.robot)
    remark(source)
    return source


def _add_umbmark_arguments(parser: argparse.ArgumentParser) -> None:
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
    for what in ("ticks", "reference"):
        declare(parser, f"--{what}-topic", help=f"topic of the {what}, in bags with several")
    add_file_arguments(parser)


def _umbmark(arguments: argparse.Namespace) -> Result[Any]:
    from werrimbi_odom.api.calibrate_umbmark import calibrate_umbmark
    from werrimbi_odom.cli.progress import share_done

    source = _robot(arguments)
    with share_done("reading squares") as show:
        return calibrate_umbmark(
            source,
            arguments.results,
            arguments.side,
            after=arguments.after or (),
            ticks_topic=arguments.ticks_topic,
            reference_topic=arguments.reference_topic,
            show=show,
        )


def _add_noise_arguments(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Drive forwards by --distance and backwards to the mark, 30 times or more (the paper: 60 "
        "times 10 m). After each run write a line ex_m,ey_m,eyaw_rad: measured minus odometry, x "
        "along the way out, y to its left. Calibrate base and radii before."
    )
    parser.add_argument("results", metavar="RESULTS.csv", type=Path, help="a line for each run")
    parser.add_argument(
        "--distance", metavar="D", type=float, required=True, help="way out [m]; as long back"
    )
    parser.add_argument(
        "--turn-round",
        action="store_true",
        help="the robot turned round at the far end and came back forwards, and turned again",
    )
    for part, what in (("xy", "position, per coordinate [m]"), ("yaw", "heading [rad]")):
        words = f"standard deviation of each measured {what} (default 0)"
        name = f"--reference-sigma-{part}"
        parser.add_argument(name, metavar="S", type=float, default=0.0, help=words)
    add_file_arguments(parser)


def _noise(arguments: argparse.Namespace) -> Result[Any]:
    from werrimbi_odom.api.calibrate import calibrate_noise

    return calibrate_noise(
        _robot(arguments),
        arguments.results,
        arguments.distance,
        turn_round=arguments.turn_round,
        reference_sigma_xy=arguments.reference_sigma_xy,
        reference_sigma_yaw=arguments.reference_sigma_yaw,
    )


def _add_fit_arguments(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Maximum likelihood of wheel separation, both radii and the noise of both wheels, from "
        "recorded drives with a reference, several at once. What the driving does not determine is "
        "left alone; when calibration is not what is missing, that is said."
    )
    add_recording_arguments(parser, holdout=True, force="overwrite --out if it exists")
    declare(parser, "--out")


def _fit(arguments: argparse.Namespace) -> Result[Any]:
    from werrimbi_odom.api.calibrate import calibrated

    return calibrated(read_recordings(arguments))


KINDS = {
    "umbmark": (
        "wheel base and radii from squares in both senses (Chong and Kleeman 1997, section 3)",
        _add_umbmark_arguments,
        _umbmark,
    ),
    "noise": (
        "noise of the wheels from drives out and back (there, section 5.2)",
        _add_noise_arguments,
        _noise,
    ),
    "fit": ("all of these from any drives with a reference", _add_fit_arguments, _fit),
}
"""For each kind: its purpose, its options, and the function that calibrates."""
