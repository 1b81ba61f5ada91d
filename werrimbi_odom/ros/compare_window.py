# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Consistency of the covariance (NEES) over a window of recent legs."""

from __future__ import annotations

import math
from collections import deque

from werrimbi_odom.inference.comparison.consistency import chance_bounds, honest_bounds
from werrimbi_odom.inference.comparison.leg_errors import CHI2_95

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
    """The last legs.

    Parameters
    ----------
    size : int
        Number of legs.
    """

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
