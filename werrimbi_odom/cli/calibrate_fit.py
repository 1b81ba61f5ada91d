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
    _say(result)
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
        words=f"{_verdict(result)}\n\n{_found(result)}",
        see="Each mark is a short leg, seen by the robot: the error along, and to its left. After "
        "the calibration the cloud should be smaller and lie about the origin.",
    )
    return 0


def _figure(runs: Sequence[MatchedRun], source: RobotFile, result: Calibration) -> go.Figure:
    from werrimbi_odom.inference.calibration.any_driving import errors_of_legs
    from werrimbi_odom.report.fit_figure import leg_figure

    model = result.fit.point.model
    headings = [model.start_yaw(index) for index in range(len(runs))]
    verdict = "the model explains these drives to their noise"
    if not result.trusted:
        verdict = "something else is missing: calibration does not explain these drives"
    return leg_figure(
        errors_of_legs(source.robot, runs, headings),
        errors_of_legs(result.robot, runs, headings),
        title="Errors of short legs, before and after calibration",
        subtitle=verdict,
    )


def _verdict(result: Calibration) -> str:
    """For the report, what `_say` prints."""
    if result.trusted:
        return "The model explains these drives to their noise."
    lines = ["Something else is missing: calibration does not explain these drives."]
    lines += [f"- {words}" for words in result.strange]
    lines += [
        f"- the {cell.channel} error still goes with {cell.name} (p = {cell.p_value:.0e})"
        for cell in result.misfit[:5]
    ]
    return "\n".join([*lines, "Next: `werrimbi diagnose` says which physical effect explains it."])


_HEADS = ("parameter", "before", "after", "± 1σ", "")


def _found(result: Calibration) -> str:
    """For the report, the table that `_say` prints."""
    from werrimbi_odom.report.text_table import table

    return table("What was found", (*_HEADS[:-1], "unit, remark"), _rows(result))


def _rows(result: Calibration) -> list[Sequence[str]]:
    rows: list[Sequence[str]] = []
    for name, item in result.multipliers.items():
        std = "?" if item.std is None else f"{item.std:.6f}"
        remark = "" if item.determined else "not determined; left alone"
        rows.append((name, f"{item.before:.6f}", f"{item.value:.6f}", std, remark))
    for name, noise in result.noises.items():
        before = getattr(result.fit.robot, name, None)
        if not noise.determined:
            remark = f"not determined (below {2.0 * noise.std:.0e})"
        else:
            remark = "m^0.5" if name.endswith("noise") else "m" if name.endswith("xy") else "rad"
        rows.append(
            (
                name,
                "" if before is None else f"{before:.2e}",
                f"{noise.value:.2e}" if noise.determined else "",
                f"{noise.std:.1e}" if noise.determined else "",
                remark,
            )
        )
    return rows


def _say(result: Calibration) -> None:
    from rich.console import Console
    from rich.table import Table

    console = Console()
    table = Table(title="Calibration by maximum likelihood")
    for heading in _HEADS:
        left = heading in ("parameter", "")
        table.add_column(heading, justify="left" if left else "right", no_wrap=bool(heading))
    for row in _rows(result):
        table.add_row(*row)
    console.print(table)
    left_out = sum(int(legs.sum()) for legs in result.excluded)
    if left_out:
        console.print(f"{left_out} legs on which the reference jumped were left out.")
    if result.trusted:
        console.print("The model explains these drives to their noise.")
        return
    console.print("[bold red]Something else is missing: calibration does not explain these drives.")
    for words in result.strange:
        console.print(f"  - {words}", markup=False)
    for cell in result.misfit[:5]:
        words = f"the {cell.channel} error still goes with {cell.name}"
        console.print(f"  - {words} (p = {cell.p_value:.0e})", markup=False)
    console.print(
        "The values above are the best of a model that does not fit, so they have no error bars. "
        "Look first at how the reference is mounted and named: its point on the robot, its forward "
        "axis, its frame (y to the left, yaw anticlockwise), its clock."
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
        f"held-out legs, before and after: "
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
