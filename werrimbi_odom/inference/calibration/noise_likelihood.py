# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Likelihood of the wheel noise, given the dispersion of one drive repeated many times."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy import optimize

from werrimbi_odom.errors import InputError
from werrimbi_odom.inference.distributions import CHI2_95, chi2_survival
from werrimbi_odom.model.covariance import (
    CERTAIN,
    carried,
    noise_of_wheel_variances,
    piece_covariance,
    plus,
)
from werrimbi_odom.model.motion import WheelTravel, displacement, wheels_to_body
from werrimbi_odom.model.pose import Floats

_LEAST, _MOST = 1e-8, 1e4  # bounds of k², relative to that of the dispersion


@dataclass(frozen=True, slots=True)
class EndErrorDesign:
    """Covariance model of a drive's end errors (x, y, yaw): k_L² left + k_R² right + given."""

    left: Floats
    """Shape (3, 3), for k_L² = 1 m."""
    right: Floats
    given: Floats
    """Covariance of the reference."""

    def covariance(self, left: float, right: float) -> Floats:
        """Covariance for variances k_L² and k_R² [m]."""
        return left * self.left + right * self.right + self.given

    def information(self, left: float, right: float) -> Floats:
        """Fisher information of (k_L², k_R²) per degree of freedom, shape (2, 2)."""
        inverse = np.linalg.inv(self.covariance(left, right))
        parts = [inverse @ self.left, inverse @ self.right]
        return 0.5 * np.array([[np.trace(one @ two) for two in parts] for one in parts])


def design(
    pieces: Sequence[WheelTravel[float]],
    track: float,
    *,
    sigma_xy: float = 0.0,
    sigma_yaw: float = 0.0,
) -> EndErrorDesign:
    """Covariance model of a drive: closed form of each piece (equation 17), chained (equation 16).

    `pieces`: wheel travel of each piece [m]; the drive starts along the x axis. `track`: B [m].
    `sigma_xy`, `sigma_yaw`: standard deviation of one measured pose [m, rad]. The error of a run is
    the difference of two measured poses, so their variances count twice.
    """
    return EndErrorDesign(
        _chained(pieces, track, 1.0, 0.0),
        _chained(pieces, track, 0.0, 1.0),
        2.0 * np.diag([sigma_xy**2, sigma_xy**2, sigma_yaw**2]),
    )


def _chained(
    pieces: Sequence[WheelTravel[float]], track: float, left: float, right: float
) -> Floats:
    covariance, yaw = CERTAIN, 0.0
    for travel in pieces:
        motion = wheels_to_body(travel, track)
        noise = noise_of_wheel_variances(left * abs(travel.left), right * abs(travel.right), track)
        earlier = carried(covariance, *displacement(motion, yaw))
        covariance = plus(earlier, piece_covariance(motion, noise, yaw))
        yaw += motion.turn
    return covariance.matrix()


@dataclass(frozen=True, slots=True)
class Likelihood:
    """Likelihood of k_L² and k_R² [m] from a sample covariance (the mean costs one degree)."""

    design: EndErrorDesign
    data: Floats
    """Sample covariance of (x, y, yaw), with divisor `freedom`."""
    freedom: int

    def cost(self, left: float, right: float) -> float:
        """Negative log-likelihood without constants."""
        covariance = self.design.covariance(left, right)
        sign, volume = np.linalg.slogdet(covariance)
        if sign <= 0.0:
            return math.inf
        misfit = float(np.trace(np.linalg.solve(covariance, self.data)))
        return 0.5 * self.freedom * (float(volume) + misfit)

    def scale(self) -> float:
        """Maximum-likelihood k² of equal wheels without any reference noise."""
        both = self.design.left + self.design.right
        return float(np.trace(np.linalg.solve(both, self.data))) / len(both)

    def same(self) -> float:
        """Maximum-likelihood k² if both wheels are equal.

        InputError if the reference's noise alone explains the dispersion: within the 95 % interval.
        """
        value = self._likeliest(lambda square: self.cost(square, square))
        if value < 10.0 * _LEAST * self.scale() or not self.interval_of_same(value)[0] > 0.0:
            raise InputError(
                "the runs scatter no more than the reference is said to: nothing is left for the "
                "wheels. Drive further, or give the reference's true noise"
            )
        return value

    def best(self, same: float) -> tuple[float, float]:
        """Maximum-likelihood k_L² and k_R²."""
        found = optimize.minimize(
            lambda logs: self.cost(*(same * np.exp(logs))),
            np.zeros(2),
            method="Nelder-Mead",
            bounds=[(math.log(_LEAST), math.log(_MOST))] * 2,
            options={"xatol": 1e-6, "fatol": 1e-9, "maxfev": 2000},
        )
        left, right = same * np.exp(found.x)
        return float(left), float(right)

    def covariance(self, left: float, right: float) -> Floats:
        """Covariance of the estimates of (k_L², k_R²): the inverse Fisher information.

        Infinite where only the sum is identifiable.
        """
        information = self.freedom * self.design.information(left, right)
        if np.linalg.cond(information) > 1e12:
            return np.full((2, 2), math.inf)
        return np.asarray(np.linalg.inv(information))

    def interval(self, wheel: int, best: tuple[float, float]) -> tuple[float, float]:
        """95 % profile-likelihood interval of k_L² (wheel 0) or k_R² (wheel 1)."""

        def profile(square: float) -> float:
            if wheel == 0:
                return self.cost(square, self._likeliest(lambda right: self.cost(square, right)))
            return self.cost(self._likeliest(lambda left: self.cost(left, square)), square)

        return self._interval(profile, best[wheel], self.cost(*best))

    def interval_of_same(self, same: float) -> tuple[float, float]:
        """95 % likelihood interval of k² if both wheels are equal."""
        return self._interval(lambda square: self.cost(square, square), same, self.cost(same, same))

    def _interval(
        self, cost: Callable[[float], float], best: float, least: float
    ) -> tuple[float, float]:
        """Interval where a cost is within half of chi-squared's 95 % quantile of its least."""
        unit = self.scale()

        def above(log: float) -> float:
            return cost(unit * math.exp(log)) - least - 0.5 * float(CHI2_95[1])

        middle, low, high = math.log(best / unit), math.log(_LEAST), math.log(_MOST)
        bottom = (
            math.exp(optimize.brentq(above, middle, low, xtol=1e-4)) if above(low) > 0.0 else 0.0
        )
        top = math.exp(optimize.brentq(above, middle, high, xtol=1e-4))
        return unit * bottom, unit * top

    def misfit_p(self, left: float, right: float, fitted: int) -> float:
        """p-value of the model with `fitted` free parameters against an unrestricted covariance.

        Likelihood ratio test with Bartlett's correction for few runs.
        """
        volume = float(np.linalg.slogdet(self.data)[1])
        ratio = 2.0 * self.cost(left, right) - self.freedom * (volume + 3.0)
        shrink = 1.0 - 6.5 / (6.0 * self.freedom)
        return chi2_survival(shrink * ratio, 6 - fitted)

    def _likeliest(self, cost: Callable[[float], float]) -> float:
        unit = self.scale()
        found = optimize.minimize_scalar(
            lambda log: cost(unit * math.exp(log)),
            bounds=(math.log(_LEAST), math.log(_MOST)),
            method="bounded",
            options={"xatol": 1e-7},
        )
        return unit * math.exp(float(found.x))
