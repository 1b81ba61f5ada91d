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

    from werrimbi_odom.files.asked import Recordings
    from werrimbi_odom.files.robot_file import RobotFile
    from werrimbi_odom.files.run import Run
    from werrimbi_odom.inference.calibration.any_driving import Calibration
    from werrimbi_odom.inference.legs.cutting import MatchedRun
    from werrimbi_odom.inference.legs.gaps import LeftOut


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
    from werrimbi_odom.inference.legs.cutting import match_finely, stated
    from werrimbi_odom.report.calibration.fit_words import fit_in_words
    from werrimbi_odom.report.left_out import left_out_json, left_out_words
    from werrimbi_odom.report.printed import filled

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
    left_out = _left_out(given, runs, result)
    words = "\n\n".join([fit_in_words(result), *map(filled, left_out_words(left_out))])
    print(words)
    figures = _json(result)
    figures["left_out"] = left_out_json(left_out)
    figures["train"] = _judged(given.runs, given, result)
    if given.holdout:
        figures["holdout"] = _judged(given.holdout, given, result)
        print(f"\n{_told(figures['holdout'])}")
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


def _left_out(
    given: Recordings, runs: Sequence[MatchedRun], result: Calibration
) -> tuple[LeftOut, ...]:
    """Gaps of the drives, and the short legs on which the reference jumped."""
    from werrimbi_odom.inference.legs.gaps import LeftOut

    found: list[LeftOut] = []
    for run, matched, excluded in zip(given.runs, runs, result.excluded, strict=True):
        found += matched.record.left_out
        time = matched.measured.time.tolist()
        jumped = (excluded & ~matched.gap).nonzero()[0].tolist()
        found += [
            LeftOut(run.path, time[leg], time[leg + 1], "reference", "it jumped") for leg in jumped
        ]
    return tuple(found)


def _judged(runs: Sequence[Run], given: Recordings, result: Calibration) -> dict[str, Any]:
    """Errors over legs before and after, as every verb has them; NaN where not measured."""
    from werrimbi_odom.inference.comparison.judged_legs import figures_of, prepare

    prepared = prepare(runs, given.source.robot, **given.judging)
    before, after = (figures_of(prepared, each) for each in (given.source.robot, result.robot))
    return {
        "before": before.rmse_position_m,
        "after": after.rmse_position_m,
        "median_before": before.median_position_m,
        "median_after": after.median_position_m,
        "rmse_yaw_rad": {"before": before.rmse_yaw_rad, "after": after.rmse_yaw_rad},
    }


def _told(figures: dict[str, Any]) -> str:
    """Held-out errors in a line: of positions, or of headings where there are no others."""
    import math

    if math.isfinite(figures["before"]):
        return (
            f"held-out legs, before and after: "
            f"rms {1e3 * figures['before']:.2f} and {1e3 * figures['after']:.2f} mm, "
            f"median {1e3 * figures['median_before']:.2f} and "
            f"{1e3 * figures['median_after']:.2f} mm"
        )
    yaw = (math.degrees(figures["rmse_yaw_rad"][when]) for when in ("before", "after"))
    return "held-out legs, before and after: rms {:.2f}° and {:.2f}° in heading".format(*yaw)


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
