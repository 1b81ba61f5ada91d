# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The closed-form covariance of one piece of constant curvature (paper, equation 17).

The paper's form divides differences of sines by Δ and loses all digits on straight lines. Here the
same terms are products of four entire functions of h = Δ/2, three of which are evaluated by a
series near zero. One formula therefore covers line, arc, spin and pivot.

With S = sin h / h, T = (1 - sinc 2h) / h², U = (1 + cos(2h)/2 - 3/2 sinc 2h) / h⁴ and V = (S - cos
h) / h², the paper's integrals in the chord's frame are, per travel D (E belongs to the noise b, F
to c; see docs/model.md):
E_x = -h V / 2, E_y = S / 2, E_xx = h² U / 4, E_yy = (S² + T/2) / 4, E_xy = -h S V / 4,
F_xx = F_yy = -h T / 4, F_xy = S² / 2.

All functions take floats or arrays of one shape.
"""

from __future__ import annotations

import math
from typing import Generic, NamedTuple, TypeVar

import numpy as np

from werrimbi_odom.model.motion import BodyMotion, Chord, Number, chord_of, cos_sin
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot, WheelNoise

Entry = TypeVar("Entry")  # a Number: mypy takes no methods on a tuple of a restricted type


class PoseCovariance(NamedTuple, Generic[Entry]):
    """Covariance of the errors (δx, δy, δyaw) of a pose, in the frame in which it is given.

    For a draw e ~ N(0, P) the true pose is (x + e_x, y + e_y, yaw + e_yaw). Units are m², m·rad and
    rad²; the order is that of the columns of `odom.csv`.
    """

    xx: Entry
    xy: Entry
    xyaw: Entry
    yy: Entry
    yyaw: Entry
    yawyaw: Entry

    def matrix(self) -> Floats:
        """Return the matrix, shape (..., 3, 3)."""
        rows = [
            [self.xx, self.xy, self.xyaw],
            [self.xy, self.yy, self.yyaw],
            [self.xyaw, self.yyaw, self.yawyaw],
        ]
        return np.moveaxis(np.array(rows, dtype=np.float64), (0, 1), (-2, -1))


CERTAIN: PoseCovariance[float] = PoseCovariance(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
"""Covariance of an exactly known pose."""


def sigmas_along_and_across(covariance: PoseCovariance[float], yaw: float) -> tuple[float, float]:
    """Standard deviations of the position along a heading and across it [m]."""
    cos, sin = math.cos(yaw), math.sin(yaw)
    xx, xy, yy = covariance.xx, covariance.xy, covariance.yy
    along = cos * cos * xx + 2.0 * cos * sin * xy + sin * sin * yy
    across = sin * sin * xx - 2.0 * cos * sin * xy + cos * cos * yy
    return math.sqrt(max(along, 0.0)), math.sqrt(max(across, 0.0))


class PathNoise(NamedTuple, Generic[Number]):
    """Noise of the body on a piece: variances a [m²] along, b [rad²] yaw, covariance c [m·rad]."""

    a: Number
    b: Number
    c: Number


def path_noise(robot: Robot, left: Number, right: Number) -> PathNoise[Number]:
    """Noise of the body after wheel travels [m] without reversal (equation 4)."""
    return path_noise_of(robot.wheel_noise, left, right)


def path_noise_of(wheels: WheelNoise, left: Number, right: Number) -> PathNoise[Number]:
    """`path_noise`, given the wheels' noise parameters."""
    return noise_of_wheel_variances(
        wheels.left * abs(left), wheels.right * abs(right), wheels.track
    )


def noise_of_wheel_variances(left: Number, right: Number, track: float) -> PathNoise[Number]:
    """Noise of the body, given the variances of both wheels' travel [m²]."""
    both = left + right
    return PathNoise(0.25 * both, both / (track * track), 0.5 * (right - left) / track)


class TwistCovariance(NamedTuple):
    """Covariance of (forward speed, yaw rate) over the last interval."""

    speed: float
    """(m/s)²"""
    cross: float
    """m·rad/s²"""
    yaw_rate: float
    """(rad/s)²"""


