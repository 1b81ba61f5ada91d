# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Exact moments of the pose error, for errors so large that first order no longer holds.

With w = e^{iθ}, z = x + iy and Gaussian heading error φ, the white noise of the wheels makes the
first and second moments of the pose obey a linear system with constant coefficients along a piece
(docs/model.md, "Large errors"). `piece_moments` is its closed-form solution. `chained` composes
pieces exactly: the total error is e = e₀ + w₀ (ω ε + η ζ), where e₀ and ω = e^{iφ₀} belong to the
earlier pieces, ε to this one, ζ is its nominal displacement, and η = ω - 1. Carrying η instead of ω
avoids cancellation for small errors.

All functions take scalars or arrays of one shape.
"""

from __future__ import annotations

import cmath
import math
from typing import Any, NamedTuple

import numpy as np

from werrimbi_odom.model.covariance import PathNoise, PoseCovariance
from werrimbi_odom.model.motion import BodyMotion

Complex = Any  # complex, or ndarray of complex; numpy's own types differ only at run time
Real = Any  # float, or ndarray of float

_SEAM = 1.0  # |x| below which the φ-functions are evaluated by their series
_TERMS = 20


class PieceMoments(NamedTuple):
    """Moments of the error ε = ζ - nominal ζ of one piece, given its start heading.

    In the frame of the robot at the start of the piece. φ is the heading error added by the piece,
    and η = e^{iφ} - 1.
    """

    nominal: Complex
    """Displacement without noise [m]."""
    error: Complex
    """E[ε]: the mean displacement is shorter than the nominal one [m]."""
    absolute: Real
    """E|ε|² [m²]."""
    square: Complex
    """E[ε²] [m²]."""
    with_heading: Complex
    """E[ε φ] [m·rad]."""
    with_spin: Complex
    """E[ε η] [m]."""
    conjugate_with_spin: Complex
    """E[ε̄ η] [m]."""
    heading_variance: Real
    """Var φ [rad²]."""


class PathMoments(NamedTuple):
    """Moments of the error e = true - nominal position (x + iy) of a path, odometry frame.

    φ is the heading error at the end of the path, Gaussian and of zero mean; η = e^{iφ} - 1.
    """

    error: Complex = 0j
    """E[e]: offset of the mean of the true position from the nominal one [m]."""
    absolute: Real = 0.0
    """E|e|² [m²]."""
    square: Complex = 0j
    """E[e²] [m²]."""
    with_heading: Complex = 0j
    """E[e φ] [m·rad]."""
    with_spin: Complex = 0j
    """E[e η] [m]."""
    conjugate_with_spin: Complex = 0j
    """E[ē η] [m]."""
    heading_variance: Real = 0.0
    """Var φ [rad²]."""

    def about_pose(self) -> PoseCovariance[Any]:
        """Second moments of the error about the nominal pose.

        This is the covariance for a filter that uses the nominal pose; it contains the square of
        the mean shift.
        """
        return PoseCovariance(
            0.5 * (self.absolute + _real(self.square)),
            0.5 * _imag(self.square),
            _real(self.with_heading),
            0.5 * (self.absolute - _real(self.square)),
            _imag(self.with_heading),
            self.heading_variance,
        )


def from_covariance(covariance: PoseCovariance[float]) -> PathMoments:
    """Moments of a start pose with Gaussian errors of this covariance, odometry frame."""
    with_heading = complex(covariance.xyaw, covariance.yyaw)
    variance = covariance.yawyaw
    swing = 1j * with_heading * math.exp(-0.5 * variance)  # Stein: E[e e^{iφ}] = i E[e φ] E[e^{iφ}]
    return PathMoments(
        0j,
        covariance.xx + covariance.yy,
        complex(covariance.xx - covariance.yy, 2.0 * covariance.xy),
        with_heading,
        swing,
        1j * with_heading.conjugate() * math.exp(-0.5 * variance),
        variance,
    )


def piece_moments(motion: BodyMotion[Any], noise: PathNoise[Any]) -> PieceMoments:
    """Exact moments added by one piece of constant twist."""
    a, b, c = noise
    travel = motion.along + 1j * motion.sideways
    rate = 1j * motion.turn - 0.5 * b  # of E[w]
    rate2 = 2j * motion.turn - 2.0 * b  # of E[w²]
    drift = travel + 0.5j * c
    one, two = _phi1(rate), _phi2(rate)
    back = _exp(-1j * motion.turn)
    facing = _exp(rate)
    conjugate_source = _conj(travel) + 0.5j * c
    direct_source = travel + 1.5j * c
    mean = drift * one
    nominal = travel * _phi1(1j * motion.turn)
    error = mean - nominal
    absolute = a + 2.0 * _real(drift * conjugate_source * two)
    square = 2.0 * drift * direct_source * _divided(rate, rate2) + a * _phi1(rate2)
    with_facing = direct_source * facing * _phi1(rate2 - rate)  # E[z w]
    conjugate_with_facing = conjugate_source * one  # E[z̄ w]
    return PieceMoments(
        nominal,
        error,
        absolute - 2.0 * _real(_conj(nominal) * mean) + abs(nominal) ** 2,
        square - 2.0 * nominal * mean + nominal * nominal,
        c * one + 1j * b * drift * (one - two),
        back * (with_facing - nominal * facing) - error,
        back * (conjugate_with_facing - _conj(nominal) * facing) - _conj(error),
        b,
    )


def chained(path: PathMoments, piece: PieceMoments, yaw: Real) -> PathMoments:
    """Moments at the end of a piece that follows a path with nominal end heading `yaw`."""
    variance, zeta = path.heading_variance, piece.nominal
    d1, d2 = _expm1(-0.5 * variance), _expm1(-2.0 * variance)  # E[ω] - 1 and E[ω²] - 1
    added_spin = _expm1(-0.5 * piece.heading_variance)  # E[η] of the piece
    facing = _exp(1j * yaw)
    with_facing = path.error + path.with_spin  # E[e₀ ω]
    conjugate_with_facing = _conj(path.error) + path.conjugate_with_spin  # E[ē₀ ω]
    # q = ω ε + η ζ is the contribution of the piece, in the nominal frame of its start.
    q = (1.0 + d1) * piece.error + d1 * zeta
    q_absolute = (
        piece.absolute - 2.0 * d1 * abs(zeta) ** 2 - 2.0 * d1 * _real(piece.error * _conj(zeta))
    )
    q_square = (
        (1.0 + d2) * piece.square
        + (d2 - 2.0 * d1) * zeta * zeta
        + 2.0 * (d2 - d1) * piece.error * zeta
    )
    e_q = with_facing * piece.error + path.with_spin * zeta
    conjugate_e_q = conjugate_with_facing * piece.error + path.conjugate_with_spin * zeta
    q_heading = (1.0 + d1) * (1j * variance * (piece.error + zeta) + piece.with_heading)
    q_spin = (
        (1.0 + d2) * piece.with_spin
        + (d2 - d1) * (zeta * added_spin + piece.error)
        + (d2 - 2.0 * d1) * zeta
    )
    conjugate_q_spin = (
        piece.conjugate_with_spin
        - d1 * (_conj(zeta) * added_spin + _conj(piece.error))
        - 2.0 * d1 * _conj(zeta)
    )
    return PathMoments(
        path.error + facing * q,
        path.absolute + q_absolute + 2.0 * _real(facing * conjugate_e_q),
        path.square + facing * facing * q_square + 2.0 * facing * e_q,
        path.with_heading + facing * q_heading,
        with_facing * added_spin + path.with_spin + facing * q_spin,
        conjugate_with_facing * added_spin
        + path.conjugate_with_spin
        + _conj(facing) * conjugate_q_spin,
        variance + piece.heading_variance,
    )


def _phi1(x: Complex) -> Complex:
    """(e^x - 1) / x, and 1 at zero."""
    return _by_size(x, lambda x: _series(x, 1), lambda x: (_exp(x) - 1.0) / x)


def _phi2(x: Complex) -> Complex:
    """(e^x - 1 - x) / x², and 1/2 at zero."""
    return _by_size(x, lambda x: _series(x, 2), lambda x: (_exp(x) - 1.0 - x) / (x * x))


def _divided(x: Complex, y: Complex) -> Complex:
    """Divided difference of the exponential at 0, x and y; 1/2 where all coincide."""
    if isinstance(x, np.ndarray):
        result = np.empty(x.shape, dtype=np.complex128)
        small = (np.abs(x) < _SEAM) & (np.abs(y) < _SEAM)
        result[small] = _divided_series(x[small], y[small])
        far = ~small
        result[far] = (_phi1(y[far]) - _phi1(x[far])) / (y[far] - x[far])
        return result
    if abs(x) < _SEAM and abs(y) < _SEAM:
        return _divided_series(x, y)
    return (_phi1(y) - _phi1(x)) / (y - x)


def _divided_series(x: Complex, y: Complex) -> Complex:
    homogeneous: Complex = 1.0 + 0.0 * x
    power: Complex = 1.0 + 0.0 * y
    total = 0.5 * homogeneous
    for order in range(1, _TERMS + 4):
        power = power * y
        homogeneous = homogeneous * x + power
        total = total + homogeneous / math.factorial(order + 2)
    return total


def _series(x: Complex, shift: int) -> Complex:
    total: Complex = 0.0 * x
    for order in range(_TERMS, -1, -1):
        total = total * x + 1.0 / math.factorial(order + shift)
    return total


def _by_size(x: Complex, near: Any, far: Any) -> Complex:
    if not isinstance(x, np.ndarray):
        return near(x) if abs(x) < _SEAM else far(x)
    small = np.abs(x) < _SEAM
    result = np.empty(x.shape, dtype=np.complex128)
    result[small] = near(x[small])
    result[~small] = far(x[~small])
    return result


def _exp(x: Complex) -> Complex:
    return np.exp(x) if isinstance(x, np.ndarray) else cmath.exp(x)


def _expm1(x: Real) -> Real:
    return np.expm1(x) if isinstance(x, np.ndarray) else math.expm1(x)


def _real(x: Complex) -> Real:
    return x.real


def _imag(x: Complex) -> Real:
    return x.imag


def _conj(x: Complex) -> Complex:
    return x.conjugate()
