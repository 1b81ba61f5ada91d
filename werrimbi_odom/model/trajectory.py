# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Odometry of a whole recorded run at once: what `Odometer` does row by row, in arrays."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.covariance import (
    CERTAIN,
    PathNoise,
    PoseCovariance,
    noise_of_wheel_variances,
    path_noise,
)
from werrimbi_odom.model.cutting import Cut, cut
from werrimbi_odom.model.drive import Span
from werrimbi_odom.model.driving import acts, features
from werrimbi_odom.model.effect import wiring_of
from werrimbi_odom.model.encoder import Counts, EncoderLimits, EncoderTally
from werrimbi_odom.model.moments import PathMoments
from werrimbi_odom.model.motion import BodyMotion, WheelTravel, displacement, wheels_to_body
from werrimbi_odom.model.passes import Driven, driven
from werrimbi_odom.model.pieces import Piece, PieceRule, PieceTolerance, kind_of
from werrimbi_odom.model.pose import Floats, Pose
from werrimbi_odom.model.recorded_counts import wheel_steps
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.uncertainty import Uncertainty, after_piece, known

_BLOCK = 8192  # rows whose covariances are worked at once: their arrays stay in the cache


@dataclass(frozen=True, slots=True)
class Trajectory:
    """Poses and covariances at every accepted row of a run; arrays of shape (n,).

    The first entry is the start; `row` tells the row of the record that each entry belongs to.
    """

    time: Floats
    """Stamps [s]."""
    x: Floats
    y: Floats
    yaw: Floats
    """Goes on counting past a whole turn [rad]."""
    covariance: PoseCovariance[Floats]
    """In the odometry frame."""
    mean_shift: tuple[Floats, Floats] | None
    """Where exact moments are carried: mean of the true position less the pose (x, y) [m]."""
    row: NDArray[np.intp]
    """Rows of the record."""
    tally: EncoderTally
    """What became of the rows."""
    pieces: tuple[Piece, ...]
    """The run cut into lines, arcs and spins; the last one is cut off by the run's end."""

    def expanded(self, rows: int) -> NDArray[np.intp]:
        """For each of the record's `rows`, the index of the latest entry (0 before the first)."""
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
        Extra measured channels; NaN where not measured, which is interpolated.

    Raises
    ------
    ValueError
        When no row can be used (empty, or none with finite numbers), or an effect looks at a
        channel that was not measured.
    """
    left, right = wiring_of(robot.effects).wheels(left, right)
    steps = wheel_steps(robot, time, left, right, limits)
    if steps.first_row < 0:
        raise ValueError("no row has a finite time and finite counts")
    raw = WheelTravel(steps.left, steps.right)
    first_counts = float(left[steps.first_row]), float(right[steps.first_row])
    rows = np.concatenate([[steps.first_row], steps.row])
    spans = channel_spans(time[rows], channels or {}, rows)
    travel, motion = _driven(robot, steps.duration, raw, first_counts, spans, start)
    x, y, yaw = _integrated(start, motion)
    lost = noise_of_wheel_variances(steps.left_lost, steps.right_lost, robot.track)
    rule = PieceRule.of(robot, tolerance or PieceTolerance())
    pieces = cut(rule, travel, motion, x, y, yaw, broken=lost.b > 0.0)
    at_start = known(robot.covariance_order, covariance)
    chain = _chained(robot, pieces, x, y, yaw, at_start, lost)
    errors = _at_every_step(robot, pieces, x, y, yaw, chain, at_start)
    stamps = np.concatenate([time[[steps.first_row]], steps.time])
    return Trajectory(
        stamps,
        x,
        y,
        yaw,
        errors.covariance,
        errors.mean_shift,
        rows,
        steps.tally,
        _as_values(robot, pieces, chain, stamps, x, y, yaw),
    )


def _driven(
    robot: Robot,
    duration: Floats,
    raw: WheelTravel[Floats],
    first_counts: tuple[float, float],
    channels: Mapping[str, Span[Floats]],
    start: Pose,
) -> Driven:
    """Travel and motion of the steps; nothing is worked out for effects that are not there."""
    if not acts(robot):
        return Driven(raw, wheels_to_body(raw, robot.track))
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


def _integrated(start: Pose, motion: BodyMotion[Floats]) -> Floats:
    """x, y, yaw before the first step and after each, shape (3, n + 1)."""
    poses = np.empty((3, motion.turn.size + 1))
    poses[:, 0] = start
    poses[2, 1:] = motion.turn
    np.cumsum(poses[2], out=poses[2])
    for steps in _blocks(motion.turn.size):
        part = BodyMotion(*(values[steps] for values in motion))
        poses[:2, 1:][:, steps] = displacement(part, poses[2, steps])
    np.cumsum(poses[:2], axis=1, out=poses[:2])
    return poses


def _blocks(count: int) -> Iterator[slice]:
    """Some thousand steps at a time: their arrays stay in the cache."""
    return (slice(first, min(first + _BLOCK, count)) for first in range(0, count, _BLOCK))


def _ends(pieces: Cut, count: int) -> NDArray[np.intp]:
    """First step after each piece; none where a single row left nothing to cut."""
    return np.append(pieces.start[1:], count)[: pieces.start.size]


def _chained(
    robot: Robot,
    pieces: Cut,
    x: Floats,
    y: Floats,
    yaw: Floats,
    errors: Uncertainty[float],
    lost: PathNoise[Floats],
) -> list[Uncertainty[float]]:
    """Errors of the pose at the start of each piece, from one piece to the next."""
    begin = pieces.start
    end = _ends(pieces, x.size - 1)
    whole = np.stack([part[end - 1] for part in (*pieces.travel, *pieces.motion)])
    rows = zip(
        (x[end] - x[begin]).tolist(),
        (y[end] - y[begin]).tolist(),
        yaw[begin].tolist(),
        whole.T.tolist(),
        zip(*(part[begin].tolist() for part in lost), strict=True),
        strict=True,
    )
    chain = []
    for dx, dy, heading, (left, right, *motion), unseen in rows:
        if any(unseen):
            still = BodyMotion(0.0, 0.0, 0.0)
            errors = after_piece(errors, still, PathNoise(*unseen), heading, 0.0, 0.0)
        chain.append(errors)
        noise = path_noise(robot, left, right)
        errors = after_piece(errors, BodyMotion(*motion), noise, heading, dx, dy)
    return chain


def _at_every_step(
    robot: Robot,
    pieces: Cut,
    x: Floats,
    y: Floats,
    yaw: Floats,
    chain: list[Uncertainty[float]],
    at_start: Uncertainty[float],
) -> Uncertainty[Floats]:
    """Errors at every entry: the chain up to its piece, and the piece in closed form."""
    count = x.size - 1
    lengths = np.diff(np.append(pieces.start, count))
    piece = np.repeat(np.arange(lengths.size), lengths)
    starts = _as_columns(chain)
    covariance = np.empty((6, count + 1))
    covariance[:, 0] = at_start.covariance
    shift = np.zeros((2, count + 1))
    exact = at_start.moments is not None
    for block in _blocks(count):
        own_piece = piece[block]
        begin = pieces.start[own_piece]
        after = slice(block.start + 1, block.stop + 1)
        noise = path_noise(robot, pieces.travel.left[block], pieces.travel.right[block])
        errors = after_piece(
            Uncertainty(
                PoseCovariance(*(column[own_piece] for column in starts.covariance)),
                PathMoments(*(column[own_piece] for column in starts.moments))
                if starts.moments is not None
                else None,
            ),
            BodyMotion(*(part[block] for part in pieces.motion)),
            noise,
            yaw[begin],
            x[after] - x[begin],
            y[after] - y[begin],
        )
        covariance[:, after] = errors.covariance
        if errors.mean_shift is not None:
            shift[:, after] = errors.mean_shift
    moments = PathMoments(shift[0] + 1j * shift[1]) if exact else None
    return Uncertainty(PoseCovariance(*covariance), moments)


def _as_columns(chain: list[Uncertainty[float]]) -> Uncertainty[Floats]:
    """Errors at the starts of all pieces as arrays of shape (m,)."""
    covariance = PoseCovariance(*np.array([each.covariance for each in chain]).reshape(-1, 6).T)
    moments = [each.moments for each in chain if each.moments is not None]
    if not moments:
        return Uncertainty(covariance)
    columns = (np.array(column) for column in zip(*moments, strict=True))
    return Uncertainty(covariance, PathMoments(*columns))


def _as_values(
    robot: Robot,
    pieces: Cut,
    chain: list[Uncertainty[float]],
    time: Floats,
    x: Floats,
    y: Floats,
    yaw: Floats,
) -> tuple[Piece, ...]:
    begin = pieces.start
    end = _ends(pieces, x.size - 1)
    starts = np.stack([part[begin] for part in (x, y, yaw)])
    travels = np.stack([part[end - 1] for part in pieces.travel])
    motions = np.stack([part[end - 1] for part in pieces.motion])
    rows = zip(
        time[begin].tolist(),
        time[end].tolist(),
        (Pose(*start) for start in starts.T.tolist()),
        (WheelTravel(*travel) for travel in travels.T.tolist()),
        (BodyMotion(*motion) for motion in motions.T.tolist()),
        chain,
        strict=True,
    )
    return tuple(
        Piece(kind_of(motion, robot.track), since, until, start, travel, motion, errors.covariance)
        for since, until, start, travel, motion, errors in rows
    )
