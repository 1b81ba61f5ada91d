# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Likelihood by innovations: what the reference measures less what the model predicts.

A Kalman filter carries the pose from one reference pose to the next, with the closed-form noise of
the leg between them. The innovations have a known covariance and are independent from leg to leg
(white under a true model), whatever the reference measures: full poses, positions only, headings
only, two poses per drive. So likelihood, fits and tests for all of these rest on one loop.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.run import ReferenceKind
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.correlated_filter import (
    GaussMarkovError,
    GyroHeading,
    filtered_with_correlated_error,
)
from werrimbi_odom.inference.fitting.filtering import STRETCH, FilterInput, Shocks, Ways, filtered
from werrimbi_odom.inference.fitting.leg_loop import UNMEASURED, diagonal_of
from werrimbi_odom.inference.fitting.prediction import Prediction, right_handed
from werrimbi_odom.inference.fitting.quantisation import quantisation, quantisation_of_legs
from werrimbi_odom.inference.fitting.reference_walk import map_walk, walked
from werrimbi_odom.inference.linear import inverse_root, square_and_volume
from werrimbi_odom.model.effect import view_of
from werrimbi_odom.model.pose import Floats, wrap_all
from werrimbi_odom.model.robot import Robot


@dataclass(frozen=True, slots=True)
class Variances:
    """Noise variances; arrays of shape (g,) for g sets evaluated at once.

    Those of the reference are per pose (absolute, local_map) or per interval (incremental).
    """

    left: Floats
    """k_L² [m]."""
    right: Floats
    """k_R² [m]."""
    xy: Floats
    """Variance of the reference's position, per coordinate [m²]."""
    yaw: Floats
    """Variance of the reference's heading [rad²]."""
    stamp: Floats
    """Variance of the stamps of a gyro, or of scans, relative to the ticks [s²]. At speed v and
    turn rate ω a stamp error of 1 s is a pose error of v and ω. A gyro is read in bursts and its
    messages are queued; where the noise of positions is estimated, it includes the stamp errors."""
    walk_xy: Floats
    """Random walk of a local_map's error per coordinate, variance per second [m²/s]."""
    walk_yaw: Floats
    """Random walk of its heading error, variance per second [rad²/s]."""
    reversion: Floats
    """Square of the rate at which that error reverts to zero [1/s²]."""

    def wandered(self) -> Floats:
        """Stationary variance of a local_map's error in x, y, yaw, (g, 3)."""
        walk = np.stack([self.walk_xy, self.walk_xy, self.walk_yaw], axis=-1)
        return np.asarray(walk / (2.0 * np.sqrt(self.reversion))[:, None])


@dataclass(frozen=True, slots=True)
class Innovations:
    """Measured minus predicted pose at the end of each leg.

    In the frame of the robot at the leg's start: (along, sideways, heading) [m, m, rad].
    """

    value: Floats
    """Shape (g, m, 3); zero where nothing was measured."""
    covariance: Floats
    """Shape (g, m, 3, 3)."""
    ways: Ways | None
    """Linear map from perturbations of the legs to the innovations, for the first set of variances;
    None where legs are independent."""
    known: NDArray[np.bool_]
    """Coordinates that were measured and count, shape (m, 3)."""
    prior: Floats | float = 0.0
    """Whitened deviations of nuisances from what is known of them; (m, 3), in slots of coordinates
    that were not measured."""
    _roots: list[Floats] = field(default_factory=list)

    def cost_of_legs(self) -> Floats:
        """Minus two log-likelihood of each leg, constants left out; (g, m), zero where unseen."""
        misfit, volume = square_and_volume(self.covariance, self.value)
        seen = np.where(self.known.any(axis=-1), misfit + volume, 0.0)
        return np.asarray(seen + np.sum(np.square(self.prior), axis=-1))

    def minus_two_log_likelihood(self) -> Floats:
        """Minus two log-likelihood of each set of variances without constants, shape (g,)."""
        return np.asarray(np.sum(self.cost_of_legs(), axis=-1))

    def whitened(self) -> Floats:
        """Whitened innovations (unit covariance), (m, 3); first set."""
        return np.asarray((self._root() @ self.value[0][..., None])[..., 0] + self.prior)

    def marks(self, slopes: Floats) -> Floats:
        """Jacobian of the whitened innovations from that of the relative poses; see `_change`."""
        return np.asarray(self._root() @ self._change(slopes))

    def shocks(self, white: Floats) -> Shocks:
        """Score and information of a shock to the states in a single leg, for every leg.

        `white` (m, 3): whitened innovations, with nuisances projected out.
        """
        back = self._root().swapaxes(-1, -2)
        weighed, precision = (back @ white[..., None])[..., 0], back @ self._root()
        if self.ways is not None:
            return self.ways.shocks(weighed, precision)
        nothing = np.zeros_like(precision)
        return Shocks(weighed, precision, nothing, nothing + np.eye(3))

    def shown(self, change: Floats) -> Floats:
        """Effect of state perturbations (m, s, p) on the whitened innovations, (m, 3, p)."""
        return np.asarray(
            self._root() @ (change if self.ways is None else -self.ways.of_states(change))
        )

    def _change(self, slopes: Floats) -> Floats:
        """Jacobian of the innovations (m, 3, p + 1) from that of the relative poses (m, 3, p).

        The last column is for the heading at the run's first reference pose; it is zero if
        measured.
        """
        if self.ways is not None:
            return self.ways.innovations(slopes)
        return np.concatenate([-slopes, np.zeros((*slopes.shape[:2], 1))], axis=-1)

    def _root(self) -> Floats:
        if not self._roots:
            self._roots.append(inverse_root(self.covariance[0]) * self.known[..., None])
        return self._roots[0]


