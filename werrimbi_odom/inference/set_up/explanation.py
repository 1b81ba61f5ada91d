# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The simplest set-up that explains the fitted parameters.

Signs of both wheels and the mounting angle always have several algebraically equivalent
explanations. Exchanged wheels turn the robot the wrong way and drive it backwards, so they equal
both wheels reversed with a reference turned by 180 degrees; with a mirrored reference the roles are
exchanged once more. The fewest mistakes and the smallest angle win; the others are reported as
twins (observationally equivalent).
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass, replace

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.set_up.misentered_values import is_ordinary


@dataclass(frozen=True, slots=True)
class SetUpEstimate:
    """Measured set-up, independent of the robot file's wiring; in the metres of the file [m]."""

    left: float
    """Turn per travel of the recorded left wheel, positive if it turns the robot right [rad/m]."""
    right: float
    """Turn per travel of the recorded right wheel, positive if it turns the robot left [rad/m]."""
    base: float | None
    """Wheel base in the reference's metres [m]; None where only yaw was measured."""
    yaw: float | None
    """Mounting angle if each wheel's sign is that of its turning [rad]; None where not
    identifiable."""
    arm: complex = 0j
    """Lever arm, ahead + i left of the measured point, rotated by -yaw [m]."""
    ticks: float = 1.0
    """Travel of a count of the file's right wheel over that of its left: what exchanged counters
    were multiplied by is the other wheel's."""

    def sizes(self, swapped: bool, base: float) -> tuple[float, float]:
        """Ratios of each wheel's true travel to that by the robot file."""
        left, right = abs(self.left) * base, abs(self.right) * base
        return (right * self.ticks, left / self.ticks) if swapped else (left, right)


@dataclass(frozen=True, slots=True)
class Wired:
    """One combination of wiring and mounting that explains the measured signs."""

    swapped: bool
    mirrored: bool
    left_reversed: bool
    right_reversed: bool
    yaw: float
    """Remaining mounting angle [rad]; 0 where not identifiable."""
    unequal: bool = False
    """Whether it needs, besides, one wheel far larger than the other by the robot file."""

    @property
    def of_wheels(self) -> bool:
        """Whether a counter is wired wrongly."""
        return self.swapped or self.left_reversed or self.right_reversed

    @property
    def mistakes(self) -> float:
        """Cost of the mistakes: -log10 of their prior frequency (`rules.set_up`)."""
        both = self.left_reversed and self.right_reversed
        reversals = rules.BOTH_REVERSED if both else float(self.left_reversed + self.right_reversed)
        askew = float(abs(self.yaw) > rules.ASKEW) + rules.ASKEW_BY * abs(self.yaw)
        unequal = rules.ONE_SIZE_OFF * self.unequal
        return float(self.swapped + self.mirrored) + reversals + askew + unequal

    def names(self) -> tuple[str, ...]:
        """Names of the mistakes, including a mounting angle."""
        made = {
            "wheels_swapped": self.swapped,
            "reference_mirrored": self.mirrored,
            "left_wheel_reversed": self.left_reversed,
            "right_wheel_reversed": self.right_reversed,
            "reference_yaw_offset": abs(self.yaw) > rules.ASKEW,
        }
        return tuple(name for name, there in made.items() if there)


@dataclass(frozen=True, slots=True)
class Setting:
    """Complete set-up: wiring, mounting, and ratios of true to entered sizes."""

    wired: Wired
    left: float
    """Ratio of the true left wheel's travel to that by the robot file."""
    right: float
    base: float
    """Ratio of the base to that of the robot file."""
    arm: complex = 0j
    """Lever arm, ahead + i left of the measured point [m]."""
    ticks: float = 1.0
    """As `SetUpEstimate.ticks`."""

    def numbers(self, track: float) -> tuple[float, float, complex, complex]:
        """Regression coefficients that this set-up predicts: left, right, half base, arm."""
        wired, base = self.wired, self.base * track
        left = -self.left / base if wired.left_reversed else self.left / base
        right = -self.right / base if wired.right_reversed else self.right / base
        axis = cmath.exp(-1j * wired.yaw)
        half_base = 0.5 * base * axis
        if wired.swapped:
            left, right, half_base = -right * self.ticks, -left / self.ticks, -half_base
        return left, right, half_base, self.arm * axis


AS_ENTERED = Setting(Wired(False, False, False, False, 0.0), 1.0, 1.0, 1.0)


def wirings(estimate: SetUpEstimate) -> list[Wired]:
    """All combinations that explain the measured signs, simplest first.

    Only exchanged counters are told as a finding, not a mirrored reference, which looks the same
    where both wheels count alike.
    """
    left_back, right_back = estimate.left < 0.0, estimate.right < 0.0
    yaw = estimate.yaw
    straight = Wired(False, False, left_back, right_back, _angle(yaw))
    # The sort is stable: of equal costs, exchanged wheels come before a mirrored reference.
    crossed = Wired(True, False, not right_back, not left_back, _angle(yaw, math.pi))
    seen = Wired(False, True, not left_back, not right_back, _angle(yaw, math.pi, -1.0))
    both = Wired(True, True, right_back, left_back, _angle(yaw, 0.0, -1.0))
    ways = [
        replace(way, unequal=not is_ordinary(right / left))
        for way in (straight, crossed, seen, both)
        for left, right in [estimate.sizes(way.swapped, 1.0)]
    ]
    ways.sort(key=lambda each: each.mistakes)
    first = next(each for each in ways if not each.mirrored)
    return [first, *(each for each in ways if each is not first)]


def setting_of(estimate: SetUpEstimate, wired: Wired, track: float) -> Setting:
    """Set-up with this wiring; where only yaw is measured, the base is assumed right."""
    base = track if estimate.base is None else estimate.base
    arm = estimate.arm * cmath.exp(1j * wired.yaw)
    sizes = estimate.sizes(wired.swapped, base)
    return Setting(wired, *sizes, base / track, arm, estimate.ticks)


def twins_of(name: str, ways: list[Wired]) -> tuple[str, ...]:
    """Mistakes that replace `name` in other combinations that are nearly as simple."""
    first = ways[0]
    found: list[str] = []
    for other in ways[1:]:
        if other.mistakes - first.mistakes < rules.TWIN_WITHIN and name not in other.names():
            kept = set(first.names())
            found += [each for each in other.names() if each not in kept and each not in found]
    return tuple(found)


def _angle(yaw: float | None, add: float = 0.0, sign: float = 1.0) -> float:
    if yaw is None:
        return 0.0
    return cmath.phase(cmath.exp(1j * sign * (yaw + add)))
