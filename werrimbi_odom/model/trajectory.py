# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Odometry of a whole recorded run at once: the result of `Odometer` row by row, and its pieces.

The pieces are stored in columns; few of a million are read at a time.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import overload

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.covariance import CERTAIN, PoseCovariance
from werrimbi_odom.model.drive import Span
from werrimbi_odom.model.driven_motion import acts, features
from werrimbi_odom.model.effect import wiring_of
from werrimbi_odom.model.effects_over_run import AfterEffects, driven
from werrimbi_odom.model.encoder_online import Counts, EncoderLimits, EncoderTally
from werrimbi_odom.model.encoder_recorded import WheelSteps, lost_travel, wheel_steps
from werrimbi_odom.model.end_of_piece import PieceRule, PieceTolerance
from werrimbi_odom.model.motion import BodyMotion, WheelTravel, wheels_to_body
from werrimbi_odom.model.pieces import Piece, kind_of
from werrimbi_odom.model.pose import Floats, Pose
from werrimbi_odom.model.recorded_propagation import PathInPieces, course_of
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.uncertainty import known

_BLOCK = 1024  # pieces constructed together


@dataclass(frozen=True, slots=True, eq=False)
class PiecesOfRun(Sequence[Piece]):
    """A run cut into pieces; each is constructed when it is accessed."""

    track: float
    time: Floats
    """Stamps before the first step and after each [s], shape (n + 1,)."""
    course: PathInPieces

    def __len__(self) -> int:
        return self.course.start.size

    @overload
    def __getitem__(self, which: int) -> Piece: ...

    @overload
    def __getitem__(self, which: slice) -> tuple[Piece, ...]: ...

    def __getitem__(self, which: int | slice) -> Piece | tuple[Piece, ...]:
        if isinstance(which, slice):
            return tuple(self[at] for at in range(*which.indices(len(self))))
        (piece,) = self._made(range(len(self))[which], 1)
        return piece

    def __iter__(self) -> Iterator[Piece]:
        for first in range(0, len(self), _BLOCK):
            yield from self._made(first, min(_BLOCK, len(self) - first))

    def _made(self, first: int, count: int) -> Iterator[Piece]:
        course, which = self.course, slice(first, first + count)
        begin = course.start[which]
        end = np.append(course.start[first + 1 :][:count], self.time.size - 1)[:count]
        columns = zip(
            self.time[begin].tolist(),
            self.time[end].tolist(),
            course.poses[:, begin].T.tolist(),
            course.covariances[:, begin].T.tolist(),
            course.sums[:, which].T.tolist(),
            strict=True,
        )
        for at, (since, until, pose, errors, (left, right, *motion)) in enumerate(columns, first):
            body = BodyMotion(*motion)
            yield Piece(
                kind_of(body, self.track),
                since,
                until,
                Pose(*pose),
                WheelTravel(left, right),
                body,
                course.reset.get(at) or PoseCovariance(*errors),
            )


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
    spans = channel_spans(steps, channels or {})
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


def channel_spans(steps: WheelSteps, channels: Mapping[str, Floats]) -> dict[str, Span[Floats]]:
    """Channels of a record (rows,) at the start and end of its steps; gaps are interpolated."""
    rows = np.concatenate([[steps.first_row], steps.row])
    elapsed = np.concatenate([[0.0], np.cumsum(steps.duration)])  # a clock may be set back
    spans = {}
    for name, values in channels.items():
        there = np.asarray(values, dtype=np.float64)[rows]
        known_rows = np.isfinite(there)
        if not known_rows.any():
            continue
        if not known_rows.all():
            there = np.interp(elapsed, elapsed[known_rows], there[known_rows])
        spans[name] = Span(there[:-1], there[1:])
    return spans
