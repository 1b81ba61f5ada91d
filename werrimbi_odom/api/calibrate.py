# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Base, radii and noise by maximum likelihood, from any driving with a reference."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from werrimbi_odom.api.calibrate_umbmark import calibration
from werrimbi_odom.api.drives import Drives, Options, recordings_of, refuse_other_units
from werrimbi_odom.api.one_blas_thread import with_one_blas_thread
from werrimbi_odom.api.result import Result
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.recordings import Recordings
from werrimbi_odom.files.robot_files.robot_file import RobotFile
from werrimbi_odom.files.tables.results_table import read_results
from werrimbi_odom.inference.calibration.any_driving import Calibration, calibrate, errors_of_legs
from werrimbi_odom.inference.calibration.noise_likelihood import design
from werrimbi_odom.inference.calibration.out_and_back import NoiseFit, fit_noise, out_and_back
from werrimbi_odom.inference.comparison.judged_legs import figures_of
from werrimbi_odom.inference.comparison.prepared_runs import (
    PreparedRuns,
    for_fit,
    judged_by,
    prepare,
    refuse_standing,
)
from werrimbi_odom.inference.legs.cutting import with_stated_noise
from werrimbi_odom.inference.legs.gaps import LeftOut
from werrimbi_odom.inference.legs.matched_run import MatchedRun
from werrimbi_odom.inference.legs.usable_run import with_no_driving
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.report.calibration.document import leg_figure, noise_figure
from werrimbi_odom.report.calibration.fit_words import fit_in_words, fit_json
from werrimbi_odom.report.calibration.noise_words import noise_in_words, noise_json
from werrimbi_odom.report.document import paragraphs
from werrimbi_odom.report.phrases import left_out_json, left_out_words

if TYPE_CHECKING:
    import plotly.graph_objects as go
    from typing_extensions import Unpack


def calibrate_fit(
    robot: RobotFile, runs: Drives, *, holdout: Drives = (), **options: Unpack[Options]
) -> Result[Calibration]:
    """Estimate multipliers and k_L, k_R by maximum likelihood, with standard deviations.

    Parameters
    ----------
    holdout
        Drives for the error before and after; not used in the fit.

    Raises
    ------
    InputError
        If the drives are not usable; the message gives the reason.
    """
    given = recordings_of(robot, runs, holdout, **options)
    return calibrated(given)


@with_one_blas_thread
def calibrated(given: Recordings) -> Result[Calibration]:
    """`calibrate_fit` for recordings that are already read."""
    source = given.source
    for drives in filter(None, (given.runs, given.holdout)):
        refuse_standing(drives)
    refuse_other_units(given)
    given = replace(
        given, runs=tuple(with_no_driving(run, source.robot, source.limits) for run in given.runs)
    )
    prepared = prepare(given.runs, source.robot, given.evaluation)
    runs = for_fit(prepared, source.robot)
    found = calibrate(runs, source.robot, with_stated_noise(given.evaluation, runs))
    left_out = _left_out(given, runs, found)
    figures = fit_json(found)
    figures["left_out"] = left_out_json(left_out)
    figures["train"] = _judged(prepared, found)
    said = left_out_words(left_out)
    if given.holdout:
        holdout = prepare(given.holdout, source.robot, given.evaluation)
        figures["holdout"] = _judged(holdout, found)
        said.append(_told(figures["holdout"]))
    words = [*fit_in_words(found), *paragraphs(said, apart=True)]
    return calibration(
        source,
        found,
        found.changes,
        lambda: figures,
        title="Calibration by maximum likelihood",
        words=words,
        heading="Errors of short legs, before and after calibration",
        see="Each mark is a short leg, seen by the robot: the error along, and to its left. After "
        "the calibration the cloud should be smaller and lie about the origin.",
        figure=lambda: _figure(runs, source, found),
    )


