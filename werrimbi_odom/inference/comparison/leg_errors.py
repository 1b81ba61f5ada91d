# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Errors of the legs, and their statistics: RMSE, NEES, coverage."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.run import ReferenceKind
from werrimbi_odom.inference.comparison.local_map_errors import errors_on_map
from werrimbi_odom.inference.comparison.position_filter import position_errors
from werrimbi_odom.inference.distributions import CHI2_95
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import Model
from werrimbi_odom.inference.fitting.joined_legs import predict_joined
from werrimbi_odom.inference.fitting.leg_loop import lever_of, turn_into
from werrimbi_odom.inference.fitting.likelihood import (
    Variances,
    errors_between,
    paces,
    stated_shares,
    wheel_covariance,
)
from werrimbi_odom.inference.fitting.prediction import Prediction, extrinsics_of, right_handed
from werrimbi_odom.inference.fitting.quantisation import quantisation_of_legs, quantisation_variance
from werrimbi_odom.inference.fitting.reference_walk import map_walk, walked
from werrimbi_odom.model.effect import view_of
from werrimbi_odom.model.motion import BodyMotion
from werrimbi_odom.model.pieces import PieceKind, kind_of
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot


@dataclass(frozen=True, slots=True)
class LegErrors:
    """Measured minus predicted relative pose of legs, and its predicted covariance."""

    error: Floats
    """(x, y, yaw) in the frame of the robot at the leg's start, shape (m, 3) [m, m, rad].

    NaN where not measured.
    """
    covariance: Floats
    """Covariance of the error: wheels, encoder quantisation and reference, shape (m, 3, 3)."""
    kind: NDArray[np.str_]
    """line, arc or spin, shape (m,)."""
    length: Floats
    """Path length, shape (m,) [m]."""
    wheels: Floats
    """Part of the covariance from the wheel noise, shape (m, 3, 3)."""
    along: Floats
    """Signed travel, shape (m,) [m]."""
    turn: Floats
    """Heading change, shape (m,) [rad]."""
    heading: Floats
    """Heading of the robot at the leg's start, in the reference's frame, shape (m,); NaN where
    unknown [rad]."""

    @property
    def distance(self) -> Floats:
        """Position errors, shape (m,) [m]."""
        return np.hypot(self.error[:, 0], self.error[:, 1])

    @property
    def freedom(self) -> NDArray[np.intp]:
        """Degrees of freedom: how many of x, y, yaw were measured, shape (m,)."""
        return np.asarray(np.isfinite(self.error).sum(axis=1))

    @property
    def deviation(self) -> Floats:
        """Squared Mahalanobis distance error' Σ⁻¹ error, shape (m,): chi-squared if consistent."""
        return squared_deviation(self.error, self.covariance)

    def chosen(self, which: NDArray[np.bool_] | NDArray[np.intp]) -> LegErrors:
        """Select legs by mask or index."""
        return LegErrors(*(getattr(self, item.name)[which] for item in fields(self)))


@dataclass(frozen=True, slots=True)
class LegStatistics:
    """Statistics over legs; NaN where there are none, or where it was not measured."""

    count: int
    rmse_position_m: float
    median_position_m: float
    rmse_yaw_rad: float
    nees: float
    """Mean of error' Σ⁻¹ error over its degrees of freedom: 1 if the covariance is consistent."""
    coverage_95: float
    """Share of legs inside the 95 % ellipsoid."""
    freedom: int = 0
    """Degrees of freedom: measured coordinates of all errors."""


