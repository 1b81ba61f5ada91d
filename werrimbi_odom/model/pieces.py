# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Motion cut into pieces of constant curvature, online: line, arc and spin.

The noise of a wheel goes with its travel, not with time, so a piece is a straight stretch in the
plane of the two wheels' travel: speed may change and the robot may stop, while the ratio R : L may
not. A piece goes on while three things hold to within the encoders' quantisation and a tolerance:

1. neither wheel has reversed;
2. every earlier point of the piece lies on the line to the present one. Along the line the sum of
   both wheels' travel u = |L| + |R| grows, and the difference v = |R| - |L| says which wheel leads;
   each point leaves a cone of slopes v / u that pass it closely enough, and the present slope must
   lie in the intersection of all cones, which takes two numbers to keep (a swing filter);
3. the pose that was integrated message by message lies on the piece's arc.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from werrimbi_odom.model.covariance import PoseCovariance
from werrimbi_odom.model.motion import BodyMotion, Number, WheelTravel, displacement
from werrimbi_odom.model.pose import Pose
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.uncertainty import Uncertainty

PieceKind = Literal["line", "arc", "spin"]

LINE_TURN = 0.05
"""A line turns by no more than this [rad] ..."""
LINE_CURVATURE = 0.05
"""... and its wheels differ by no more than this share of their travel."""
SETTLED = 10.0
"""Sum of both wheels' travel, in tracks, after which the full tolerance of a piece holds."""
SPIN_RADIUS = 0.05
"""A spin turns about a point no further from the axle's middle than this share of the track."""


@dataclass(frozen=True, slots=True)
class PieceTolerance:
    """How far a piece may depart from one constant curvature, beyond quantisation.

    Parameters
    ----------
    path : float
        Distance between the path driven and the piece's arc [m].
    heading : float
        Angle between the heading driven and the arc's [rad].

    Notes
    -----
    What a departure does to the covariance is of second order in its ratio to the track: a lateral
    departure δ adds b δ² to a variance that is at least a = b B²/4, so 4 (δ/B)². The defaults keep
    that under one part in a thousand for tracks from 0.2 m (docs/pieces.md has the measurements).
    """

    path: float = 0.003
    heading: float = 0.01


@dataclass(frozen=True, slots=True)
class Piece:
    """A finished, or the present, stretch of constant curvature."""

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
        """Signed radius of the midpoint's path [m]: positive to the left, infinite on a line."""
        return self.motion.along / self.motion.turn if self.motion.turn else math.inf


def kind_of(motion: BodyMotion[float], track: float) -> PieceKind:
    """What a person would call this motion. Only a name: no figure depends on it."""
    turned = 0.5 * track * abs(motion.turn)
    if abs(motion.turn) <= LINE_TURN and turned <= LINE_CURVATURE * abs(motion.along):
        return "line"
    return "spin" if abs(motion.along) <= SPIN_RADIUS * track * abs(motion.turn) else "arc"


@dataclass(frozen=True, slots=True)
class PieceRule:
    """The conditions in metres of wheel travel, for one robot and tolerance."""

    quantum: float
    """One count of each wheel [m]; of the coarser one, which on a tight arc may count for both."""
    lead: float
    """How far a wheel may lead or lag its share of the travel, beyond the quantum."""
    path: float
    """How far the arc's end may lie from the pose, beyond the quantum."""
    flicker: float
    """How far a wheel may go back without having reversed: one count, which may flicker."""
    path_per_travel: float
    """A count swings all of the path that follows: distance of the arc's end per metre of u.

    The heading read from the counters lies up to one count of a wheel beside the true one for all
    of a piece, and its change over the piece up to two; half the travel times one count over the
    track is the most that both together can do.
    """
    settled: float
    """Travel u after which the full tolerance holds; before it, its share of that travel."""

    @staticmethod
    def of(robot: Robot, tolerance: PieceTolerance) -> PieceRule:
        """The rule for a robot's track and encoders."""
        quantum = 2.0 * max(robot.left_tick, robot.right_tick)
        return PieceRule(
            quantum=quantum,
            lead=min(tolerance.heading * robot.track, 2.0 * tolerance.path),
            path=tolerance.path,
            flicker=0.75 * quantum,
            path_per_travel=0.25 * quantum / robot.track,
            settled=SETTLED * robot.track,
        )

    def allowed_lead(self, share: Number) -> Number:
        """Allowance on v [m] at a share of the full tolerance."""
        return self.quantum + self.lead * share

    def off_arc(self, u: Number, share: Number, miss_x: Number, miss_y: Number) -> Number:
        """Squared distance of the arc's end from the pose, less what is allowed [m²]."""
        allowed = self.quantum + self.path * share + self.path_per_travel * u
        return miss_x * miss_x + miss_y * miss_y - allowed * allowed


