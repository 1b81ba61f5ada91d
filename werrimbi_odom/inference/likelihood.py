# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What the reference says that the model did not expect: innovations, white under a true model.

A Kalman filter carries the pose from one reference pose to the next with the closed-form noise of
the leg between them. What it did not expect (the innovation) has a known covariance and is
independent from leg to leg, whatever the reference measures: full poses, positions alone, a heading
alone, two poses in a drive. So likelihood, fits and tests for all of them rest on one loop.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference.matching import MatchedRun
from werrimbi_odom.inference.prediction import Prediction
from werrimbi_odom.model.covariance import PathNoise, piece_covariance
from werrimbi_odom.model.motion import BodyMotion
from werrimbi_odom.model.pose import Floats, wrap_all
from werrimbi_odom.model.robot import Robot

ReferenceKind = Literal["absolute", "incremental"]

_UNMEASURED = 1e6
"""Variance [m², rad²] that stands for a coordinate that was not measured."""


@dataclass(frozen=True, slots=True)
class Variances:
    """The four variances of the noise; arrays of shape (g,) for g sets tried at once.

    The reference's are of each pose (absolute) or of each interval (incremental).
    """

    left: Floats
    """k_L² [m]."""
    right: Floats
    """k_R² [m]."""
    xy: Floats
    """Of the reference's position, each coordinate [m²]."""
    yaw: Floats
    """Of the reference's heading [rad²]."""


@dataclass(frozen=True, slots=True)
class Innovations:
    """Measured minus expected pose at the end of each leg.

    In the frame of the robot at the leg's start: (along, sideways, heading) [m, m, rad].
    """

    value: Floats
    """Shape (g, m, 3); zero where nothing was measured."""
    covariance: Floats
    """Shape (g, m, 3, 3)."""
    change: Floats
    """Derivative in p parameters for the first set of variances, shape (m, 3, p)."""
    known: NDArray[np.bool_]
    """Which coordinates were measured and are to be counted, shape (m, 3)."""

    def minus_two_log_likelihood(self) -> Floats:
        """Of each set of variances, constants left out; shape (g,)."""
        solved = np.linalg.solve(self.covariance, self.value[..., None])[..., 0]
        misfit = np.sum(self.value * solved, axis=-1)
        volume = np.linalg.slogdet(self.covariance)[1]
        counted = self.known.any(axis=-1)
        return np.asarray(np.sum((misfit + volume)[:, counted], axis=-1))

    def whitened(self) -> tuple[Floats, Floats]:
        """Innovations of unit variance (m, 3) and their derivatives (m, 3, p), first set."""
        factor = np.linalg.cholesky(self.covariance[0])
        joined = np.concatenate([self.value[0][..., None], self.change], axis=-1)
        white = np.linalg.solve(factor, joined)
        white[~self.known] = 0.0
        return white[..., 0], white[..., 1:]


def innovations(
    robot: Robot,
    run: MatchedRun,
    prediction: Prediction,
    variances: Variances,
    kind: ReferenceKind,
    *,
    change: Floats | None = None,
    excluded: NDArray[np.bool_] | None = None,
    start_yaw: float | None = None,
) -> Innovations:
    """Filter a run and keep what was unexpected.

    Parameters
    ----------
    change : ndarray, shape (m, 3, p), optional
        Derivatives of the legs' relative poses (`prediction.sensitivity`).
    excluded : ndarray of bool, shape (m,), optional
        Legs on which the reference jumped: not counted, and the pose starts anew after them.
    start_yaw : float, optional
        Heading at the first reference pose, where that was not measured [rad]. Its derivative is
        then the last column of `change` in the result.
    """
    count = run.legs
    slopes = np.zeros((count, 3, 0)) if change is None else change
    skip = np.zeros(count, dtype=np.bool_) if excluded is None else excluded
    if kind == "incremental":
        return _of_increments(robot, run, prediction, variances, slopes, skip)
    return _of_poses(robot, run, prediction, variances, slopes, skip, start_yaw)


def _of_increments(
    robot: Robot,
    run: MatchedRun,
    prediction: Prediction,
    variances: Variances,
    slopes: Floats,
    skip: NDArray[np.bool_],
) -> Innovations:
    """Legs are independent: the noise of each interval of the reference is its own."""
    value = relative_errors(run, prediction)
    known = np.isfinite(value) & ~skip[:, None]
    leg = BodyMotion(prediction.along, np.zeros(run.legs), prediction.turn)
    swing = piece_covariance(
        leg, PathNoise(np.zeros(run.legs), run.intervals, np.zeros(run.legs)), np.zeros(run.legs)
    ).matrix()
    reading = reading_noise(robot)
    covariance = (
        _wheel_part(prediction, variances)
        + variances.yaw[:, None, None, None] * swing
        + variances.xy[:, None, None, None]
        * run.intervals[:, None, None]
        * np.diag([1.0, 1.0, 0.0])
        + 2.0 * np.diag(reading)
    )
    covariance = covariance + _UNMEASURED * _diagonal(~np.isfinite(value))
    value = np.where(known, value, 0.0)
    sets = variances.left.size
    return Innovations(
        np.broadcast_to(value, (sets, *value.shape)), covariance, slopes * -1.0, known
    )


