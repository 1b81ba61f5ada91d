# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters of a robot: geometry, encoders, noise, physical effects."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Literal, NamedTuple

from werrimbi_odom.model.effect import AppliedEffect

CovarianceOrder = Literal["first", "exact"]
COVARIANCE_ORDERS: tuple[CovarianceOrder, ...] = ("first", "exact")

SIZES = (1e-9, 1e9)
"""Smallest and largest effective radius and track [m]. No robot is near either, not even with
values in a wrong unit. Between them, no computation on 64-bit counts and nanosecond stamps
overflows or divides by zero."""
TRAVELS = (1e-15, 1e9)
"""Smallest and largest travel of a wheel per count [m], for the same reason."""
MOST_NOISE = 1e3
"""Largest noise of a wheel [m^0.5]: an error of a kilometre on a metre."""


class WheelNoise(NamedTuple):
    """Noise parameters of the travel."""

    left: float
    """k_L² [m]."""
    right: float
    """k_R² [m]."""
    track: float
    """[m]"""


@dataclass(frozen=True)
class Robot:
    """A differential-drive robot; names as in diff_drive_controller, units SI.

    Parameters
    ----------
    wheel_separation : float
        Nominal distance between the two wheel contact points [m].
    wheel_radius : float
        Nominal radius of both wheels [m].
    left_ticks_per_revolution, right_ticks_per_revolution : float
        Counts of each encoder per turn of its wheel, gear included.
    wheel_separation_multiplier : float
        C_B of the UMBmark calibration (paper, equation 9).
    left_wheel_radius_multiplier, right_wheel_radius_multiplier : float
        C_L and C_R of the UMBmark calibration (paper, equations 10 and 11).
    encoder_bits : int
        Width at which the counters wrap; 0 if they do not.
    left_wheel_noise, right_wheel_noise : float
        k_L and k_R [m^0.5]: the error of a wheel over a distance s has variance k² s (paper,
        equation 4). The defaults are those of the paper's robot (section 5.2).
    covariance_order : "first" or "exact"
        The paper's first order, or exact moments for large errors.
    effects : tuple of AppliedEffect
        Physical effects of the model, in the order in which they act.
    wheels_a_side : int
        Driven wheels per side; with more than one, they skid when the robot turns.

    Raises
    ------
    ValueError
        If a value, or a product of values (`SIZES`, `TRAVELS`), is not finite or outside its
        physical range; the message names the fields.
    """

    wheel_separation: float
    wheel_radius: float
    left_ticks_per_revolution: float
    right_ticks_per_revolution: float
    wheel_separation_multiplier: float = 1.0
    left_wheel_radius_multiplier: float = 1.0
    right_wheel_radius_multiplier: float = 1.0
    encoder_bits: int = 0
    left_wheel_noise: float = 4.0e-4
    right_wheel_noise: float = 5.8e-4
    covariance_order: CovarianceOrder = "first"
    effects: tuple[AppliedEffect, ...] = ()
    wheels_a_side: int = 1

    def __post_init__(self) -> None:
        for field in fields(self):
            if field.name in ("effects", "covariance_order"):
                continue
            value = getattr(self, field.name)
            if not math.isfinite(value):
                raise ValueError(f"{field.name} must be a finite number, not {value}")
            if field.name.endswith("_noise"):
                if value < 0.0:
                    raise ValueError(f"{field.name} must not be negative, it is {value}")
            elif field.name != "encoder_bits" and value <= 0.0:
                raise ValueError(f"{field.name} must be greater than zero, it is {value}")
        if self.covariance_order not in COVARIANCE_ORDERS:
            raise ValueError(
                f"covariance_order must be first or exact, it is {self.covariance_order}"
            )
        if self.encoder_bits != 0 and not 2 <= self.encoder_bits <= 64:
            raise ValueError(
                f"encoder_bits must be 0 (never wraps) or from 2 to 64, it is {self.encoder_bits}"
            )
        self._check_products()

    def _check_products(self) -> None:
        """Check products: valid values may have an invalid product (1e-300 m has no curvature)."""
        track = "wheel_separation times wheel_separation_multiplier"
        _check_between(track, self.track, SIZES)
        for side in ("left", "right"):
            multiplier = f"{side}_wheel_radius_multiplier"
            radius = f"wheel_radius times {multiplier}"
            _check_between(radius, self.wheel_radius * getattr(self, multiplier), SIZES)
            travel = f"travel for one count ({radius} times 2 pi over {side}_ticks_per_revolution)"
            _check_between(travel, getattr(self, f"{side}_tick"), TRAVELS)
            noise = getattr(self, f"{side}_wheel_noise")
            if noise > MOST_NOISE:
                raise ValueError(
                    f"{side}_wheel_noise must be at most {MOST_NOISE:g} m^0.5, it is {noise}"
                )

    @cached_property
    def track(self) -> float:
        """Effective wheel separation B [m]."""
        return self.wheel_separation * self.wheel_separation_multiplier

    @cached_property
    def wheel_noise(self) -> WheelNoise:
        """Noise parameters of the travel."""
        left, right = self.left_wheel_noise, self.right_wheel_noise
        return WheelNoise(left * left, right * right, self.track)

    @cached_property
    def left_tick(self) -> float:
        """Travel of the left wheel per count [m]."""
        radius = self.wheel_radius * self.left_wheel_radius_multiplier
        return 2.0 * math.pi * radius / self.left_ticks_per_revolution

    @cached_property
    def right_tick(self) -> float:
        """Travel of the right wheel per count [m]."""
        radius = self.wheel_radius * self.right_wheel_radius_multiplier
        return 2.0 * math.pi * radius / self.right_ticks_per_revolution


def _check_between(name: str, value: float, bounds: tuple[float, float]) -> None:
    least, most = bounds
    if not least <= value <= most:
        raise ValueError(f"{name} must be from {least:g} to {most:g} m, it is {value:g} m")
