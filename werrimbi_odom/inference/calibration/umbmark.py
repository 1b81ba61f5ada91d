# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Wheel base and radii from squares driven in both senses (UMBmark; paper, section 3).

An offset is where a square ended, measured minus odometry, in the frame whose x axis is the first
leg. Two errors of the robot file cause it:

- a wrong base: every corner of 90 degrees by odometry falls short by α;
- unequal wheels: every leg that is straight by odometry bends to the left by β.

To first order a clockwise square of side D ends at -2 D (α + β) in x and the same in y, an
anticlockwise one at -2 D (α - β) in x and minus that in y. So one sense cannot tell α from β; both
can (equations 6 and 7), and each of them twice: from x and from y.

The paper's equations are of first order. `umbmark` starts from them and refines the factors by
least squares, until the recorded wheel travel ends where it was measured. A common factor on base
and both radii changes no closed square, so it is not identifiable; the mean radius stays.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from scipy import optimize

from werrimbi_odom.errors import InputError
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.calibration.squares import Squares, covariance_of_mean, e_max_syst
from werrimbi_odom.inference.calibration.umbmark_equations import (
    QUARTER,
    Angles,
    Factors,
    angles_of,
    check_size,
    first_order_angles,
    paper_factors,
)
from werrimbi_odom.inference.calibration_parametrisation import effective_track
from werrimbi_odom.inference.distributions import NORMAL_95, fisher_survival, student_quantile
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot


@dataclass(frozen=True, slots=True)
class ValueAndStd:
    """A value with its standard deviation.

    The standard deviation is widened by Student's t for the few runs, so that value ± 1.96 std
    covers the truth in 95 % of calibrations (by 18 % for five runs a sense).
    """

    value: float
    std: float

    def times(self, factor: float) -> ValueAndStd:
        """Scale the estimate."""
        return ValueAndStd(self.value * factor, self.std * abs(factor))


@dataclass(frozen=True, slots=True)
class Umbmark:
    """Result of UMBmark; angles in rad, lengths in m."""

    e_max: float
    """E_max,syst (equation 12)."""
    angles: Angles
    paper: Factors
    """First-order factors by the paper's equations 6 to 11."""
    alpha: ValueAndStd
    beta: ValueAndStd
    ratio: ValueAndStd
    base: ValueAndStd
    left: ValueAndStd
    right: ValueAndStd
    """α, β, E_d, C_B, C_L, C_R without approximations: the ones to use."""
    disagreement: tuple[float, float]
    """Remaining difference between α and β from x and from y, with the best factors [rad]."""
    disagreement_p: float
    """p-value of this difference; NaN where the runs have no dispersion."""

    @property
    def factors(self) -> Factors:
        """The corrections to use."""
        return Factors(self.base.value, self.ratio.value)

    def multipliers(self, old: Robot) -> dict[str, ValueAndStd]:
        """New multipliers for a robot file whose robot is `old`."""
        return {
            "wheel_separation_multiplier": self.base.times(old.wheel_separation_multiplier),
            "left_wheel_radius_multiplier": self.left.times(old.left_wheel_radius_multiplier),
            "right_wheel_radius_multiplier": self.right.times(old.right_wheel_radius_multiplier),
        }


def umbmark(squares: Squares, robot: Robot) -> Umbmark:
    """Corrections of base and radii from squares of both senses, with standard deviations.

    `robot`: the robot that the odometry of these squares assumed; its base is that by its effects
    (`skid_steer`), which the squares turned on. InputError if base and radii cannot cause these
    offsets.
    """
    angles, track = first_order_angles(squares), effective_track(robot)
    paper = paper_factors(angles, squares.side, track)
    measured = np.concatenate([squares.cw.mean(axis=0), squares.ccw.mean(axis=0)])
    solution = optimize.least_squares(
        lambda unknown: _offsets(squares, track, *unknown) - measured,
        [paper.base - 1.0, 0.5 * (paper.right - paper.left)],
        x_scale=0.01,
        xtol=1e-12,
    )
    off, imbalance = (float(value) for value in solution.x)
    base, ratio = 1.0 + off, (1.0 + imbalance) / (1.0 - imbalance)
    check_size(base, ratio)
    across = _Across(squares, solution.jac, -solution.fun)
    across.check(measured)
    inverse = np.linalg.pinv(solution.jac)
    bend = 2.0 * squares.side / (track * base)  # β of a unit imbalance

    def estimate(value: float, per_base: float, per_imbalance: float) -> ValueAndStd:
        return _estimate(value, np.array([per_base, per_imbalance]) @ inverse, squares)

    return Umbmark(
        e_max=e_max_syst(squares),
        angles=angles,
        paper=paper,
        alpha=estimate(QUARTER * off / base, QUARTER / base**2, 0.0),
        beta=estimate(bend * imbalance, -bend * imbalance / base, bend),
        ratio=estimate(ratio, 0.0, 2.0 / (1.0 - imbalance) ** 2),
        base=estimate(base, 1.0, 0.0),
        left=estimate(1.0 - imbalance, 0.0, -1.0),
        right=estimate(1.0 + imbalance, 0.0, 1.0),
        disagreement=across.angles(),
        disagreement_p=across.probability,
    )


