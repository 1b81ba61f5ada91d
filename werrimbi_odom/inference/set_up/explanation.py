# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""From fitted numbers to the simplest set-up that makes them.

Signs of both wheels and the angle of the mount have several explanations each time, equal by
algebra: exchanged wheels turn the robot the wrong way and drive it stern first, so they are both
wheels reversed and a reference turned by 180 degrees; before a mirrored reference the roles are
exchanged once more. The fewest mistakes and the smallest angle win; the others are twins.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from dataclasses import dataclass

from werrimbi_odom.inference.rules import ASKEW, ASKEW_BY, BOTH_REVERSED, TWIN_WITHIN


@dataclass(frozen=True, slots=True)
class Estimate:
    """What was measured of the set-up, free of the robot file's wiring; file metres [m]."""

    left: float
    """Turn for travel of the recorded left wheel, positive when it turns the robot right
    [rad/m]."""
    right: float
    """Turn for travel of the recorded right wheel, positive when it turns the robot left
    [rad/m]."""
    base: float | None
    """Distance of the wheels, in the reference's metres [m]; None where yaw alone was measured."""
    yaw: float | None
    """Angle of the mount for wheels that drive as they turn [rad]; None where it does not show."""
    arm: complex = 0j
    """Ahead + i left of the measured point, turned by -yaw [m]."""


@dataclass(frozen=True, slots=True)
class Wired:
    """One way to wire counters and mount that makes the measured signs."""

    swapped: bool
    mirrored: bool
    left_reversed: bool
    right_reversed: bool
    yaw: float
    """Angle of the mount that is left [rad]; 0 where it does not show."""

    @property
    def mistakes(self) -> float:
        """How many: minus log10 of how often robots are wired so (`rules.set_up`)."""
        both = self.left_reversed and self.right_reversed
        reversals = BOTH_REVERSED if both else float(self.left_reversed + self.right_reversed)
        askew = float(abs(self.yaw) > ASKEW) + ASKEW_BY * abs(self.yaw)
        return float(self.swapped + self.mirrored) + reversals + askew

    def names(self) -> tuple[str, ...]:
        """Of the mistakes, the mount's angle included."""
        return tuple(self._names())

    def _names(self) -> Iterator[str]:
        if self.swapped:
            yield "wheels_swapped"
        if self.mirrored:
            yield "reference_mirrored"
        if self.left_reversed:
            yield "left_wheel_reversed"
        if self.right_reversed:
            yield "right_wheel_reversed"
        if abs(self.yaw) > ASKEW:
            yield "reference_yaw_offset"


@dataclass(frozen=True, slots=True)
class Setting:
    """A whole set-up: wiring, mount, and true over entered sizes."""

    wired: Wired
    left: float
    """Travel of the true left wheel over that by the robot file."""
    right: float
    base: float
    """Base over that of the robot file."""
    arm: complex = 0j
    """Ahead + i left of the measured point [m]."""

    def numbers(self, track: float) -> tuple[float, float, complex, complex]:
        """What regressions of the recorded wheels would give: left, right, half base, arm."""
        wired, base = self.wired, self.base * track
        left = -self.left / base if wired.left_reversed else self.left / base
        right = -self.right / base if wired.right_reversed else self.right / base
        axis = cmath.exp(-1j * wired.yaw)
        half_base = 0.5 * base * axis
        if wired.swapped:
            left, right, half_base = -right, -left, -half_base
        return left, right, half_base, self.arm * axis


AS_ENTERED = Setting(Wired(False, False, False, False, 0.0), 1.0, 1.0, 1.0)


def wirings(estimate: Estimate) -> list[Wired]:
    """All that make the measured signs, the simplest first."""
    left_back, right_back = estimate.left < 0.0, estimate.right < 0.0
    yaw = estimate.yaw
    straight = Wired(False, False, left_back, right_back, _angle(yaw))
    # The first of equals stays first: exchanged wheels before a mirrored reference.
    crossed = Wired(True, False, not right_back, not left_back, _angle(yaw, math.pi))
    seen = Wired(False, True, not left_back, not right_back, _angle(yaw, math.pi, -1.0))
    both = Wired(True, True, right_back, left_back, _angle(yaw, 0.0, -1.0))
    return sorted([straight, crossed, seen, both], key=lambda each: each.mistakes)


def setting_of(estimate: Estimate, wired: Wired, track: float) -> Setting:
    """The set-up with this wiring; with yaw alone the base is taken to be right."""
    base = track if estimate.base is None else estimate.base
    left, right = abs(estimate.left) * base, abs(estimate.right) * base
    if wired.swapped:
        left, right = right, left
    return Setting(wired, left, right, base / track, estimate.arm * cmath.exp(1j * wired.yaw))


def twins_of(name: str, ways: list[Wired]) -> tuple[str, ...]:
    """Mistakes that stand where `name` stands in other wirings that are nearly as simple."""
    first = ways[0]
    found: list[str] = []
    for other in ways[1:]:
        if other.mistakes - first.mistakes < TWIN_WITHIN and name not in other.names():
            kept = set(first.names())
            found += [each for each in other.names() if each not in kept and each not in found]
    return tuple(found)


def _angle(yaw: float | None, add: float = 0.0, sign: float = 1.0) -> float:
    if yaw is None:
        return 0.0
    return cmath.phase(cmath.exp(1j * sign * (yaw + add)))