def innovations(
    robot: Robot,
    runs: Concatenated,
    prediction: Prediction,
    variances: Variances,
    kind: ReferenceKind,
    *,
    excluded: NDArray[np.bool_] | None = None,
    start_yaws: Sequence[float | None] | None = None,
    heading: float = 0.0,
    stretch: int = STRETCH,
) -> Innovations:
    """Filter all runs and return their innovations.

    `robot`: the robot, with its effects. `runs`: measured poses of m legs. `prediction`: predicted
    legs. `variances`: sets of noise variances. `kind`: error model of the reference. `excluded`
    (m,): legs on which the reference jumped. Like gaps they do not count, and the pose restarts
    after them; of gaps, those in which a local_map jumped. `start_yaws`: heading at the first
    reference pose of each run, where not measured [rad]. `heading`: variance of these where they
    were not fitted, for a local_map [rad²]. `stretch`: least number of legs after which the filter
    may restart.
    """
    count = runs.count
    skip = runs.gap if excluded is None else runs.gap | excluded
    view = view_of(robot.effects)
    start, finish = right_handed(runs.start, view), right_handed(runs.finish, view)
    gyro = runs.headings_alone
    if kind == "incremental" and not gyro:
        return _of_increments(robot, runs, (start, finish), prediction, variances, skip)
    begins = np.zeros(count, dtype=np.bool_)
    begins[runs.legs[:-1]] = True
    begun = np.full(count, np.nan)
    for index, given in enumerate(start_yaws or []):
        if given is not None:
            begun[runs.legs[index]] = given
    start = np.where(np.isfinite(begun)[:, None] & [False, False, True], np.nan, start)
    noise = wheel_covariance(prediction, runs, variances.left, variances.right)
    reading = _reading(robot, variances, runs, prediction, finish, kind, view.mirrored)
    if kind == "incremental":
        noise[..., 2, 2] += variances.yaw[:, None] * runs.intervals
    if kind == "absolute" and runs.own_axes:
        growth = runs.cache.known("map_growth", lambda: runs.map_growth)
        noise += map_walk(prediction, growth, variances.xy[:, None], variances.yaw[:, None])
    legs = FilterInput(
        prediction.relative, noise, start, finish, reading, begins, skip, begun, stretch
    )
    if kind == "local_map":
        kept = np.exp(-np.sqrt(variances.reversion)[:, None] * runs.duration)
        laid = None
        if runs.has_gyro_headings:
            walk, by_course = variances.walk_yaw, runs.has_course_headings
            laid = GyroHeading(prediction.turn, runs.duration, walk, by_course)
        lost = runs.lost if excluded is None else runs.lost | (runs.gap & excluded)
        wander = GaussMarkovError(variances.wandered(), kept, runs.gap, lost, heading, laid)
        found = filtered_with_correlated_error(legs, wander)
    else:
        found = filtered(legs)
    known = np.isfinite(finish) & ~skip[:, None]
    return Innovations(found.value, found.covariance, found.ways, known)


