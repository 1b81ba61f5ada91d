# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Odometry of a whole recorded run at once: the result of `Odometer` row by row."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.covariance import CERTAIN, PoseCovariance
from werrimbi_odom.model.drive import Span
from werrimbi_odom.model.driven_motion import acts, features
from werrimbi_odom.model.effect import wiring_of
from werrimbi_odom.model.effects_over_run import AfterEffects, driven
from werrimbi_odom.model.encoder_online import Counts, EncoderLimits, EncoderTally
from werrimbi_odom.model.encoder_recorded import lost_travel, wheel_steps
from werrimbi_odom.model.motion import WheelTravel, wheels_to_body
from werrimbi_odom.model.pieces import Piece
from werrimbi_odom.model.pieces_of_run import PiecesOfRun
from werrimbi_odom.model.pieces_online import PieceRule, PieceTolerance
from werrimbi_odom.model.pose import Floats, Pose
from werrimbi_odom.model.recorded_propagation import course_of
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.uncertainty import known


@dataclass(frozen=True, slots=True)
class Trajectory:
    """Poses and covariances at every accepted row of a run; arrays of shape (n,).

    The first entry is the start; `row` is the row of the record of each entry.
    """

    time: Floats
    """Stamps [s]."""
    x: Floats
    y: Floats
    yaw: Floats
    """Unwrapped [rad]."""
    covariance: PoseCovariance[Floats]
    """In the odometry frame."""
    mean_shift: tuple[Floats, Floats] | None
    """Mean of the true position minus the pose (x, y) [m]; None without exact moments."""
    row: NDArray[np.intp]
    """Rows of the record."""
    tally: EncoderTally
    """Counts of accepted and rejected rows."""
    pieces: Sequence[Piece]
    """Lines, arcs and spins; the last piece is cut off by the end of the run."""

    def expanded(self, rows: int) -> NDArray[np.intp]:
        """Index of the latest entry for each of the record's `rows` (0 before the first)."""
        return np.maximum(np.searchsorted(self.row, np.arange(rows), side="right") - 1, 0)


def trajectory(
    robot: Robot,
    time: Floats,
    left: Counts,
    right: Counts,
    *,
    start: Pose = Pose(),  # noqa: B008 - an immutable value
    covariance: PoseCovariance[float] = CERTAIN,
    tolerance: PieceTolerance | None = None,
    limits: EncoderLimits | None = None,
    channels: Mapping[str, Floats] | None = None,
) -> Trajectory:
    """Dead reckoning of a recorded run.

    Parameters
    ----------
    time : ndarray, shape (rows,), [s]
    left, right : ndarray, shape (rows,)
        Cumulative signed counts, integer or float.
    start, covariance
        Pose before the first row and its covariance.
    channels : mapping of name to ndarray, shape (rows,), optional
        Extra measured channels; NaN (not measured) is interpolated.

    Raises
    ------
    ValueError
        If no row is usable (empty, or without finite numbers), or an effect reads a channel that
        was not measured.
    """
    left, right = wiring_of(robot.effects).wheels(left, right)
    steps = wheel_steps(robot, time, left, right, limits)
    if steps.first_row < 0:
        raise ValueError("no row has a finite time and finite counts")
    raw = WheelTravel(steps.left, steps.right)
    first_counts = float(left[steps.first_row]), float(right[steps.first_row])
    rows = np.concatenate([[steps.first_row], steps.row])
    stamps = np.concatenate([time[[steps.first_row]], steps.time])
    spans = channel_spans(stamps, channels or {}, rows)
    driven_steps = _driven(robot, steps.duration, raw, first_counts, spans, start)
    known_start = known(robot.covariance_order, covariance)
    rule = PieceRule.of(robot, tolerance or PieceTolerance())
    course = course_of(robot, rule, start, known_start, driven_steps, lost_travel(steps))
    x, y, yaw = course.poses
    return Trajectory(
        stamps,
        x,
        y,
        yaw,
        PoseCovariance(*course.covariances),
        None if course.mean_shift is None else (course.mean_shift[0], course.mean_shift[1]),
        rows,
        steps.tally,
        PiecesOfRun(robot.track, stamps, course),
    )


def _driven(
    robot: Robot,
    duration: Floats,
    raw: WheelTravel[Floats],
    first_counts: tuple[float, float],
    channels: Mapping[str, Span[Floats]],
    start: Pose,
) -> AfterEffects:
    """Travel and motion of the steps; without effects, nothing is computed for them."""
    if not acts(robot):
        return AfterEffects(raw, wheels_to_body(raw, robot.track))
    drive = features(robot, duration, raw, first_counts, channels)
    return driven(robot, raw, drive, start)


def channel_spans(
    time: Floats, channels: Mapping[str, Floats], rows: NDArray[np.intp]
) -> dict[str, Span[Floats]]:
    """Channels at the start and end of each step between `rows`; gaps are interpolated."""
    spans = {}
    for name, values in channels.items():
        there = np.asarray(values, dtype=np.float64)[rows]
        known_rows = np.isfinite(there)
        if not known_rows.any():
            continue
        if not known_rows.all():
            there = np.interp(time, time[known_rows], there[known_rows])
        spans[name] = Span(there[:-1], there[1:])
    return spans
