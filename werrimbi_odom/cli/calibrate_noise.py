# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi calibrate noise`: k_L and k_R from the scatter of drives out and back."""

from __future__ import annotations

import argparse
from pathlib import Path

from werrimbi_odom.cli.recordings import remark
from werrimbi_odom.cli.result_files import add_file_arguments, tell_written, write_asked

COLUMNS = ("ex_m", "ey_m", "eyaw_rad")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
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
    parser.add_argument(
        "--reference-sigma-xy",
        metavar="S",
        type=float,
        default=0.0,
        help="standard deviation of each measured position, per coordinate [m] (default 0)",
    )
    parser.add_argument(
        "--reference-sigma-yaw",
        metavar="S",
        type=float,
        default=0.0,
        help="standard deviation of each measured heading [rad] (default 0)",
    )
    add_file_arguments(parser)


def run(arguments: argparse.Namespace) -> int:
    """Calibrate; 0 on success."""
    from werrimbi_odom.api.calibrate_noise import calibrate_noise
    from werrimbi_odom.files.robot_file import read_robot_file

    source = read_robot_file(arguments.robot)
    remark(source)
    result = calibrate_noise(
        source,
        arguments.results,
        arguments.distance,
        turn_round=arguments.turn_round,
        reference_sigma_xy=arguments.reference_sigma_xy,
        reference_sigma_yaw=arguments.reference_sigma_yaw,
    )
    print(result.summary())
    tell_written(write_asked(arguments, result))
    return 0