def _figure(runs: Sequence[MatchedRun], source: RobotFile, result: Calibration) -> go.Figure:
    model = result.fit.point.model
    headings = [model.start_yaw(index) for index in range(len(runs))]
    return leg_figure(
        errors_of_legs(source.robot, runs, headings), errors_of_legs(result.robot, runs, headings)
    )


def _left_out(
    given: Recordings, runs: Sequence[MatchedRun], result: Calibration
) -> tuple[LeftOut, ...]:
    """Gaps of the drives, and short legs on which the reference jumped."""
    found: list[LeftOut] = []
    for run, matched, excluded in zip(given.runs, runs, result.excluded, strict=True):
        found += matched.record.left_out
        time = matched.measured.time.tolist()
        jumped = (excluded & ~matched.gap).nonzero()[0].tolist()
        started = float(matched.counters.time[0])
        found += [
            LeftOut(run.path, time[leg], time[leg + 1], "reference", "it jumped", started)
            for leg in jumped
        ]
    return tuple(found)


def _judged(prepared: PreparedRuns, result: Calibration) -> dict[str, Any]:
    """Errors over legs before and after, with the keys of all verbs; NaN where not measured."""
    before, after = (figures_of(prepared, each) for each in (prepared.robot, result.robot))
    return {
        "judged_by": judged_by(prepared),
        "before": before.rmse_position_m,
        "after": after.rmse_position_m,
        "median_before": before.median_position_m,
        "median_after": after.median_position_m,
        "rmse_yaw_rad": {"before": before.rmse_yaw_rad, "after": after.rmse_yaw_rad},
    }


def _told(figures: dict[str, Any]) -> str:
    """Held-out errors in one line: of positions, or of headings if only those were measured."""
    if math.isfinite(figures["before"]):
        return (
            f"held-out legs, before and after: "
            f"rms {1e3 * figures['before']:.2f} and {1e3 * figures['after']:.2f} mm, "
            f"median {1e3 * figures['median_before']:.2f} and "
            f"{1e3 * figures['median_after']:.2f} mm"
        )
    yaw = (math.degrees(figures["rmse_yaw_rad"][when]) for when in ("before", "after"))
    return "held-out legs, before and after: rms {:.2f}° and {:.2f}° in heading".format(*yaw)


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
    """Estimate the noise of both wheels from drives out and back (section 5.2 of the paper).

    Parameters
    ----------
    results
        A table `ex_m,ey_m,eyaw_rad`, one row per drive.
    distance
        One-way distance [m].
    turn_round
        The robot turns round at the far end and at the start; otherwise it drives backwards.
    reference_sigma_xy, reference_sigma_yaw
        Standard deviation of the measurements [m, rad].

    Raises
    ------
    InputError
        If the table is not usable; the message gives the place.
    """
    track = robot.robot.track
    errors = _errors(Path(results), distance, reference_sigma_xy, reference_sigma_yaw)
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

    return calibration(
        robot,
        fit,
        changes,
        lambda: noise_json(fit, distance, COLUMNS),
        title="Noise of the wheels from drives out and back",
        words=words,
        heading=f"Noise of the wheels: {fit.runs} runs of {distance:g} m out and back",
        see="Each mark is a drive out and back. The solid ellipse of the model should be as large "
        "and lie as the dashed one of the drives themselves.",
        figure=lambda: noise_figure(errors, fit.data, fit.model),
    )


def _errors(results: Path, distance: float, sigma_xy: float, sigma_yaw: float) -> Floats:
    for option, value, least in (
        ("distance", distance, "above"),
        ("reference-sigma-xy", sigma_xy, "from"),
        ("reference-sigma-yaw", sigma_yaw, "from"),
    ):
        if not math.isfinite(value) or value < 0.0 or (value == 0.0 and least == "above"):
            raise InputError(f"--{option} must be a number {least} zero, not {value:g}")
    errors = read_results(results, COLUMNS).numbers
    for limit, columns, unit in (
        (distance, (0, 1), "more than --distance; are the errors in metres?"),
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
