# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Dead reckoning of arrays, and of a recorded run from the start of its reference."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple, TextIO, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from werrimbi_odom.api.arrays import ticks_of
from werrimbi_odom.api.drives import read_run, require_robot
from werrimbi_odom.api.result import Result
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.references.start_pose import driven, start_of, with_learnt_phases
from werrimbi_odom.files.robot_files.robot_file import RobotFile
from werrimbi_odom.files.run import Run, Ticks, by_hand
from werrimbi_odom.files.tables.counter_columns import wraps_words
from werrimbi_odom.files.text_files import replacing
from werrimbi_odom.inference.legs.usable_run import with_no_driving
from werrimbi_odom.model.effect import view_of
from werrimbi_odom.model.encoder_online import EncoderLimits
from werrimbi_odom.model.end_of_piece import PieceTolerance
from werrimbi_odom.model.pose import Floats, Pose, wrap_all
from werrimbi_odom.model.reference_measurement import Path as ShownPath
from werrimbi_odom.model.reference_measurement import shown
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.trajectory import Trajectory, trajectory
from werrimbi_odom.progress import Show, silent
from werrimbi_odom.report.dead_reckoning_summary import Reckoning, reckoning_of
from werrimbi_odom.report.odom import document_of, json_of, rows_told

COLUMNS = "t_s,x_m,y_m,yaw_rad,xx,xy,xyaw,yy,yyaw,yawyaw"
_BLOCK = 32768  # rows formatted at once
Found = TypeVar("Found")


@dataclass(frozen=True, repr=False, kw_only=True)
class Reckoned(Result[Any]):
    """Dead reckoning of a run."""

    found: Reckoning

    def write_rows(
        self, path: str | Path, *, as_reference: bool = False, show: Show = silent
    ) -> None:
        """Write pose and covariance for each row of ticks; an existing file is replaced.

        Parameters
        ----------
        as_reference
            Write the predicted measurement of the reference instead of the axle's midpoint.

        Raises
        ------
        InputError
            If the file cannot be written.
        """
        ticks, driven = self.found.run.ticks, self.found.driven
        with replacing(Path(path)) as file:
            shown = self.found.shown if as_reference else driven
            _write_rows(file, ticks.time, driven.expanded(ticks.rows), shown, show)


def odom(robot: RobotFile, run: Run | str | Path) -> Reckoned:
    """Dead reckoning of a run, starting at the first pose of the reference.

    Parameters
    ----------
    robot
        From `read_robot`.
    run
        From `read_run`, or its path.

    Raises
    ------
    InputError
        If the run is not usable; the message gives the reason.
    """
    recorded = run if isinstance(run, Run) else read_run(run, robot)
    complete, learnt = _usable(recorded, lambda: with_learnt_phases(recorded, robot))
    start = _usable(recorded, lambda: start_of(recorded, complete))
    driven = _reckoned(recorded, complete, start.pose)
    seen = shown(driven, view_of(complete.robot.effects))
    remarks = (*learnt, *_by_hand_words(with_no_driving(recorded, robot.robot, robot.limits)))
    found = reckoning_of(recorded, start, driven, seen, remarks)
    return Reckoned(
        found=found,
        document=lambda: document_of(found, robot.path),
        figures_of_json=lambda: json_of(found),
    )


def _by_hand_words(run: Run) -> Iterator[str]:
    """Remarks on stretches in which the wheels do not say how the robot moved."""
    began = float(run.ticks.time[0])
    for part in by_hand(run.no_driving):
        yield (
            f"from {part.begin - began:.1f} s to {part.end - began:.1f} s {part.words}; the error "
            "at the end is of that, too"
        )


def _usable(recorded: Run, work: Callable[[], Found]) -> Found:
    """Run some work on a run; an error names the run."""
    try:
        with np.errstate(all="ignore"):  # absurd values are detected and reported once, at the end
            return work()
    except ValueError as error:
        raise InputError(f"{recorded.path}: {error}") from error


def _reckoned(recorded: Run, robot_file: RobotFile, start: Pose) -> Trajectory:
    found = _usable(recorded, lambda: driven(recorded, robot_file, start))
    for values in (found.x, found.y, found.yaw, *found.covariance):
        wrong = np.flatnonzero(~np.isfinite(values))
        if wrong.size:
            row = int(found.row[wrong[0]]) + 1
            raise InputError(
                f"{recorded.path}: the pose grows beyond all numbers at row {row} of the ticks; "
                "are the counts, and wheel_radius, right?"
            )
    return found


