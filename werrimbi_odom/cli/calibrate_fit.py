# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi calibrate fit`: base, radii and noise from any driving with a reference."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from werrimbi_odom.cli.calibration_files import write_all
from werrimbi_odom.cli.recordings import add_recording_arguments, read_recordings

if TYPE_CHECKING:
    import plotly.graph_objects as go

    from werrimbi_odom.files.robot_file import RobotFile
    from werrimbi_odom.inference.calibration.any_driving import Calibration
    from werrimbi_odom.inference.legs.cutting import MatchedRun


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    parser.description = (
        "Maximum likelihood of wheel separation, both radii and the noise of both wheels, from "
        "recorded drives with a reference, several at once. What the driving does not determine is "
        "left alone; when calibration is not what is missing, that is said."
    )
    add_recording_arguments(parser, holdout=True)
    parser.add_argument(
        "--out", metavar="NEW", type=Path, required=True, help="robot file to write"
    )
    parser.add_argument("--force", action="store_true", help="overwrite --out if it exists")


def run(arguments: argparse.Namespace) -> int:
    """Calibrate; 0 on success."""
    from werrimbi_odom.inference.calibration.any_driving import calibrate
    from werrimbi_odom.inference.legs.cutting import match, match_finely, stated
    from werrimbi_odom.report.calibration.fit_words import fit_in_words

    given = read_recordings(arguments)
    source, how = given.source, given.how
    runs = match_finely(given.runs, source.robot, how.leg, source.limits)
    result = calibrate(
        runs,
        source.robot,
        how.kind,
        sigma_xy=how.sigma_xy or stated(runs, "sigma_xy"),
        sigma_yaw=how.sigma_yaw or stated(runs, "sigma_yaw"),
    )
    words = fit_in_words(result)
    print(words)
    figures = _json(result)
    if given.holdout:
        held_out = [match(run, source.robot, how.leg, source.limits) for run in given.holdout]
        figures["holdout"] = _judged(held_out, source, result)
    changes = {name: item.value for name, item in result.multipliers.items() if item.determined}
    for name in ("left_wheel_noise", "right_wheel_noise"):
        if result.noises[name].determined:
            changes[name] = result.noises[name].value
    figure = _figure(runs, source, result) if arguments.report is not None else None
    write_all(
        arguments,
        source,
        changes,
        figures,
        figure,
        title="Calibration by maximum likelihood",
        words=words,
        heading="Errors of short legs, before and after calibration",
        see="Each mark is a short leg, seen by the robot: the error along, and to its left. After "
        "the calibration the cloud should be smaller and lie about the origin.",
    )
    return 0


def _figure(runs: Sequence[MatchedRun], source: RobotFile, result: Calibration) -> go.Figure:
    from werrimbi_odom.inference.calibration.any_driving import errors_of_legs
    from werrimbi_odom.report.calibration.fit_figure import leg_figure

    model = result.fit.point.model
    headings = [model.start_yaw(index) for index in range(len(runs))]
    return leg_figure(
        errors_of_legs(source.robot, runs, headings),
        errors_of_legs(result.robot, runs, headings),
    )


def _judged(runs: Sequence[MatchedRun], source: RobotFile, result: Calibration) -> dict[str, Any]:
    """Errors over legs of runs that took no part, before and after; prints them."""
    import numpy as np

    from werrimbi_odom.inference.calibration.any_driving import errors_of_legs

    headings: list[float | None] = [None] * len(runs)
    figures: dict[str, Any] = {}
    for word, robot in (("before", source.robot), ("after", result.robot)):
        legs = errors_of_legs(robot, runs, headings)
        errors = np.hypot(legs[:, 0], legs[:, 1])
        errors = errors[np.isfinite(errors)]
        if errors.size == 0:
            print("held-out runs have no headings; legs cannot be judged one by one")
            return figures
        figures[word] = float(np.sqrt(np.mean(errors**2)))
        figures[f"median_{word}"] = float(np.median(errors))
    print(
        f"\nheld-out legs, before and after: "
        f"rms {1e3 * figures['before']:.2f} and {1e3 * figures['after']:.2f} mm, "
        f"median {1e3 * figures['median_before']:.2f} and {1e3 * figures['median_after']:.2f} mm"
    )
    return figures


def _json(result: Calibration) -> dict[str, Any]:
    parameters: dict[str, Any] = {}
    for name, item in result.multipliers.items():
        parameters[name] = {"value": item.value, "std": item.std, "determined": item.determined}
    for name, noise in result.noises.items():
        parameters[name] = {
            "value": noise.value,
            "std": noise.std if noise.determined and result.trusted else None,
            "determined": noise.determined,
        }
    return {
        "parameters": parameters,
        "correlation": {
            "names": [knob.name for knob in result.fit.free],
            "matrix": result.correlation.tolist(),
        },
        "trusted": result.trusted,
        "something_else_is_missing": [
            *result.strange,
            *(f"{item.channel} error goes with {item.name}" for item in result.misfit),
        ],
        "outliers": sum(int(legs.sum()) for legs in result.excluded),
    }
