# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Segmentation of motion into pieces of constant curvature, online: line, arc and spin.

The noise of a wheel grows with its travel, not with time. So a piece is a straight line in the
plane of the two wheels' travel: the speed may change and the robot may stop, but the ratio R : L is
constant. A piece continues while three conditions hold, within the encoders' quantisation and a
tolerance:

1. Neither wheel has reversed.
2. Every earlier point of the piece lies on the line to the present one. Along this line the total
   travel u = |L| + |R| grows, and the difference v = |R| - |L| says which wheel leads. Each point
   allows a cone of slopes v / u that pass it closely enough. The present slope must lie in the
   intersection of all cones, which is two numbers (a swing filter).
3. The pose integrated message by message lies on the piece's arc.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from werrimbi_odom.model.motion import BodyMotion, Chord, Number, WheelTravel, along_chord, chord_of
from werrimbi_odom.model.pose import Pose
from werrimbi_odom.model.robot import Robot

SETTLED = 10.0
"""Total travel of both wheels, in tracks, after which a piece has its full tolerance."""


@dataclass(frozen=True, slots=True)
class PieceTolerance:
    """Largest deviation of a piece from constant curvature, beyond quantisation.

    Notes
    -----
    The effect on the covariance is of second order in deviation over track: a lateral deviation δ
    adds b δ² to a variance of at least a = b B²/4, hence a share of 4 (δ/B)². The defaults keep it
    below one in a thousand for tracks from 0.2 m (measurements in docs/pieces.md).
    """

    path: float = 0.003
    """Distance between the path and the piece's arc [m]."""
    heading: float = 0.01
    """Angle between the heading and that of the arc [rad]."""


class PieceRule(NamedTuple):
    """The conditions in metres of wheel travel, for one robot and tolerance."""

    quantum: float
    """One count of the left wheel and one of the right [m], both taken as the coarser one's."""
    lead: float
    """Largest lead or lag of a wheel relative to its share of the travel, beyond the quantum."""
    path: float
    """Largest distance of the arc's end from the pose, beyond the quantum."""
    flicker: float
    """Largest backward travel that is no reversal: one and a half counts, as one may flicker."""
    path_per_travel: float
    """Allowed distance of the arc's end per metre of u, since a count rotates all of the following
    path.

    During a piece, the heading from the counters may be off by one count of a wheel, and its change
    by up to two. Together they displace the end by at most half the travel times one count over the
    track."""
    settled: float
    """Travel u after which the full tolerance applies; before, it is proportional to u."""

    @staticmethod
    def of(robot: Robot, tolerance: PieceTolerance) -> PieceRule:
        """Create the rule for a robot's track and encoders."""
        quantum = 2.0 * max(robot.left_tick, robot.right_tick)
        return PieceRule(
            quantum=quantum,
            lead=min(tolerance.heading * robot.track, 2.0 * tolerance.path),
            path=tolerance.path,
            flicker=0.75 * quantum,
            path_per_travel=0.25 * quantum / robot.track,
            settled=SETTLED * robot.track,
        )


def allowed_lead(rule: PieceRule, share: Number) -> Number:
    """Allowed deviation of v [m] at a share of the full tolerance."""
    return rule.quantum + rule.lead * share


def off_arc(rule: PieceRule, u: Number, share: Number, miss_x: Number, miss_y: Number) -> Number:
    """Squared distance of the arc's end from the pose, minus the allowed one [m²]."""
    allowed = rule.quantum + rule.path * share + rule.path_per_travel * u
    return miss_x * miss_x + miss_y * miss_y - allowed * allowed


class PieceSums(NamedTuple):
    """A piece so far: sums since its start, and the bounds for its continuation."""

    left: float = 0.0
    """Signed travel of the left wheel [m]."""
    right: float = 0.0
    """Signed travel of the right wheel [m]."""
    motion: BodyMotion[float] = BodyMotion(0.0, 0.0, 0.0)
    """The motion as one constant twist."""
    chord: Chord[float] = Chord(1.0, 1.0, 0.0)
    """Chord of that twist, with the heading at the start."""
    left_low: float = 0.0
    """Smallest travel of the left wheel so far [m]; then its largest, and both of the right
    wheel."""
    left_high: float = 0.0
    right_low: float = 0.0
    right_high: float = 0.0
    slope_low: float = -math.inf
    """The cone: v / u must stay between `slope_low` and `slope_high`."""
    slope_high: float = math.inf
    empty: bool = True

    @property
    def travelled(self) -> float:
        """Total travel u of both wheels [m]."""
        return abs(self.left) + abs(self.right)


NOTHING = PieceSums()
"""An empty stretch."""


def extended(
    rule: PieceRule,
    start: Pose,
    earlier: float,
    stretch: PieceSums,
    travel: WheelTravel[float],
    motion: BodyMotion[float],
    pose: Pose,
) -> tuple[bool, PieceSums]:
    """Whether a stretch continues with a step that ends at `pose`; and the stretch afterwards.

    `start`: pose at the start of the stretch. An empty stretch accepts any step. `earlier`: travel
    u of the earlier pieces since the pose was last set [m]. `travel`, `motion`: of the step.
    """
    left, right, whole, _, left_low, left_high, right_low, right_high, low, high, empty = stretch
    left, right = left + travel.left, right + travel.right
    along, sideways, turn = motion
    whole = BodyMotion(whole.along + along, whole.sideways + sideways, whole.turn + turn)
    left_low = left if left < left_low else left_low
    left_high = left if left > left_high else left_high
    right_low = right if right < right_low else right_low
    right_high = right if right > right_high else right_high
    u, v = abs(left) + abs(right), abs(right) - abs(left)
    share = 1.0 if earlier >= rule.settled else min(1.0, (earlier + u) / rule.settled)
    slope = 0.0
    if u > 0.0:
        lead = allowed_lead(rule, share)
        slope, lowest, highest = v / u, (v - lead) / u, (v + lead) / u
        low = lowest if lowest > low else low
        high = highest if highest < high else high
    chord = chord_of(whole.turn, start.yaw)
    if not empty:
        flicker = rule.flicker
        if (
            (u > 0.0 and not low <= slope <= high)
            or _reversed(left, left_low, left_high, flicker)
            or _reversed(right, right_low, right_high, flicker)
        ):
            return False, stretch
        dx, dy = along_chord(whole, chord)
        if off_arc(rule, u, share, pose.x - start.x - dx, pose.y - start.y - dy) > 0.0:
            return False, stretch
    return True, PieceSums(
        left, right, whole, chord, left_low, left_high, right_low, right_high, low, high, False
    )


def _reversed(travel: float, lowest: float, highest: float, flicker: float) -> bool:
    if travel >= highest - flicker and lowest >= -flicker:
        return False
    return not (travel <= lowest + flicker and highest <= flicker)