def relative_errors(run: MatchedRun, prediction: Prediction) -> Floats:
    """Measured minus predicted relative pose of each leg, shape (m, 3); NaN where not measured.

    In the frame of the robot at the leg's start, as the reference gives it.
    """
    measured = run.measured
    dx, dy = np.diff(measured.x), np.diff(measured.y)
    cos, sin = np.cos(measured.yaw[:-1]), np.sin(measured.yaw[:-1])
    relative = np.stack([cos * dx + sin * dy, cos * dy - sin * dx, np.diff(measured.yaw)], axis=-1)
    error = relative - prediction.relative
    error[:, 2] = wrap_all(error[:, 2])
    return np.asarray(error)


def _of_poses(
    robot: Robot,
    run: MatchedRun,
    prediction: Prediction,
    variances: Variances,
    slopes: Floats,
    skip: NDArray[np.bool_],
    start_yaw: float | None,
) -> Innovations:
    sets, count = variances.left.size, run.legs
    measured = np.stack([run.measured.x, run.measured.y, run.measured.yaw], axis=-1)
    finite = np.isfinite(measured)
    known = finite[1:] & ~skip[:, None]
    reading = np.zeros((sets, 3, 3))
    reading[:, 0, 0] = reading[:, 1, 1] = variances.xy
    reading[:, 2, 2] = variances.yaw
    reading += np.diag(reading_noise(robot))
    missing = _UNMEASURED * _diagonal(~finite)
    wheel = _wheel_part(prediction, variances)
    values = np.zeros((sets, count, 3))
    covariances = np.empty((sets, count, 3, 3))
    turns = np.empty((sets, count, 3, 3))
    width = slopes.shape[-1] + (start_yaw is not None)
    changes = np.zeros((count, 3, width))
    state = np.zeros((sets, 3)) + np.where(finite[0], measured[0], 0.0)
    spread = reading * (finite[0][:, None] & finite[0][None, :])
    slope = np.zeros((3, width))
    if start_yaw is not None:
        state[:, 2], slope[2, -1] = start_yaw, 1.0
    identity = np.eye(3)
    turn = np.zeros((sets, 3, 3))
    turn[:, 2, 2] = 1.0
    lever = np.zeros((sets, 3, 3)) + identity
    for leg in range(count):
        cos, sin = np.cos(state[:, 2]), np.sin(state[:, 2])
        turn[:, 0, 0] = turn[:, 1, 1] = cos
        turn[:, 0, 1], turn[:, 1, 0] = -sin, sin
        turns[:, leg] = turn
        move = turn @ prediction.relative[leg]
        lever[:, 0, 2], lever[:, 1, 2] = -move[:, 1], move[:, 0]
        state = state + move
        spread = lever @ spread @ lever.transpose(0, 2, 1)
        spread = spread + turn @ wheel[:, leg] @ turn.transpose(0, 2, 1)
        slope = lever[0] @ slope
        slope[:, : slopes.shape[-1]] += turn[0] @ slopes[leg]
        total = spread + reading + missing[leg + 1]
        covariances[:, leg] = total
        if skip[leg]:
            state = np.where(finite[leg + 1], measured[leg + 1], state)
            spread = reading * (finite[leg + 1][:, None] & finite[leg + 1][None, :])
            slope = np.where(finite[leg + 1][:, None], 0.0, slope)
            continue
        unexpected = np.where(finite[leg + 1], measured[leg + 1] - state, 0.0)
        unexpected[:, 2] = wrap_all(unexpected[:, 2])
        values[:, leg] = unexpected
        changes[leg] = np.where(finite[leg + 1][:, None], -slope, 0.0)
        gain = spread @ np.linalg.inv(total)
        state = state + (gain @ unexpected[..., None])[..., 0]
        spread = spread - gain @ spread
        spread = 0.5 * (spread + spread.transpose(0, 2, 1))
        slope = slope + gain[0] @ changes[leg]
    back = turns.transpose(0, 1, 3, 2)
    return Innovations(
        (back @ values[..., None])[..., 0], back @ covariances @ turns, back[0] @ changes, known
    )


def _wheel_part(prediction: Prediction, variances: Variances) -> Floats:
    """Covariance of the legs from the wheels' noise, shape (g, m, 3, 3)."""
    return np.asarray(
        variances.left[:, None, None, None] * prediction.per_left
        + variances.right[:, None, None, None] * prediction.per_right
    )


def reading_noise(robot: Robot) -> Floats:
    """Variance of a pose from reading both counters once, uniform over one count; shape (3,)."""
    left, right = robot.left_tick**2 / 12.0, robot.right_tick**2 / 12.0
    along = 0.25 * (left + right)
    return np.array([along, along, (left + right) / robot.track**2])


def _diagonal(rows: NDArray[np.bool_]) -> Floats:
    """Diagonal matrices of rows, shape (m, 3) to (m, 3, 3)."""
    return np.asarray(rows[..., None] * np.eye(3))