@dataclass(slots=True)
class OpenPiece:
    """The piece being driven: sums since its start, and the two slopes that bound its cone."""

    time_start: float
    start: Pose
    errors_start: Uncertainty[float]
    travelled: float = 0.0
    """Travel u of the earlier pieces, since the pose was last set [m]."""
    left: float = 0.0
    right: float = 0.0
    along: float = 0.0
    sideways: float = 0.0
    turn: float = 0.0
    _left_span: tuple[float, float] = (0.0, 0.0)
    _right_span: tuple[float, float] = (0.0, 0.0)
    _slopes: tuple[float, float] = (-math.inf, math.inf)
    _empty: bool = True

    @property
    def travel(self) -> WheelTravel[float]:
        """Signed wheel travel since the start."""
        return WheelTravel(self.left, self.right)

    @property
    def motion(self) -> BodyMotion[float]:
        """The piece so far as one constant twist."""
        return BodyMotion(self.along, self.sideways, self.turn)

    @property
    def travelled_after(self) -> float:
        """`travelled`, this piece included."""
        return self.travelled + (abs(self.left) + abs(self.right))

    def extend(
        self, rule: PieceRule, travel: WheelTravel[float], motion: BodyMotion[float], pose: Pose
    ) -> bool:
        """Take one more step that ends at `pose`, or leave the piece as it is and return False."""
        left, right = self.left + travel.left, self.right + travel.right
        whole = BodyMotion(
            self.along + motion.along, self.sideways + motion.sideways, self.turn + motion.turn
        )
        left_span = min(self._left_span[0], left), max(self._left_span[1], left)
        right_span = min(self._right_span[0], right), max(self._right_span[1], right)
        low, high = self._slopes
        u, v = abs(left) + abs(right), abs(right) - abs(left)
        share = min(1.0, (self.travelled + u) / rule.settled)
        if u > 0.0:
            lead = rule.allowed_lead(share)
            low, high = max(low, (v - lead) / u), min(high, (v + lead) / u)
        if not self._empty:
            dx, dy = displacement(whole, self.start.yaw)
            miss_x, miss_y = pose.x - self.start.x - dx, pose.y - self.start.y - dy
            if (
                _reversed(left, *left_span, rule.flicker)
                or _reversed(right, *right_span, rule.flicker)
                or (u > 0.0 and not low <= v / u <= high)
                or rule.off_arc(u, share, miss_x, miss_y) > 0.0
            ):
                return False
        self.left, self.right = left, right
        self.along, self.sideways, self.turn = whole
        self._left_span, self._right_span, self._slopes = left_span, right_span, (low, high)
        self._empty = False
        return True

    def finished(self, time_end: float, track: float) -> Piece:
        """The piece as it stands, as a value."""
        return Piece(
            kind_of(self.motion, track),
            self.time_start,
            time_end,
            self.start,
            self.travel,
            self.motion,
            self.errors_start.covariance,
        )


def _reversed(travel: float, lowest: float, highest: float, flicker: float) -> bool:
    forwards = lowest >= -flicker and travel >= highest - flicker
    backwards = highest <= flicker and travel <= lowest + flicker
    return not (forwards or backwards)
