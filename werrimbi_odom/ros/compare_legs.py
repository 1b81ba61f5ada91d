# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Legs, live: error of the odometry's relative pose against the reference, and its covariance.

As in `werrimbi compare`, but the predicted covariance comes from the odometry messages: with pose
covariances P₁ and P₂, that of the stretch between is P₂ - J P₁ Jᵀ (docs/model.md).

`Window` looks back on the last of them: is the covariance consistent (NEES)?
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from statistics import median
from typing import NamedTuple

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.consistency import chance_bounds, honest_bounds
from werrimbi_odom.inference.comparison.leg_errors import squared_deviation
from werrimbi_odom.inference.distributions import CHI2_95
from werrimbi_odom.inference.legs.cutting import legs_worth
from werrimbi_odom.inference.legs.gaps import are_gaps
from werrimbi_odom.model.covariance import PoseCovariance, carried
from werrimbi_odom.model.pose import Floats, between, wrap
from werrimbi_odom.ros.compare_track import TimedPose

_KEPT = 200
"""Intervals of the reference that define a usual one."""

_ROUNDING = 1e-9  # of a covariance: rounding error in the difference of two large ones
_SHARE = 0.1  # of its largest entry: error of pieces; if P is constant, the growth is -1 of it


class Both(NamedTuple):
    """Poses of odometry and reference at one instant, each in its own frame."""

    odometry: TimedPose
    reference: TimedPose


@dataclass(frozen=True, slots=True)
class LegError:
    """Measured minus predicted relative pose, in the frame of the robot at the end.

    x is along the robot's heading, y to its left [m], and yaw anticlockwise [rad].
    """

    time: float
    error: Floats
    """Shape (3,)."""
    covariance: Floats
    """Covariance of the error, from odometry and reference, shape (3, 3)."""
    grows: bool
    """Whether the odometry's covariance grew as it does along a path."""

    @property
    def deviation(self) -> float:
        """Squared Mahalanobis distance error' Σ⁻¹ error: chi-squared if Σ is consistent.

        Infinite if Σ is singular (some direction is claimed to be without error).
        """
        try:
            return float(squared_deviation(self.error[None], self.covariance[None])[0])
        except np.linalg.LinAlgError:
            return math.inf


class LegCutter:
    """Cuts a drive into legs, each of which begins at the pose after the end of the last.

    No reference pose belongs to two legs, so their errors are independent. No leg spans a gap: an
    unusually long interval without reference in which the robot moved. A leg has a path of
    `length` [m], or a quarter turn on the spot; path and turn add up.
    """

    def __init__(self, length: float) -> None:
        self._length = length
        self._start: Both | None = None
        self._last: Both | None = None
        self._intervals: deque[tuple[float, float]] = deque(maxlen=_KEPT)

    def restart(self) -> None:
        """Discard the current leg."""
        self._start = self._last = None

    def take(self, both: Both) -> tuple[LegError | None, bool]:
        """Error of the current leg so far, and whether this pose ends it."""
        last, self._last = self._last, both
        if last is not None and self._is_gap(last, both):
            self._start = None
        start = self._start
        if start is None:
            self._start = both
            return None, False
        ends = self._way(start, both) >= 1.0
        if ends:
            self._start = None
        return leg_error(start, both), ends

    def _way(self, start: Both, end: Both) -> float:
        path = end.odometry.path - start.odometry.path
        turned = end.odometry.turned - start.odometry.turned
        return legs_worth(path, turned, self._length, rules.QUARTER_TURN)

    def _is_gap(self, last: Both, both: Both) -> bool:
        """Whether there is a gap in the reference, compared with its usual intervals."""
        duration = both.reference.time - last.reference.time
        way = self._way(last, both)
        if way >= rules.GAP_LEG and len(self._intervals) >= rules.GAP_FEWEST:
            usual = (median(column) for column in zip(*self._intervals, strict=True))
            if are_gaps(np.array(duration), np.array(way), *usual):
                return True
        if way > 0.0:
            self._intervals.append((duration, way))
        return False


def leg_error(start: Both, end: Both) -> LegError:
    """Error of the relative pose between two instants."""
    predicted = between(start.odometry.pose, end.odometry.pose)
    measured = between(start.reference.pose, end.reference.pose)
    error = np.array(
        [measured.x - predicted.x, measured.y - predicted.y, wrap(measured.yaw - predicted.yaw)]
    )
    odometry = _of_stretch(start.odometry, end.odometry, sign=-1.0)
    scale = float(np.abs(end.odometry.covariance).max())
    floor = _ROUNDING * scale + _SHARE * float(np.abs(odometry).max())
    grows = bool(np.linalg.eigvalsh(odometry)[0] >= -floor and np.trace(odometry) > 0.0)
    both = odometry + _of_stretch(start.reference, end.reference, sign=1.0)
    return LegError(end.odometry.time, *_turned(error, both, -(predicted.yaw)), grows)


