# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi calibrate noise`: k_L and k_R from the scatter of drives out and back."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from werrimbi_odom.cli.calibration_files import add_file_arguments, write_all
from werrimbi_odom.cli.recordings import remark
from werrimbi_odom.errors import InputError

if TYPE_CHECKING:
    from werrimbi_odom.inference.calibration.out_and_back import NoiseEstimate, NoiseFit
    from werrimbi_odom.model.pose import Floats

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
    from werrimbi_odom.files.robot_file import read_robot_file
    from werrimbi_odom.inference.calibration.noise_likelihood import design
    from werrimbi_odom.inference.calibration.out_and_back import fit_noise, out_and_back
    from werrimbi_odom.report.calibration.figures import noise_figure
    from werrimbi_odom.report.calibration.noise_words import noise_in_words

    source = read_robot_file(arguments.robot)
    remark(source)
    track = source.robot.track
    errors = _errors(arguments)
    pieces = out_and_back(arguments.distance, track, turn_round=arguments.turn_round)
    model = design(
        pieces,
        track,
        sigma_xy=arguments.reference_sigma_xy,
        sigma_yaw=arguments.reference_sigma_yaw,
    )
    try:
        fit = fit_noise(errors, model)
    except InputError as error:
        raise InputError(f"{arguments.results}: {error}") from None
    words = noise_in_words(fit, arguments.distance, track, turn_round=arguments.turn_round)
    print(words)
    changes = {
        "left_wheel_noise": float(f"{fit.left.value:.6g}"),
        "right_wheel_noise": float(f"{fit.right.value:.6g}"),
    }
    write_all(
        arguments,
        source,
        changes,
        _json(fit, arguments.distance),
        noise_figure(errors, fit.data, fit.model),
        title="Noise of the wheels from drives out and back",
        words=words,
        heading=f"Noise of the wheels: {fit.runs} runs of {arguments.distance:g} m out and back",
        see="Each mark is a drive out and back. The solid ellipse of the model should be as large "
        "and lie as the dashed one of the drives themselves.",
    )
    return 0


def _errors(arguments: argparse.Namespace) -> Floats:
    from werrimbi_odom.files.results_table import read_results

    for option, least in (
        ("distance", "above"),
        ("reference_sigma_xy", "from"),
        ("reference_sigma_yaw", "from"),
    ):
        value = getattr(arguments, option)
        if not math.isfinite(value) or value < 0.0 or (value == 0.0 and least == "above"):
            name = option.replace("_", "-")
            raise InputError(f"--{name} must be a number {least} zero, not {value:g}")
    errors = read_results(arguments.results, COLUMNS).numbers
    for limit, columns, unit in (
        (arguments.distance, (0, 1), "more than --distance; are the errors in metres?"),
        (math.pi, (2,), "more than half a turn; are the angles in radians?"),
    ):
        for column in columns:
            large = abs(errors[:, column]) > limit
            if large.any():
                row = int(large.argmax())
                raise InputError(
                    f"{arguments.results}, run {row + 1}, column {COLUMNS[column]}: "
                    f"{errors[row, column]:g} is {unit}"
                )
    return errors


def _json(fit: NoiseFit, distance: float) -> dict[str, Any]:
    def each(estimate: NoiseEstimate) -> dict[str, float]:
        return {
            "value": estimate.value,
            "std": estimate.std,
            "low_95": estimate.low,
            "high_95": estimate.high,
        }

    return {
        "parameters": {"left_wheel_noise": each(fit.left), "right_wheel_noise": each(fit.right)},
        "runs": fit.runs,
        "distance_m": distance,
        "wheels_told_apart": fit.split_known,
        "difference_std": fit.difference_std,
        "correlation": fit.correlation,
        "ellipse_matching": {
            "left_wheel_noise": fit.by_moments[0],
            "right_wheel_noise": fit.by_moments[1],
        },
        "systematic": {
            name: {"value": float(value), "std": float(std)}
            for name, value, std in zip(COLUMNS, fit.mean, fit.mean_std, strict=True)
        },
        "systematic_p": fit.mean_p,
        "misfit_p": fit.misfit_p,
        "missing_reference": None
        if fit.missing_reference is None
        else dict(zip(("sigma_xy_m", "sigma_yaw_rad"), fit.missing_reference, strict=True)),
        "covariance": {"runs": fit.data.tolist(), "model": fit.model.tolist()},
    }