def _write_rows(
    file: TextIO, time: Floats, entry: NDArray[np.intp], driven: Trajectory | ShownPath, show: Show
) -> None:
    estimates = (driven.x, driven.y, _half_open(driven.yaw), *driven.covariance)
    file.write(COLUMNS + "\n")
    for first in range(0, time.size, _BLOCK):
        rows = slice(first, first + _BLOCK)
        table = np.stack([time[rows], *(values[entry[rows]] for values in estimates)], axis=1)
        # repr is the shortest text that parses to the same number
        file.writelines(",".join(map(repr, row)) + "\n" for row in table.tolist())
        show(first / time.size, "writing")


def _half_open(yaw: Floats) -> Floats:
    """Wrap angles to (-pi, pi]."""
    wrapped = wrap_all(yaw)
    return np.minimum(np.where(wrapped <= -np.pi, wrapped + 2.0 * np.pi, wrapped), np.pi)


_FAULTS = (
    *("duplicates", "out_of_order", "not_finite", "implausible", "clock_jumps", "resets", "jumps"),
)
"""Counts of `EncoderTally` that are worth a warning, however few."""


class Odometry(NamedTuple):
    """Pose and covariance for each row of ticks, in the frame of the start."""

    x: Floats
    """[m], shape (n,)"""
    y: Floats
    """[m], shape (n,)"""
    yaw: Floats
    """Unwrapped [rad], shape (n,)."""
    covariance: Floats
    """Covariance of (x, y, yaw) [m², m·rad, rad²], shape (n, 3, 3)."""

    def __repr__(self) -> str:
        x, y, yaw, covariance = (values[-1] for values in self)
        around = ", ".join(
            f"{name} {value:.6g} ± {math.sqrt(max(variance, 0.0)):.2g} {unit}"
            for name, value, variance, unit in zip(
                ("x", "y", "yaw"),
                (x, y, yaw),
                np.diagonal(covariance),
                ("m", "m", "rad"),
                strict=True,
            )
        )
        return f"<Odometry of {self.x.size} rows, to {around}>"


def odometry(
    robot: RobotFile | Robot,
    t: ArrayLike,
    left: ArrayLike,
    right: ArrayLike,
    *,
    start: tuple[float, float, float] = (0.0, 0.0, 0.0),
    channels: Mapping[str, ArrayLike] | None = None,
) -> Odometry:
    """Wheel odometry of recorded ticks, with the closed-form covariance of Chong and Kleeman.

    Parameters
    ----------
    robot
        From `read_robot`, or a `werrimbi_odom.model.robot.Robot`.
    t
        Stamps [s], shape (n,).
    left, right
        Cumulative signed counts of the encoders, shape (n,).
    start
        Pose at the first row: x [m], y [m], yaw [rad].
    channels
        Further measured columns that an effect reads, by name, shape (n,) each.

    Returns
    -------
    Odometry
        One row per row of ticks; an unusable row repeats the latest estimate.

    Warns
    -----
    UserWarning
        If rows were not usable, or counters were reset, wrap, or have gaps nearly everywhere.

    Raises
    ------
    InputError
        If the arrays differ in length or hold no numbers, or no row after the first is usable.
    """
    require_robot(robot, RobotFile | Robot)
    if isinstance(robot, RobotFile):
        plain, tolerance, limits = robot.robot, robot.tolerance, robot.limits
    else:
        plain, tolerance, limits = robot, PieceTolerance(), EncoderLimits()
    ticks = ticks_of(t, left, right, channels)
    try:
        driven = trajectory(
            plain,
            ticks.time,
            ticks.left,
            ticks.right,
            start=Pose(*start),
            tolerance=tolerance,
            limits=limits,
            channels=ticks.channels,
        )
    except ValueError as error:
        raise InputError(str(error)) from error
    _remark(ticks, plain, driven)
    rows = driven.expanded(ticks.rows)
    covariance = driven.covariance.matrix()[rows]
    return Odometry(driven.x[rows], driven.y[rows], driven.yaw[rows], covariance)


def _remark(ticks: Ticks, robot: Robot, driven: Trajectory) -> None:
    """Warn about rows that were not usable, and columns that do not look like ticks."""
    tally = driven.tally.as_dict()
    told = f"rows of ticks: {rows_told(tally)}"
    if ticks.rows > 1 and driven.row.size == 1:
        raise InputError(f"no row after the first can be used; {told}")
    words = "" if robot.encoder_bits else wraps_words(ticks)
    if words:
        warnings.warn(words, stacklevel=3)
    if 2 * tally["gaps"] > ticks.rows:
        told += "; is t in seconds, and in the first place?"
    elif not any(tally[name] for name in _FAULTS):
        return
    warnings.warn(told, stacklevel=3)
