# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi calibrate umbmark`: base and radii from squares, by tape measure or as recorded."""

from __future__ import annotations

import argparse
from pathlib import Path

from werrimbi_odom.cli.recordings import remark
from werrimbi_odom.cli.result_files import add_file_arguments, tell_written, write_asked


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
    parser.add_argument(
        "--ticks-topic", metavar="T", help="topic of the ticks, in bags with several"
    )
    parser.add_argument(
        "--reference-topic", metavar="T", help="topic of the reference, in bags with several"
    )
    add_file_arguments(parser)


def run(arguments: argparse.Namespace) -> int:
    """Calibrate; 0 on success."""
    from werrimbi_odom.api.calibrate_umbmark import calibrate_umbmark
    from werrimbi_odom.cli.progress import share_done
    from werrimbi_odom.files.robot_file import read_robot_file

    source = read_robot_file(arguments.robot)
    remark(source)
    with share_done("reading squares") as show:
        result = calibrate_umbmark(
            source,
            arguments.results,
            arguments.side,
            after=arguments.after or (),
            ticks_topic=arguments.ticks_topic,
            reference_topic=arguments.reference_topic,
            show=show,
        )
    print(result.summary())
    tell_written(write_asked(arguments, result))
    return 0