def _of_stretch(start: TimedPose, end: TimedPose, sign: float) -> Floats:
    """Covariance of the pose at `end` relative to `start`, in the frame of `start`.

    `sign` is -1 if the error at the end contains that at the start (odometry), and +1 if both are
    independent (a reference that measures each pose separately).
    """
    dx, dy = end.pose.x - start.pose.x, end.pose.y - start.pose.y
    swung = np.array(carried(start.covariance, dx, dy))
    entries: list[float] = (np.array(end.covariance) + sign * swung).tolist()
    matrix = PoseCovariance(*entries).matrix()
    return _turned(np.zeros(3), matrix, -start.pose.yaw)[1]


def _turned(error: Floats, covariance: Floats, angle: float) -> tuple[Floats, Floats]:
    """Rotate an error and its covariance by `angle`."""
    cos, sin = math.cos(angle), math.sin(angle)
    turn = np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
    return turn @ error, turn @ covariance @ turn.T


FREEDOM = 3
"""Degrees of freedom of a leg: x, y, yaw."""
LEAST = 5
"""Number of legs needed for a verdict."""
LASTS = 5
"""Consecutive windows outside the bounds before it is reported. With a consistent covariance this
happens once in 260,000 legs, a week of driving; a single window is outside once in 24,000, a day of
driving (simulated)."""

_ONE_LEG = 0.7  # share of a window's NEES from which one leg is named as the cause


class Window:
    """The last `size` legs."""

    def __init__(self, size: int) -> None:
        self._deviations: deque[float] = deque(maxlen=size)
        self._grew: deque[bool] = deque(maxlen=size)
        self._outside = 0
        """Consecutive windows with a NEES outside the bounds."""

    def take(self, deviation: float, grows: bool) -> None:
        """Add a leg; if the covariance did not grow, its deviation means nothing."""
        grows = grows and math.isfinite(deviation)
        self._grew.append(grows)
        if grows:
            self._deviations.append(deviation)
            low, high = honest_bounds(FREEDOM * self.count)
            honest = self.count < LEAST or low <= self.nees <= high
            self._outside = 0 if honest else self._outside + 1

    @property
    def count(self) -> int:
        """Number of legs with a meaningful deviation."""
        return len(self._deviations)

    @property
    def nees(self) -> float:
        """Mean of error' Σ⁻¹ error per degree of freedom: 1 if consistent; NaN without legs."""
        return sum(self._deviations) / (FREEDOM * self.count) if self.count else math.nan

    @property
    def coverage(self) -> float:
        """Share of legs inside their 95 % ellipsoid; NaN without legs."""
        if not self.count:
            return math.nan
        inside = float(CHI2_95[FREEDOM])
        return sum(each <= inside for each in self._deviations) / self.count

    def bounds(self) -> tuple[float, float]:
        """Interval that contains the NEES of a consistent covariance in 95 % of cases."""
        return chance_bounds(FREEDOM * max(self.count, 1), 0.95)

    def verdict(self) -> tuple[bool, str]:
        """Whether all is well, and the message."""
        legs = len(self._grew)
        if legs < LEAST:
            return True, f"{legs} of the {LEAST} legs driven that a verdict needs"
        if not sum(self._grew) > 0.5 * legs:
            return False, (
                f"the odometry's covariance does not grow with the way driven (on {legs} legs, "
                f"{legs - sum(self._grew)} times): it is not that of its pose. Is it a constant?"
            )
        low, high = honest_bounds(FREEDOM * max(self.count, 1))
        words = (
            f"NEES {self.nees:.2f} over {self.count} legs, honest between {low:.2f} and "
            f"{high:.2f}; {self.coverage:.0%} of legs inside their 95 % ellipsoid"
        )
        if self._outside < LASTS:
            within = self.bounds()
            if within[0] <= self.nees <= within[1]:
                return True, f"the covariance is honest: {words}"
            size = "large" if self.nees < within[0] else "small"
            return True, f"the covariance may be too {size}, more legs will tell: {words}"
        if self.nees < low:
            return (
                False,
                "the covariance is too large, or reference_sigma_xy and _yaw larger than the "
                f"reference's noise: the errors are smaller than they say: {words}",
            )
        worst = max(self._deviations) / sum(self._deviations)
        if worst > _ONE_LEG and self.count > 2:
            words += (
                f"; one leg makes {worst:.0%} of it: a jump of the reference, a hard slip, or "
                "the one sharp turn among calmer legs"
            )
        return False, f"the covariance is too small, the errors are larger than it says: {words}"