def errors_of(
    model: Model,
    runs: Concatenated,
    sigma_xy: float | Floats,
    sigma_yaw: float | Floats,
    kind: ReferenceKind = "absolute",
    *,
    by_position: bool = False,
    sigma_stamp: float = 0.0,
    wandering: Variances | None = None,
    jumped: NDArray[np.bool_] | None = None,
) -> LegErrors:
    """Errors of all legs of several runs.

    `model`: the model. `runs`: runs with m legs. `sigma_xy`, `sigma_yaw` (m,): noise of the
    reference: of each pose (absolute) or each interval (incremental) [m, rad]. `kind`: error model
    of the reference. `by_position`: the reference gives positions only; headings are then estimated
    from those before the leg. `sigma_stamp`: noise of the stamps of a gyro, or of scans [s].
    `wandering`: noise of a reference on a local map, in place of the sigmas. `jumped` (m,): legs on
    which the reference jumped.
    """
    robot = model.robot
    prediction = predict_joined(model, runs)
    view = view_of(robot.effects)
    start, finish = right_handed(runs.start, view), right_handed(runs.finish, view)
    noises = np.square([[robot.left_wheel_noise], [robot.right_wheel_noise]])
    [wheels] = wheel_covariance(prediction, runs, *noises)
    heading = start[:, 2]
    if wandering is not None and jumped is not None:
        error, total = errors_on_map(model, runs, prediction, wandering, jumped)
        reference = total - wheels
    elif by_position:
        usual = float(np.mean(noises))
        found = position_errors(
            prediction.relative,
            wheels,
            usual * (prediction.per_left + prediction.per_right),
            start[:, :2],
            finish[:, :2],
            np.square(sigma_xy) + float(quantisation_variance(robot)[0]),
            runs.legs,
            _headings(model, runs, start),
            runs.gap,
            jumped,
        )
        error, wheels, reference = found.error, found.wheels, found.reference
        heading = found.heading
    else:
        error = errors_between(start, finish, prediction)
        shares = stated_shares(runs, kind, view.mirrored)
        reference = _reference_part(
            robot, runs, prediction, (sigma_xy, sigma_yaw, sigma_stamp), kind, shares, start[:, 2]
        )
    turned_by = extrinsics_of(model, runs).yaw
    error, wheels, reference = _of_the_robot(turned_by, error, wheels, reference)
    return LegErrors(
        error,
        wheels + reference,
        kinds_of(prediction.along, prediction.turn, robot.track),
        prediction.length,
        wheels,
        prediction.along,
        prediction.turn,
        heading - turned_by,
    )


def _of_the_robot(
    yaw: float | Floats, error: Floats, wheels: Floats, reference: Floats
) -> tuple[Floats, Floats, Floats]:
    """Errors and covariances of legs in the axes of the robot, from those of the reference.

    `yaw`: angle of the reference's forward axis relative to the robot's, of all legs or each [rad].
    """
    if not np.any(yaw):
        return error, wheels, reference
    turn = np.empty((len(error), 3, 3))
    turn_into(turn, np.zeros(len(error)) + yaw)
    turned = error.copy()  # a heading that was not measured leaves the position as it is
    turned[:, :2] = (turn[:, :2, :2] @ error[:, :2, None])[..., 0]
    wheels, reference = (turn @ each @ turn.transpose(0, 2, 1) for each in (wheels, reference))
    return turned, wheels, reference


def _headings(model: Model, runs: Concatenated, start: Floats) -> Floats:
    """Heading at the first pose of each run, measured or else the model's, shape (runs,)."""
    measured = start[runs.legs[:-1], 2]
    given = [0.0 if yaw is None else yaw for yaw in model.start_yaws]
    return np.where(np.isfinite(measured), measured, given)


def kinds_of(along: Floats, turn: Floats, track: float) -> NDArray[np.str_]:
    """Motion type of each leg: line, arc or spin."""
    motion = zip(along.tolist(), turn.tolist(), strict=True)
    kinds: list[PieceKind] = [kind_of(BodyMotion(go, 0.0, by), track) for go, by in motion]
    return np.array(kinds, dtype=np.str_)