def twist_noise(
    wheels: WheelNoise,
    left_tick: float,
    right_tick: float,
    duration: float,
    left: float,
    right: float,
    left_lost: float,
    right_lost: float,
) -> TwistCovariance:
    """Covariance of the mean twist of a step.

    The error of a counter reading is uniform over one count, so the difference of two readings has
    a variance of 1/6 count², in addition to the wheel's noise (equation 4). `left_tick`,
    `right_tick`: travel per count [m]. `duration`, `left`, `right`: duration of the step [s], and
    travel of the wheels [m]. `left_lost`, `right_lost`: variance of travel that no counter saw
    [m²].
    """
    left = wheels.left * abs(left) + left_tick * left_tick / 6.0
    right = wheels.right * abs(right) + right_tick * right_tick / 6.0
    a, b, c = noise_of_wheel_variances(left + left_lost, right + right_lost, wheels.track)
    scale = 1.0 / (duration * duration)
    return TwistCovariance(a * scale, c * scale, b * scale)


def piece_covariance(
    motion: BodyMotion[Number], noise: PathNoise[Number], yaw: Number
) -> PoseCovariance[Number]:
    """Covariance that one piece adds to the pose at its end (paper, equation 17).

    `motion`: the whole piece as one constant twist. The paper has no `sideways`; lateral creep only
    rotates the lever arm of the heading noise, by the creep angle. `noise`: noise of the whole
    piece, distributed evenly along it. `yaw`: heading at the start of the piece [rad]. Result: in
    the frame in which `yaw` is measured.
    """
    return covariance_over(motion, noise, chord_of(motion.turn, yaw))


def covariance_over(
    motion: BodyMotion[Number], noise: PathNoise[Number], chord: Chord[Number]
) -> PoseCovariance[Number]:
    """`piece_covariance`, given the piece's chord."""
    return covariance_of_bend(motion, noise, chord, entire(0.5 * motion.turn, chord.shrink))


def covariance_of_bend(
    motion: BodyMotion[Number],
    noise: PathNoise[Number],
    chord: Chord[Number],
    bent: tuple[Number, Number, Number],
) -> PoseCovariance[Number]:
    """`covariance_over`, given T, U and V: the same for all noises of a piece."""
    along, sideways, turn = motion
    a, b, c = noise
    S, cos, sin = chord
    h = 0.5 * turn
    T, U, V = bent
    # Covariance in the chord frame: x along the heading at the middle of the piece.
    m_x, m_y = -0.5 * h * V, 0.5 * S  # mean lever arm of the heading noise, per travel
    m_xx, m_yy, m_xy = 0.25 * h * h * U, 0.25 * (S * S + 0.5 * T), -0.25 * h * S * V
    spread = 0.5 * a * h * h * T
    bend = 0.5 * c * along * h * T
    along2, sideways2, cross = along * along, sideways * sideways, along * sideways
    p_xx = (
        a
        - spread
        - bend
        - c * sideways * S * S
        + b * (along2 * m_xx + sideways2 * m_yy - 2.0 * cross * m_xy)
    )
    p_yy = spread - bend + b * (along2 * m_yy + sideways2 * m_xx + 2.0 * cross * m_xy)
    p_xy = 0.5 * c * along * S * S + b * (cross * (m_xx - m_yy) + (along2 - sideways2) * m_xy)
    p_xyaw = c * S + b * (along * m_x - sideways * m_y)
    p_yyaw = b * (along * m_y + sideways * m_x)
    return _turned(PoseCovariance(p_xx, p_xy, p_xyaw, p_yy, p_yyaw, b), cos, sin)


def carried(covariance: PoseCovariance[Number], dx: Number, dy: Number) -> PoseCovariance[Number]:
    """J P Jᵀ: propagate a pose covariance through a displacement (dx, dy) [m].

    The heading error rotates the displacement (paper, equation 16). `dx` and `dy` are in the frame
    of the covariance.
    """
    xx, xy, xyaw, yy, yyaw, yawyaw = covariance
    return PoseCovariance(
        xx - 2.0 * dy * xyaw + dy * dy * yawyaw,
        xy + dx * xyaw - dy * yyaw - dx * dy * yawyaw,
        xyaw - dy * yawyaw,
        yy + 2.0 * dx * yyaw + dx * dx * yawyaw,
        yyaw + dx * yawyaw,
        yawyaw,
    )


