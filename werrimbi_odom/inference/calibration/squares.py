# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Squares driven in both senses, and their return position errors (paper, section 3)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from werrimbi_odom.errors import InputError
from werrimbi_odom.inference import rules
from werrimbi_odom.model.motion import WheelTravel, displacement, wheels_to_body
from werrimbi_odom.model.pose import Floats

OTHER_VEHICLES = (
    ("TRC LabMate, average", 0.027),
    ("Cybermotion K2A, not calibrated", 0.063),
    ("CLAPPER", 0.022),
    ("Andros with trailer", 0.074),
    ("Werrimbi", 0.030),
)
"""E_max,syst of other robots on squares of 4 m [m] (paper, Table 2)."""


@dataclass(frozen=True, slots=True)
class CountedSquare:
    """Odometry of one square."""

    travel: WheelTravel[Floats]
    """Steps of wheel travel [m], with the radii that the odometry used."""
    yaw: float = 0.0
    """Heading at the start, relative to the first leg [rad]."""

    def end(self, track: float, left: float = 1.0, right: float = 1.0) -> Floats:
        """End position [m], shape (2,), on a base `track` [m] with each wheel's travel scaled."""
        wheels = WheelTravel(self.travel.left * left, self.travel.right * right)
        motion = wheels_to_body(wheels, track)
        dx, dy = displacement(motion, self.yaw + np.cumsum(motion.turn) - motion.turn)
        return np.array([dx.sum(), dy.sum()])


@dataclass(frozen=True, slots=True)
class Squares:
    """Offsets of n clockwise and m anticlockwise squares.

    InputError if squares are missing, or offsets are too large for squares of that side.
    """

    side: float
    """Length of a leg, D [m]."""
    cw: Floats
    ccw: Floats
    """End positions, measured minus odometry [m]; x along the first leg, y to its left,
    shapes (n, 2) and (m, 2)."""
    driven_cw: tuple[CountedSquare, ...] = ()
    driven_ccw: tuple[CountedSquare, ...] = ()
    """Odometry of each. Empty: all were perfect squares by odometry."""

    def __post_init__(self) -> None:
        if not (math.isfinite(self.side) and self.side > 0.0):
            raise InputError(f"the side must be a length in metres above zero, not {self.side:g}")
        missing = []
        for sense, runs in (("cw", len(self.cw)), ("ccw", len(self.ccw))):
            if runs < rules.LEAST_SQUARES:
                missing.append(f"{rules.LEAST_SQUARES - runs} more {sense} ({runs} given)")
        if missing:
            raise InputError(
                f"too few squares: missing at least {' and '.join(missing)}. One sense alone "
                "cannot tell the base from the wheels, and one run alone has no scatter; "
                f"{rules.ADVISED_SQUARES} of each are usual"
            )
        for sense, offsets in (("cw", self.cw), ("ccw", self.ccw)):
            length = np.hypot(*offsets.T)
            worst = int(np.argmax(np.where(np.isfinite(length), length, np.inf)))
            if not length[worst] <= rules.LARGEST_OFFSET * self.side:
                x, y = offsets[worst]
                raise InputError(
                    f"{sense} square number {worst + 1}: its offset ({x:g}, {y:g}) m is more than "
                    f"two sides of {self.side:g} m; are offset and side both in metres? If they "
                    "are, drive a smaller square first"
                )

    def driven(self, sense: int, track: float) -> tuple[CountedSquare, ...]:
        """Odometry of the squares of a sense (+1 anticlockwise, -1 clockwise)."""
        recorded = self.driven_ccw if sense > 0 else self.driven_cw
        return recorded or (perfect_square(self.side, track, sense),)


def perfect_square(side: float, track: float, sense: int) -> CountedSquare:
    """Four legs and four corners on the spot, as odometry sees them; +1 anticlockwise."""
    corner = sense * 0.25 * math.pi * track
    return CountedSquare(WheelTravel(np.array([side, -corner] * 4), np.array([side, corner] * 4)))


def e_max_syst(squares: Squares) -> float:
    """E_max,syst [m]: the larger distance of the two centres of gravity (equation 12)."""
    return float(max(np.hypot(*part.mean(axis=0)) for part in (squares.cw, squares.ccw)))


def e_max_of_scatter(squares: Squares) -> float:
    """Approximate E_max,syst of a perfect calibration, from the dispersion alone [m]."""
    return math.sqrt(
        max(float(np.trace(covariance_of_mean(part))) for part in (squares.cw, squares.ccw))
    )


def covariance_of_mean(offsets: Floats) -> Floats:
    """Covariance of a centre of gravity, from the dispersion of its runs [m²], shape (2, 2)."""
    return np.asarray(np.cov(offsets.T) / len(offsets))