def _reference_part(
    robot: Robot,
    runs: Concatenated,
    prediction: Prediction,
    sigmas: tuple[float | Floats, float | Floats, float],
    kind: ReferenceKind,
    shares: Floats | None,
    heading: Floats,
) -> Floats:
    """Covariance of a leg's error from the reference and from encoder quantisation.

    The reference's part is that of its positions, headings and stamps; `shares` are as in
    `Concatenated.shares`, and `heading` is measured at the legs' starts, shape (m,).
    """
    counted = quantisation_of_legs(robot, prediction.relative, runs.unseen, runs.rounding)
    xy, yaw = (np.zeros(runs.count) + np.square(sigma) for sigma in sigmas[:2])
    begun = ended = np.zeros((runs.count, 3))
    if sigmas[2] > 0.0:  # speeds for an hour of steps are costly
        begun, ended = (sigmas[2] ** 2 * pace for pace in _paces(robot, runs))
    if kind == "incremental":
        walk = walked(prediction, runs.intervals, xy, yaw)
        return np.asarray(walk + counted + (begun + ended)[..., None] * np.eye(3))
    lever = lever_of(prediction.relative)
    own = np.stack([xy, xy, yaw], axis=-1)[:, :, None] * np.eye(3)
    both = np.stack([own, own])
    if shares is not None:  # a run's own sigma is in them
        unit = np.sqrt([xy.max(), xy.max(), yaw.max()])
        turn = np.empty((runs.count, 3, 3))
        turn_into(turn, heading)
        both = turn.transpose(0, 2, 1) @ (shares * np.outer(unit, unit)) @ turn
    first, last = (
        part + late[:, :, None] * np.eye(3) for part, late in zip(both, (begun, ended), strict=True)
    )
    of_map = map_walk(prediction, runs.map_growth, xy, yaw) if runs.own_axes else 0.0
    return np.asarray(last + lever @ first @ lever.transpose(0, 2, 1) + counted + of_map)


def _paces(robot: Robot, runs: Concatenated) -> tuple[Floats, Floats]:
    """Factors of a stamp's error at both ends of the legs (`paces`), (m, 3) each."""
    drive = runs.drive(robot)
    return (
        paces(drive.speed.start[runs.begin], drive.yaw_rate.start[runs.begin]),
        paces(drive.speed.end[runs.end - 1], drive.yaw_rate.end[runs.end - 1]),
    )


def squared_deviation(error: Floats, covariance: Floats) -> Floats:
    """Squared Mahalanobis distance of rows (m, 3), over the measured coordinates; shape (m,)."""
    known = np.isfinite(error)
    both = known[:, :, None] & known[:, None, :]
    shape = np.where(both, covariance, 0.0) + np.where(known, 0.0, 1.0)[:, :, None] * np.eye(3)
    left = np.where(known, error, 0.0)
    solved = np.linalg.solve(shape, left[..., None])[..., 0]
    return np.asarray(np.sum(left * solved, axis=-1))


def statistics(legs: LegErrors) -> LegStatistics:
    """Statistics over the given legs."""
    count = legs.error.shape[0]
    freedom = legs.freedom
    if not freedom.any():
        nothing = float("nan")
        return LegStatistics(count, nothing, nothing, nothing, nothing, nothing)
    deviation = legs.deviation
    measured = freedom > 0
    return LegStatistics(
        count,
        root_mean_square(legs.distance),
        float(np.median(known)) if (known := _finite(legs.distance)).size else float("nan"),
        root_mean_square(legs.error[:, 2]),
        float(deviation.sum() / freedom.sum()),
        float(np.mean((deviation <= CHI2_95[freedom])[measured])),
        int(freedom.sum()),
    )


def root_mean_square(values: Floats) -> float:
    """Root mean square of the finite values; NaN if there are none."""
    known = _finite(values)
    return float(np.sqrt(np.mean(known**2))) if known.size else float("nan")


def _finite(values: Floats) -> Floats:
    return values[np.isfinite(values)]


def joined(parts: list[LegErrors]) -> LegErrors:
    """Concatenate legs of several runs."""
    names = [item.name for item in fields(LegErrors)]
    return LegErrors(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))
