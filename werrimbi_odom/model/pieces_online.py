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
from typing import NamedTuple

from werrimbi_odom.model.motion import BodyMotion, Chord, Number, WheelTravel, along_chord, chord_of
from werrimbi_odom.model.pose import Pose
from werrimbi_odom.model.robot import Robot

SETTLED = 10.0
"""Sum of both wheels' travel, in tracks, after which the full tolerance of a piece holds."""


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


class PieceRule(NamedTuple):
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


def allowed_lead(rule: PieceRule, share: Number) -> Number:
    """Allowance on v [m] at a share of the full tolerance."""
    return rule.quantum + rule.lead * share


def off_arc(rule: PieceRule, u: Number, share: Number, miss_x: Number, miss_y: Number) -> Number:
    """Squared distance of the arc's end from the pose, less what is allowed [m²]."""
    allowed = rule.quantum + rule.path * share + rule.path_per_travel * u
    return miss_x * miss_x + miss_y * miss_y - allowed * allowed


class PieceSums(NamedTuple):
    """A piece as far as it has been driven: sums since its start, and what bounds its going on."""

    left: float = 0.0
    """Signed travel of the left wheel [m]."""
    right: float = 0.0
    """Signed travel of the right wheel [m]."""
    motion: BodyMotion[float] = BodyMotion(0.0, 0.0, 0.0)
    """As one constant twist."""
    chord: Chord[float] = Chord(1.0, 1.0, 0.0)
    """Of that twist, from the heading at the start."""
    left_low: float = 0.0
    """The left wheel's travel has been between this and the next [m]."""
    left_high: float = 0.0
    right_low: float = 0.0
    right_high: float = 0.0
    slope_low: float = -math.inf
    """The cone: v / u must stay between this and the next."""
    slope_high: float = math.inf
    empty: bool = True

    @property
    def travelled(self) -> float:
        """Sum u of both wheels' travel [m]."""
        return abs(self.left) + abs(self.right)


NOTHING = PieceSums()
"""A stretch before its first step."""


def extended(
    rule: PieceRule,
    start: Pose,
    earlier: float,
    stretch: PieceSums,
    travel: WheelTravel[float],
    motion: BodyMotion[float],
    pose: Pose,
) -> tuple[bool, PieceSums]:
    """Whether a stretch goes on with a step that ends at `pose`; and the longer, or the same, one.

    Parameters
    ----------
    start : Pose
        Of the stretch. An empty one takes any step.
    earlier : float
        Travel u of the pieces before, since the pose was last set [m].
    travel, motion
        Of the step.
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
