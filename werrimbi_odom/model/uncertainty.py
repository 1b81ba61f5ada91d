# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Errors of a pose, to first order (the paper) or by exact moments, piece by piece.

Both orders use the same pieces; they differ only in what is propagated. All functions take floats
or arrays of one shape.
"""

from __future__ import annotations

from typing import Generic, NamedTuple

from werrimbi_odom.model.covariance import CERTAIN, PathNoise, PoseCovariance, after_stretch
from werrimbi_odom.model.exact_moments import PathMoments, chained, from_covariance, piece_moments
from werrimbi_odom.model.motion import BodyMotion, Number, chord_of, displacement
from werrimbi_odom.model.robot import CovarianceOrder


class Uncertainty(NamedTuple, Generic[Number]):
    """Errors of a pose in the odometry frame."""

    covariance: PoseCovariance[Number]
    """Second moments of the error about the nominal pose: to first order, or exact."""
    moments: PathMoments | None = None
    """Exact moments, if they are propagated."""

    @property
    def mean_shift(self) -> tuple[Number, Number] | None:
        """Mean of the true position minus the nominal pose [m]; None without exact moments.

        It is informative only: poses stay nominal, and `covariance` contains its square.
        """
        if self.moments is None:
            return None
        return self.moments.error.real, self.moments.error.imag


def known(
    order: CovarianceOrder, covariance: PoseCovariance[float] = CERTAIN
) -> Uncertainty[float]:
    """Errors of a pose with this covariance, Gaussian."""
    return Uncertainty(covariance, from_covariance(covariance) if order == "exact" else None)


def after_piece(
    start: Uncertainty[Number],
    motion: BodyMotion[Number],
    noise: PathNoise[Number],
    yaw: Number,
    dx: Number,
    dy: Number,
) -> Uncertainty[Number]:
    """Errors at the end of a piece.

    `start`: errors at the start. `motion`, `noise`: of the whole piece. `yaw`: nominal heading at
    its start [rad]. `dx`, `dy`: displacement, integrated message by message, odometry frame [m].
    """
    if start.moments is not None:
        # The lever arm of the earlier heading error is the driven displacement, not that of the
        # arc.
        driven = displacement(BodyMotion(dx, dy, 0.0 * dx), -yaw)
        piece = piece_moments(motion, noise)._replace(nominal=driven[0] + 1j * driven[1])
        moments = chained(start.moments, piece, yaw)
        return Uncertainty(moments.about_pose(), moments)
    return Uncertainty(
        after_stretch(start.covariance, motion, noise, chord_of(motion.turn, yaw), dx, dy)
    )


def with_lost_travel(
    errors: Uncertainty[float], unseen: PathNoise[float], yaw: float
) -> Uncertainty[float]:
    """Errors of a pose with heading `yaw`, plus those of travel that no counter saw."""
    return after_piece(errors, BodyMotion(0.0, 0.0, 0.0), unseen, yaw, 0.0, 0.0)