def _of_increments(
    robot: Robot,
    runs: Concatenated,
    measured: tuple[Floats, Floats],
    prediction: Prediction,
    variances: Variances,
    skip: NDArray[np.bool_],
) -> Innovations:
    """Innovations for an incremental reference: noise of intervals, so of legs, is independent."""
    value = errors_between(*measured, prediction)
    known = np.isfinite(value) & ~skip[:, None]
    covariance = (
        wheel_covariance(prediction, runs, variances.left, variances.right)
        + walked(prediction, runs.intervals, variances.xy[:, None], variances.yaw[:, None])
        + quantisation_of_legs(robot, prediction.relative, runs.unseen)
    )
    covariance = covariance + UNMEASURED * diagonal_of(~np.isfinite(value))
    value = np.where(known, value, 0.0)
    sets = variances.left.size
    return Innovations(np.broadcast_to(value, (sets, *value.shape)), covariance, None, known)


def errors_between(start: Floats, finish: Floats, prediction: Prediction) -> Floats:
    """Measured minus predicted relative pose of each leg, shape (m, 3); NaN where not measured.

    In the frame of the robot at the leg's start. `start`, `finish` (m, 3): measured poses at both
    ends, right-handed.
    """
    step = finish - start
    cos, sin = np.cos(start[:, 2]), np.sin(start[:, 2])
    relative = np.stack(
        [cos * step[:, 0] + sin * step[:, 1], cos * step[:, 1] - sin * step[:, 0], step[:, 2]],
        axis=-1,
    )
    error = relative - prediction.relative
    error[:, 2] = wrap_all(error[:, 2])
    return np.asarray(error)


def paces(speed: Floats, turn_rate: Floats) -> Floats:
    """Variances of a pose for stamp errors of 1 s, from speeds (m,); (m, 3).

    The error is along the path. Its direction in the reference's axes changes as the robot drives,
    so each coordinate gets half of the variance.
    """
    place = 0.5 * np.square(speed)
    return np.stack([place, place, np.square(turn_rate)], axis=-1)


def _reading(
    robot: Robot,
    variances: Variances,
    runs: Concatenated,
    prediction: Prediction,
    finish: Floats,
    kind: ReferenceKind,
    mirrored: bool,
) -> Floats:
    """Covariance of the poses measured at the legs' ends (m, 3), with that of the counts' steps.

    Shape (g, m, 3, 3).
    """
    shares = stated_shares(runs, kind, mirrored)
    heading = np.zeros_like(variances.yaw) if kind == "incremental" else variances.yaw
    unit = np.sqrt(np.stack([variances.xy, variances.xy, heading], axis=-1))[:, None, :]
    reading = unit[..., :, None] * unit[..., None, :] * (np.eye(3) if shares is None else shares[1])
    if runs.has_stamp_noise:
        pace = paces(prediction.along / runs.duration, prediction.turn / runs.duration)
        late = variances.stamp[:, None, None] * pace
        reading = reading + late[..., None] * np.eye(3)
    heading = finish[:, 2] - view_of(robot.effects).yaw
    return np.asarray(reading + quantisation(robot, heading, runs.unseen[1]))


def stated_shares(runs: Concatenated, kind: ReferenceKind, mirrored: bool) -> Floats | None:
    """`Concatenated.shares` in a right-handed frame, if it is poses whose noise is stated."""
    shares = runs.cache.known("shares", lambda: runs.shares) if kind == "absolute" else None
    if shares is None or not mirrored:
        return shares
    flip = np.array([1.0, -1.0, -1.0])
    return np.asarray(shares * np.outer(flip, flip))


def wheel_covariance(
    prediction: Prediction, runs: Concatenated, left: Floats, right: Floats
) -> Floats:
    """Covariance of the legs by the wheel noise k_L² and k_R² (g,) [m]; (g, m, 3, 3).

    A leg with an abrupt event may end anywhere.
    """
    noise = np.asarray(
        left[:, None, None, None] * prediction.per_left
        + right[:, None, None, None] * prediction.per_right
    )
    noise[:, runs.stepped] += rules.EVENT_STEP * np.eye(3)
    return noise
