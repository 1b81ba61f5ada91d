# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The UMBmark equations of the paper (5 to 11), to first order; errata: docs/model.md."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from werrimbi_odom.errors import InputError
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.calibration.squares import Squares
from werrimbi_odom.model.pose import Floats

QUARTER = 0.5 * math.pi


@dataclass(frozen=True, slots=True)
class Angles:
    """α and β to first order [rad], each from x and from y (equations 6 and 7)."""

    alpha_by_x: float
    alpha_by_y: float
    beta_by_x: float
    beta_by_y: float

    @property
    def alpha(self) -> float:
        """Angle by which a corner falls short of 90 degrees [rad]."""
        return 0.5 * (self.alpha_by_x + self.alpha_by_y)

    @property
    def beta(self) -> float:
        """Angle by which a leg bends to the left [rad]."""
        return 0.5 * (self.beta_by_x + self.beta_by_y)


@dataclass(frozen=True, slots=True)
class Factors:
    """Corrections of the robot file: new multiplier = old one times this."""

    base: float
    """C_B: ratio of true to assumed base (equation 9)."""
    ratio: float
    """E_d: ratio of right to left radius, relative to that assumed (equation 8)."""

    @property
    def left(self) -> float:
        """C_L (equation 10)."""
        return 2.0 / (self.ratio + 1.0)

    @property
    def right(self) -> float:
        """C_R (equation 11)."""
        return self.ratio * self.left


def first_order_angles(squares: Squares) -> Angles:
    """Equations 5 to 7 of the paper."""
    return angles_of(
        np.concatenate([squares.cw.mean(axis=0), squares.ccw.mean(axis=0)]), squares.side
    )


def angles_of(centres: Floats, side: float) -> Angles:
    """Equations 6 and 7 for centres of gravity (x, y clockwise, x, y anticlockwise) [m]."""
    x_cw, y_cw, x_ccw, y_ccw = (float(value) / (-4.0 * side) for value in centres)
    return Angles(x_cw + x_ccw, y_cw - y_ccw, x_cw - x_ccw, y_cw + y_ccw)


def paper_factors(angles: Angles, side: float, track: float) -> Factors:
    """Equations 8 and 9 of the paper, the latter as corrected by the errata.

    `angles`: α and β. `side`: D [m]. `track`: B as assumed by the odometry [m].
    """
    bend = track * math.sin(0.5 * angles.beta)
    base = QUARTER / (QUARTER - min(angles.alpha, 0.5 * QUARTER))
    ratio = (side + bend) / max(side - bend, 0.5 * side)
    check_size(base, ratio)
    return Factors(base, ratio)


def check_size(base: float, ratio: float) -> None:
    """Reject corrections too large for a calibration."""
    if abs(base - 1.0) > rules.LARGEST_MISTAKE or abs(ratio - 1.0) > rules.LARGEST_MISTAKE:
        raise InputError(
            f"the offsets ask for a base {100 * (base - 1.0):+.0f} % and a ratio of the radii "
            f"{100 * (ratio - 1.0):+.0f} % off: more than a calibration mends. Are offsets and "
            "side both in metres, and wheel_separation and wheel_radius of the robot file right?"
        )
