# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The true robot, and its nominal parameters. Both immutable."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Nominal:
    """Nominal parameters: those of the robot file and of the robot's own controller."""

    wheel_separation: float = 0.35
    """Distance between the wheels' contact points [m]."""
    wheel_radius: float = 0.05
    """Radius of both wheels [m]."""


@dataclass(frozen=True)
class TrueRobot:
    """True parameters of a differential-drive robot on two spherical wheels and a skid.

    By default they are equal to the nominal ones, and the wheels have no noise.
    """

    wheel_separation: float = 0.35
    """True distance between the contact points, B [m]."""
    left_wheel_radius: float = 0.05
    right_wheel_radius: float = 0.05
    """True rolling radii [m]: one revolution moves the hub by exactly 2 pi times this."""
    left_ticks_per_revolution: float = 2000.0
    right_ticks_per_revolution: float = 2000.0
    """Counts of each encoder per revolution of its wheel."""
    left_wheel_noise: float = 0.0
    right_wheel_noise: float = 0.0
    """k_L, k_R [m^0.5]: over a path of length s the travel of each wheel has a Gaussian error of
    variance k^2 |s|, white along the path and independent between wheels (Chong and Kleeman 1997,
    section 4). Zero for none."""
    counters_keep_zero: bool = False
    """True: counter zero is always at the same wheel angle (absolute encoder). False: counters have
    random start values, as after a real robot is switched on."""
    mass: float = 10.0
    """Total mass [kg]."""
    wheels_a_side: int = 1
    """Number of wheels per side in the robot file."""
    nominal: Nominal = field(default_factory=Nominal)
    """Parameters of the controller and of the robot file."""
