# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The paper's section 5.2: noise of the wheels from repeated drives out and back."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from werrimbi_odom.api.calibrate_umbmark import before_after
from werrimbi_odom.api.result import NewRobot, Result
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.robot_file import RobotFile

if TYPE_CHECKING:
    from werrimbi_odom.inference.calibration.out_and_back import NoiseEstimate, NoiseFit
    from werrimbi_odom.model.pose import Floats
    from werrimbi_odom.report.document import Document

COLUMNS = ("ex_m", "ey_m", "eyaw_rad")


def calibrate_noise(
    robot: RobotFile,
    results: str | Path,
    distance: float,
    *,
    turn_round: bool = False,
    reference_sigma_xy: float = 0.0,
    reference_sigma_yaw: float = 0.0,
) -> Result[NoiseFit]:
    """Noise of both wheels from drives out and back (the paper's section 5.2).

    Parameters
    ----------
    results
        A table `ex_m,ey_m,eyaw_rad`, a row for each drive.
    distance
        One way [m].
    turn_round
        The robot turns round at the far end, and again at the start; else it drives backwards.
    reference_sigma_xy, reference_sigma_yaw
        Standard deviation of what was measured [m, rad].

    Raises
    ------
    InputError
        When the table cannot be used; the message says where.
    """
    from werrimbi_odom.inference.calibration.noise_likelihood import design
    from werrimbi_odom.inference.calibration.out_and_back import fit_noise, out_and_back
    from werrimbi_odom.report.calibration.document import calibration_document
    from werrimbi_odom.report.calibration.figures import noise_figure
    from werrimbi_odom.report.calibration.noise_words import noise_in_words

    track = robot.robot.track
    options = {
        "distance": distance,
        "reference_sigma_xy": reference_sigma_xy,
        "reference_sigma_yaw": reference_sigma_yaw,
    }
    errors = _errors(Path(results), options)
    pieces = out_and_back(distance, track, turn_round=turn_round)
    model = design(pieces, track, sigma_xy=reference_sigma_xy, sigma_yaw=reference_sigma_yaw)
    try:
        fit = fit_noise(errors, model)
    except InputError as error:
        raise InputError(f"{results}: {error}") from None
    words = noise_in_words(fit, distance, track, turn_round=turn_round)
    changes = {
        "left_wheel_noise": float(f"{fit.left.value:.6g}"),
        "right_wheel_noise": float(f"{fit.right.value:.6g}"),
    }

    def document() -> Document:
        return calibration_document(
            "Noise of the wheels from drives out and back",
            words,
            f"Noise of the wheels: {fit.runs} runs of {distance:g} m out and back",
            "Each mark is a drive out and back. The solid ellipse of the model should be as large "
            "and lie as the dashed one of the drives themselves.",
            lambda: noise_figure(errors, fit.data, fit.model),
            before_after(robot, changes),
        )

    return Result(
        found=fit,
        document=document,
        figures_of_json=lambda: _json(fit, distance),
        new_robot=NewRobot(robot, changes),
    )


def _errors(results: Path, options: Mapping[str, float]) -> Floats:
    from werrimbi_odom.files.results_table import read_results

    for option, least in (
        ("distance", "above"),
        ("reference_sigma_xy", "from"),
        ("reference_sigma_yaw", "from"),
    ):
        value = options[option]
        if not math.isfinite(value) or value < 0.0 or (value == 0.0 and least == "above"):
            name = option.replace("_", "-")
            raise InputError(f"--{name} must be a number {least} zero, not {value:g}")
    errors = read_results(results, COLUMNS).numbers
    for limit, columns, unit in (
        (options["distance"], (0, 1), "more than --distance; are the errors in metres?"),
        (math.pi, (2,), "more than half a turn; are the angles in radians?"),
    ):
        for column in columns:
            large = abs(errors[:, column]) > limit
            if large.any():
                row = int(large.argmax())
                raise InputError(
                    f"{results}, run {row + 1}, column {COLUMNS[column]}: "
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