def corrected(robot: Robot, factors: Factors) -> Robot:
    """Multiply a robot's multipliers by corrections."""
    return replace(
        robot,
        wheel_separation_multiplier=robot.wheel_separation_multiplier * factors.base,
        left_wheel_radius_multiplier=robot.left_wheel_radius_multiplier * factors.left,
        right_wheel_radius_multiplier=robot.right_wheel_radius_multiplier * factors.right,
    )


def recomputed(squares: Squares, robot: Robot, factors: Factors) -> Squares:
    """Offsets of the same drives with corrected odometry.

    `robot`: the robot that the odometry of `squares` assumed.
    """
    cw, ccw = _moves(squares, effective_track(robot), factors.base, factors.left, factors.right)
    return replace(squares, cw=squares.cw - cw, ccw=squares.ccw - ccw)


def _offsets(squares: Squares, track: float, off: float, imbalance: float) -> Floats:
    """Mean offsets (x, y clockwise, x, y anticlockwise) [m] predicted for wrong factors."""
    moves = _moves(squares, track, 1.0 + off, 1.0 - imbalance, 1.0 + imbalance)
    return np.concatenate([each.mean(axis=0) for each in moves])


def _moves(
    squares: Squares, track: float, base: float, left: float, right: float
) -> tuple[Floats, Floats]:
    """By how much factors on base and wheels move the ends by odometry, cw and ccw, (n, 2) [m]."""
    cw, ccw = (
        np.array([run.end(track * base, left, right) - run.end(track) for run in driven])
        for driven in (squares.driven(-1, track), squares.driven(1, track))
    )
    return cw, ccw


def _estimate(value: float, slope: Floats, squares: Squares) -> ValueAndStd:
    """Estimate linear in the four mean offsets; Welch-Satterthwaite degrees of freedom."""
    parts = [
        (float(slope[rows] @ covariance_of_mean(offsets) @ slope[rows]), len(offsets) - 1)
        for rows, offsets in ((slice(0, 2), squares.cw), (slice(2, 4), squares.ccw))
    ]
    variance = sum(part for part, _ in parts)
    if variance <= 0.0:
        return ValueAndStd(value, 0.0)
    freedom = variance**2 / sum(part**2 / runs for part, runs in parts)
    widening = student_quantile(0.975, freedom) / NORMAL_95
    return ValueAndStd(value, math.sqrt(variance) * widening)


@dataclass(frozen=True, slots=True)
class _Across:
    """Residual of the fit: two of the four offsets, zero to first order."""

    squares: Squares
    slope: Floats
    left_over: Floats
    """Measured minus fitted (x, y clockwise, x, y anticlockwise) [m]."""

    @property
    def probability(self) -> float:
        """p-value of the residual (Hotelling's test); NaN without dispersion."""
        rest = np.linalg.svd(self.slope)[0][:, 2:]
        covariance = np.zeros((4, 4))
        covariance[:2, :2] = covariance_of_mean(self.squares.cw)
        covariance[2:, 2:] = covariance_of_mean(self.squares.ccw)
        covariance = rest.T @ covariance @ rest
        seen = rest.T @ self.left_over
        if np.linalg.cond(covariance) > 1e12 or not covariance.any():
            return math.nan
        freedom = len(self.squares.cw) + len(self.squares.ccw) - 2
        squared = float(seen @ np.linalg.solve(covariance, seen))
        return fisher_survival(squared * (freedom - 1) / (2 * freedom), 2, freedom - 1)

    def angles(self) -> tuple[float, float]:
        """Residual as a difference between α and β from x and from y [rad]."""
        said = angles_of(self.left_over, self.squares.side)
        return said.alpha_by_x - said.alpha_by_y, said.beta_by_x - said.beta_by_y

    def check(self, measured: Floats) -> None:
        """Reject offsets that lie across the diagonals rather than along them."""
        most = np.linalg.norm(self.left_over) > np.linalg.norm(measured - self.left_over)
        if most and not self.probability > rules.SURE:
            raise InputError(
                "the offsets cannot come from base and radii: these put clockwise offsets near "
                "x = y and anticlockwise ones near x = -y. Is x along the first leg, y positive to "
                "its left, all measured minus odometry, and are cw and ccw not exchanged?"
            )