def plus(one: PoseCovariance[Number], other: PoseCovariance[Number]) -> PoseCovariance[Number]:
    """Covariance of the sum of two independent errors in one frame."""
    xx, xy, xyaw, yy, yyaw, yawyaw = one
    more_xx, more_xy, more_xyaw, more_yy, more_yyaw, more_yawyaw = other
    return PoseCovariance(
        xx + more_xx,
        xy + more_xy,
        xyaw + more_xyaw,
        yy + more_yy,
        yyaw + more_yyaw,
        yawyaw + more_yawyaw,
    )


def after_stretch(
    start: PoseCovariance[Number],
    motion: BodyMotion[Number],
    noise: PathNoise[Number],
    chord: Chord[Number],
    dx: Number,
    dy: Number,
) -> PoseCovariance[Number]:
    """Covariance of the pose at the end of a piece, in the frame of the one at its start.

    `motion`, `noise`, `chord`: of the piece; `chord` as from `chord_of`. `dx`, `dy`: displacement,
    integrated message by message [m].
    """
    return plus(carried(start, dx, dy), covariance_over(motion, noise, chord))


def _turned(covariance: PoseCovariance[Number], cos: Number, sin: Number) -> PoseCovariance[Number]:
    """Rotate a covariance into the frame in which the rotation (cos, sin) is given."""
    xx, xy, xyaw, yy, yyaw, yawyaw = covariance
    cos2, sin2, both = cos * cos, sin * sin, cos * sin
    across = 2.0 * both * xy
    return PoseCovariance(
        cos2 * xx - across + sin2 * yy,
        both * (xx - yy) + (cos2 - sin2) * xy,
        cos * xyaw - sin * yyaw,
        sin2 * xx + across + cos2 * yy,
        sin * xyaw + cos * yyaw,
        yawyaw,
    )


# The series is used below |h| = 1, the closed form beyond. At the seam both are accurate to a few
# units in the last place (test/model/test_covariance_exact.py).
_SEAM = 1.0
_TERMS = 14
_T = tuple((-1) ** (n + 1) * 4.0**n / math.factorial(2 * n + 1) for n in range(_TERMS - 1, 0, -1))
_U = tuple(
    (-1) ** n * 4.0**n * (n - 1) / math.factorial(2 * n + 1) for n in range(_TERMS - 1, 1, -1)
)
_V = tuple((-1) ** (n + 1) * 2.0 * n / math.factorial(2 * n + 1) for n in range(_TERMS - 3, 0, -1))


def entire(h: Number, S: Number) -> tuple[Number, Number, Number]:
    """T, U and V of the module's docstring, given S."""
    if isinstance(h, np.ndarray):
        return _entire_of_array(h, S)
    return entire_of_float(h, S)


def entire_of_float(h: float, S: float) -> tuple[float, float, float]:
    """`entire` for a single number."""
    if abs(h) > _SEAM:
        return _closed(h, S)
    t = h * h
    return _polynomial(_T, t), _polynomial(_U, t), _polynomial(_V, t)


def _entire_of_array(h: Floats, S: Floats) -> tuple[Floats, Floats, Floats]:
    small = np.abs(h) <= _SEAM
    if small.all():
        t = h * h
        return _polynomial(_T, t), _polynomial(_U, t), _polynomial(_V, t)
    if not small.any():
        return _closed(h, S)
    T, U, V = (np.empty_like(h) for _ in range(3))
    for side in (np.nonzero(small), np.nonzero(~small)):
        T[side], U[side], V[side] = _entire_of_array(h[side], S[side])
    return T, U, V


def _closed(h: Number, S: Number) -> tuple[Number, Number, Number]:
    t = h * h
    cos, sin = cos_sin(h)
    S2 = S * cos  # sinc 2h
    cos2 = 1.0 - 2.0 * sin * sin
    return (1.0 - S2) / t, (1.0 + 0.5 * cos2 - 1.5 * S2) / (t * t), (S - cos) / t


def _polynomial(coefficients: tuple[float, ...], t: Number) -> Number:
    """Evaluate a polynomial; the coefficient of the highest power comes first."""
    total = 0.0 * t
    for coefficient in coefficients:
        total *= t  # in place for arrays
        total += coefficient
    return total
