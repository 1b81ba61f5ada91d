# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi calibrate fit`: base, radii and noise from any driving with a reference."""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from werrimbi_odom.cli.calibration_files import write_all
from werrimbi_odom.cli.recordings import add_recording_arguments, read_recordings

if TYPE_CHECKING:
    import plotly.graph_objects as go

    from werrimbi_odom.files.robot_file import RobotFile
    from werrimbi_odom.inference.calibration.any_driving import Calibration
    from werrimbi_odom.inference.fitting.matching import MatchedRun


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
    from werrimbi_odom.inference.fitting.matching import match, match_finely, stated
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
    figure = _figure(runs, source, result) if arguments.report is not None else None
    write_all(
        arguments,
        source,
        result.changes,
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
    legs = [errors_of_legs(robot, runs, headings) for robot in (source.robot, result.robot)]
    by_place = bool(np.isfinite(legs[0][:, :2]).any())
    figures: dict[str, Any] = {"judged_by": "position" if by_place else "heading"}
    for word, errors in zip(("before", "after"), legs, strict=True):
        size = np.hypot(errors[:, 0], errors[:, 1]) if by_place else np.abs(errors[:, 2])
        size = size[np.isfinite(size)]
        if size.size == 0:
            print("held-out runs have positions without headings; legs cannot be judged one by one")
            return {}
        figures[word] = float(np.sqrt(np.mean(size**2)))
        figures[f"median_{word}"] = float(np.median(size))
    unit, factor = ("mm", 1e3) if by_place else ("°", math.degrees(1.0))
    of = "" if by_place else ", in heading"
    print(
        f"\nheld-out legs, before and after{of}: "
        f"rms {factor * figures['before']:.2f} and {factor * figures['after']:.2f} {unit}, "
        f"median {factor * figures['median_before']:.2f} and "
        f"{factor * figures['median_after']:.2f} {unit}"
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
            "interval_95": list(noise.interval) if noise.determined and result.trusted else None,
            "determined": noise.determined,
        }
    return {
        "parameters": parameters,
        "correlation": {
            "names": [knob.name for knob in result.fit.free],
            "matrix": result.correlation.tolist(),
        },
        "numbers": result.fit.numbers,
        "not_determined": list(result.fit.held),
        "or_as_well": result.twin,
        "trusted": result.trusted,
        "something_else_is_missing": [
            *result.strange,
            *(f"{item.channel} error goes with {item.name}" for item in result.misfit),
        ],
        "outliers": sum(int(legs.sum()) for legs in result.excluded),
    }
