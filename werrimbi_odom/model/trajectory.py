# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Odometry of a whole recorded run at once: what `Odometer` does row by row, in array operations."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.covariance import (
    CERTAIN,
    PathNoise,
    PoseCovariance,
    carried,
    noise_of_wheel_variances,
    path_noise,
    piece_covariance,
    plus,
)
from werrimbi_odom.model.cutting import Cut, cut
from werrimbi_odom.model.encoder import (
    Counts,
    EncoderLimits,
    EncoderTally,
    wheel_steps,
)
from werrimbi_odom.model.motion import BodyMotion, WheelTravel, displacement, wheels_to_body
from werrimbi_odom.model.pieces import Piece, PieceRule, PieceTolerance, kind_of
from werrimbi_odom.model.pose import Floats, Pose
from werrimbi_odom.model.robot import Robot

_BLOCK = 16384  # rows whose covariances are worked at once: their arrays stay in the cache


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
) -> Trajectory:
    """Dead reckoning of a recorded run.

    Parameters
    ----------
    time : ndarray, shape (rows,), [s]
    left, right : ndarray, shape (rows,)
        Cumulative signed counts, integer or float.
    start, covariance
        Pose before the first row and its covariance.

    Raises
    ------
    ValueError
        When no row can be used (empty, or none with finite numbers).
    """
    steps = wheel_steps(robot, time, left, right, limits)
    if steps.first_row < 0:
        raise ValueError("no row has a finite time and finite counts")
    travel = WheelTravel(steps.left, steps.right)
    motion = wheels_to_body(travel, robot.track)
    yaw = _summed(start.yaw, motion.turn)
    dx, dy = displacement(motion, yaw[:-1])
    x, y = _summed(start.x, dx), _summed(start.y, dy)
    lost = noise_of_wheel_variances(steps.left_lost, steps.right_lost, robot.track)
    rule = PieceRule.of(robot, tolerance or PieceTolerance())
    pieces = cut(rule, travel, motion, x, y, yaw, broken=lost.b > 0.0)
    chain = _chained(robot, pieces, x, y, yaw, covariance, lost)
    stamps = np.concatenate([time[[steps.first_row]], steps.time])
    return Trajectory(
        stamps,
        x,
        y,
        yaw,
        _at_every_step(robot, pieces, x, y, yaw, chain, covariance),
        np.concatenate([[steps.first_row], steps.row]),
        steps.tally,
        _as_values(robot, pieces, chain, stamps, x, y, yaw),
    )


def _summed(start: float, steps: Floats) -> Floats:
    return np.cumsum(np.concatenate([[start], steps]))


def _chained(
    robot: Robot,
    pieces: Cut,
    x: Floats,
    y: Floats,
    yaw: Floats,
    covariance: PoseCovariance[float],
    lost: PathNoise[Floats],
) -> list[PoseCovariance[float]]:
    """Covariance of the pose at the start of each piece, from one piece to the next."""
    begin = pieces.start
    end = np.append(begin[1:], x.size - 1)
    own = _own_covariance(robot, pieces, end - 1, yaw[begin])
    hidden = piece_covariance(
        BodyMotion(*np.zeros((3, begin.size))),
        PathNoise(*(part[begin] for part in lost)),
        yaw[begin],
    )
    rows = zip(
        (x[end] - x[begin]).tolist(),
        (y[end] - y[begin]).tolist(),
        zip(*(entry.tolist() for entry in own), strict=True),
        zip(*(entry.tolist() for entry in hidden), strict=True),
        strict=True,
    )
    chain = []
    for dx, dy, added, unseen in rows:
        if any(unseen):
            covariance = plus(covariance, PoseCovariance(*unseen))
        chain.append(covariance)
        covariance = plus(carried(covariance, dx, dy), PoseCovariance(*added))
    return chain


def _own_covariance(
    robot: Robot, pieces: Cut, steps: NDArray[np.intp] | slice, yaw: Floats
) -> PoseCovariance[Floats]:
    """Covariance that the pieces have added by the end of some steps; `yaw` at their starts."""
    noise = path_noise(robot, pieces.travel.left[steps], pieces.travel.right[steps])
    return piece_covariance(BodyMotion(*(part[steps] for part in pieces.motion)), noise, yaw)


def _at_every_step(
    robot: Robot,
    pieces: Cut,
    x: Floats,
    y: Floats,
    yaw: Floats,
    chain: list[PoseCovariance[float]],
    covariance: PoseCovariance[float],
) -> PoseCovariance[Floats]:
    """Covariance at every entry: the chain up to its piece, and the piece in closed form."""
    count = x.size - 1
    at_start = np.array(chain, dtype=np.float64).reshape(-1, 6).T
    lengths = np.diff(np.append(pieces.start, count))
    piece = np.repeat(np.arange(lengths.size), lengths)
    result = np.empty((6, count + 1))
    result[:, 0] = covariance
    for first in range(0, count, _BLOCK):
        block = slice(first, min(first + _BLOCK, count))
        own_piece = piece[block]
        begin = pieces.start[own_piece]
        after = slice(block.start + 1, block.stop + 1)
        earlier = PoseCovariance(*at_start[:, own_piece])
        moved = carried(earlier, x[after] - x[begin], y[after] - y[begin])
        result[:, after] = plus(moved, _own_covariance(robot, pieces, block, yaw[begin]))
    return PoseCovariance(*result)


def _as_values(
    robot: Robot,
    pieces: Cut,
    chain: list[PoseCovariance[float]],
    time: Floats,
    x: Floats,
    y: Floats,
    yaw: Floats,
) -> tuple[Piece, ...]:
    end = np.append(pieces.start[1:], x.size - 1)
    values = []
    for begin, stop, covariance in zip(pieces.start.tolist(), end.tolist(), chain, strict=True):
        motion = BodyMotion(*(float(part[stop - 1]) for part in pieces.motion))
        values.append(
            Piece(
                kind_of(motion, robot.track),
                float(time[begin]),
                float(time[stop]),
                Pose(float(x[begin]), float(y[begin]), float(yaw[begin])),
                WheelTravel(*(float(part[stop - 1]) for part in pieces.travel)),
                motion,
                covariance,
            )
        )
    return tuple(values)
