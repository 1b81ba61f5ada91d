# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Errors of the legs, and whether the covariance promised them: RMSE, NEES, coverage."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference.likelihood import (
    ReferenceKind,
    reading_noise,
    relative_errors,
)
from werrimbi_odom.inference.matching import MatchedRun
from werrimbi_odom.inference.prediction import Prediction, predict
from werrimbi_odom.model.covariance import PathNoise, piece_covariance
from werrimbi_odom.model.motion import BodyMotion
from werrimbi_odom.model.pieces import PieceKind, kind_of
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

CHI2_95_OF_3 = 7.814727903251179
"""95 % quantile of chi-squared with three degrees of freedom."""


@dataclass(frozen=True, slots=True)
class LegErrors:
    """Measured minus predicted relative pose of legs, and the covariance promised for it."""

    error: Floats
    """(x, y, yaw) in the frame of the robot at the leg's start, shape (m, 3) [m, m, rad]."""
    covariance: Floats
    """Of the error: wheels, counts and reference, shape (m, 3, 3)."""
    kind: NDArray[np.str_]
    """line, arc or spin, shape (m,)."""
    length: Floats
    """Path driven, shape (m,) [m]."""

    @property
    def distance(self) -> Floats:
        """Position errors, shape (m,) [m]."""
        return np.hypot(self.error[:, 0], self.error[:, 1])

    @property
    def deviation(self) -> Floats:
        """Squared Mahalanobis distance error' Σ⁻¹ error, shape (m,): chi-squared of 3 if honest."""
        solved = np.linalg.solve(self.covariance, self.error[..., None])[..., 0]
        return np.asarray(np.sum(self.error * solved, axis=-1))

    def chosen(self, which: NDArray[np.bool_]) -> LegErrors:
        """Some of the legs."""
        return LegErrors(
            self.error[which], self.covariance[which], self.kind[which], self.length[which]
        )


@dataclass(frozen=True, slots=True)
class LegStatistics:
    """Figures over legs; NaN where there are none."""

    count: int
    rmse_position_m: float
    median_position_m: float
    rmse_yaw_rad: float
    nees: float
    """Mean of error' Σ⁻¹ error over 3: 1 where the covariance is honest."""
    coverage_95: float
    """Share of legs inside the 95 % ellipsoid."""


def leg_errors(
    robot: Robot,
    run: MatchedRun,
    sigma_xy: float,
    sigma_yaw: float,
    kind: ReferenceKind = "absolute",
) -> LegErrors:
    """Errors of all legs of a run whose reference has full poses.

    Parameters
    ----------
    sigma_xy, sigma_yaw : float
        Noise of the reference: of each pose (absolute) or each interval (incremental) [m, rad].
    """
    prediction = predict(robot, run)
    wheels = (
        robot.left_wheel_noise**2 * prediction.per_left
        + robot.right_wheel_noise**2 * prediction.per_right
    )
    reference = _reference_part(robot, run, prediction, sigma_xy, sigma_yaw, kind)
    motion = zip(prediction.along.tolist(), prediction.turn.tolist(), strict=True)
    kinds: list[PieceKind] = [
        kind_of(BodyMotion(along, 0.0, turn), robot.track) for along, turn in motion
    ]
    return LegErrors(
        relative_errors(run, prediction), wheels + reference, np.array(kinds), prediction.length
    )


def _reference_part(
    robot: Robot,
    run: MatchedRun,
    prediction: Prediction,
    sigma_xy: float,
    sigma_yaw: float,
    kind: ReferenceKind,
) -> Floats:
    """What the reference itself adds to the error of a leg."""
    reading = reading_noise(robot)
    of_pose = np.array([sigma_xy**2, sigma_xy**2, sigma_yaw**2])
    if kind == "incremental":
        none = np.zeros(run.legs)
        leg = BodyMotion(prediction.along, none, prediction.turn)
        noise = PathNoise(none, run.intervals * sigma_yaw**2, none)
        flat = run.intervals[:, None, None] * np.diag([sigma_xy**2, sigma_xy**2, 0.0])
        return piece_covariance(leg, noise, none).matrix() + flat + 2.0 * np.diag(reading)
    lever = np.zeros((run.legs, 3, 3)) + np.eye(3)
    lever[:, 0, 2], lever[:, 1, 2] = -prediction.relative[:, 1], prediction.relative[:, 0]
    pose = np.diag(of_pose + reading)
    return np.asarray(pose + lever @ pose @ lever.transpose(0, 2, 1))


def statistics(legs: LegErrors) -> LegStatistics:
    """Figures over all of the legs given."""
    count = legs.error.shape[0]
    if count == 0:
        nothing = float("nan")
        return LegStatistics(0, nothing, nothing, nothing, nothing, nothing)
    deviation = legs.deviation
    return LegStatistics(
        count,
        float(np.sqrt(np.mean(legs.distance**2))),
        float(np.median(legs.distance)),
        float(np.sqrt(np.mean(legs.error[:, 2] ** 2))),
        float(np.mean(deviation) / 3.0),
        float(np.mean(deviation <= CHI2_95_OF_3)),
    )


def joined(parts: list[LegErrors]) -> LegErrors:
    """Legs of several runs as one set."""
    return LegErrors(
        np.concatenate([part.error for part in parts]),
        np.concatenate([part.covariance for part in parts]),
        np.concatenate([part.kind for part in parts]),
        np.concatenate([part.length for part in parts]),
    )
