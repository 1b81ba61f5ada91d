# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The robot as it truly is, and as its maker believes it to be. Both immutable."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Nominal:
    """What the maker believes: the numbers of the robot file and of the robot's own controller.

    Parameters
    ----------
    wheel_separation : float
        Distance between the wheels' contact points [m].
    wheel_radius : float
        Radius of both wheels [m].
    """

    wheel_separation: float = 0.35
    wheel_radius: float = 0.05


@dataclass(frozen=True)
class TrueRobot:
    """A differential-drive robot on two spherical wheels and a frictionless skid behind.

    With the default values the truth is as the maker believes, and the wheels have no noise.

    Parameters
    ----------
    wheel_separation : float
        True distance between the contact points, B [m].
    left_wheel_radius, right_wheel_radius : float
        True rolling radii [m]: a turn of the wheel moves its hub by exactly 2 pi times this.
    left_ticks_per_revolution, right_ticks_per_revolution : float
        Counts of each encoder in one turn of its wheel.
    left_wheel_noise, right_wheel_noise : float
        k_L, k_R [m^0.5]: over a path of length s each wheel's travel errs by a Gaussian of
        variance k^2 |s|, white along the path, the wheels independent (Chong and Kleeman 1997,
        section 4). Zero: none.
    counters_keep_zero : bool
        True: a counter of zero always belongs to the same angle of the wheel (an absolute
        encoder). False: counters start anywhere, as after switching on a real robot.
    mass : float
        Of the whole robot [kg].
    wheels_a_side : int
        That the robot file lists.
    nominal : Nominal
        What the controller and the robot file believe.
    """

    wheel_separation: float = 0.35
    left_wheel_radius: float = 0.05
    right_wheel_radius: float = 0.05
    left_ticks_per_revolution: float = 2000.0
    right_ticks_per_revolution: float = 2000.0
    left_wheel_noise: float = 0.0
    right_wheel_noise: float = 0.0
    counters_keep_zero: bool = False
    mass: float = 10.0
    wheels_a_side: int = 1
    nominal: Nominal = field(default_factory=Nominal)
