# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Pieces of constant curvature (lines, arcs and spins); `end_of_piece` decides where they end."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from werrimbi_odom.model.compiled import of_floats
from werrimbi_odom.model.covariance import PoseCovariance
from werrimbi_odom.model.end_of_piece import PieceRule, PieceSums, extended
from werrimbi_odom.model.motion import BodyMotion, WheelTravel
from werrimbi_odom.model.pose import Pose
from werrimbi_odom.model.uncertainty import Uncertainty

PieceKind = Literal["line", "arc", "spin"]

LINE_TURN = 0.05
"""A line turns by at most this angle [rad] ..."""
LINE_CURVATURE = 0.05
"""... and each wheel differs by at most this share from the mean travel of both."""
SPIN_RADIUS = 0.05
"""Largest distance from the axle's midpoint to the centre of a spin, as a share of the track."""

_extended = of_floats(extended)


@dataclass(frozen=True, slots=True)
class Piece:
    """A stretch of constant curvature, finished or still open."""

    kind: PieceKind
    time_start: float
    """Stamp at the start [s]."""
    time_end: float
    """Stamp at the end [s]."""
    start: Pose
    """Pose at the start, odometry frame."""
    travel: WheelTravel[float]
    """Signed travel of the wheels over the piece [m]."""
    motion: BodyMotion[float]
    """The piece as one constant twist: along, sideways [m], turn [rad]."""
    covariance_start: PoseCovariance[float]
    """Covariance of the pose at the start."""

    @property
    def length(self) -> float:
        """Signed travel of the axle's midpoint [m]."""
        return self.motion.along

    @property
    def turn(self) -> float:
        """Change of heading [rad]."""
        return self.motion.turn

    @property
    def radius(self) -> float:
        """Signed radius of the midpoint's path [m]: positive to the left, infinite for a line."""
        return self.motion.along / self.motion.turn if self.motion.turn else math.inf


def kind_of(motion: BodyMotion[float], track: float) -> PieceKind:
    """Name of this kind of motion; no computation depends on it."""
    turned = 0.5 * track * abs(motion.turn)
    if abs(motion.turn) <= LINE_TURN and turned <= LINE_CURVATURE * abs(motion.along):
        return "line"
    return "spin" if abs(motion.along) <= SPIN_RADIUS * track * abs(motion.turn) else "arc"


@dataclass(slots=True)
class OpenPiece:
    """The piece that is being driven."""

    time_start: float
    start: Pose
    errors_start: Uncertainty[float]
    travelled: float = 0.0
    """Travel u of the earlier pieces since the pose was last set [m]."""
    stretch: PieceSums = PieceSums()  # noqa: RUF009 - an immutable value

    @property
    def travelled_after(self) -> float:
        """`travelled` including this piece."""
        return self.travelled + self.stretch.travelled

    def extend(
        self, rule: PieceRule, travel: WheelTravel[float], motion: BodyMotion[float], pose: Pose
    ) -> bool:
        """Add a step that ends at `pose`; or leave the piece unchanged and return False."""
        goes_on, self.stretch = _extended(
            rule, self.start, self.travelled, self.stretch, travel, motion, pose
        )
        return goes_on

    def finished(self, time_end: float, track: float) -> Piece:
        """The piece so far, as an immutable value."""
        left, right, motion, *_ = self.stretch
        return Piece(
            kind_of(motion, track),
            self.time_start,
            time_end,
            self.start,
            WheelTravel(left, right),
            motion,
            self.errors_start.covariance,
        )
