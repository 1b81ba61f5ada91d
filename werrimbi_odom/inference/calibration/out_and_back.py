# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Noise of both wheels from drives out and back (paper, section 5.2), by maximum likelihood.

On a straight drive out and back by D each wheel rolls 2 D, and the errors at the end are

    e_yaw = (ε_R - ε_L) / B,   e_x = (ε_R + ε_L) / 2,   e_y = -∫ min(u, 2D - u) d(ε_R - ε_L) / B

with ε_L, ε_R the errors of the wheels' travel, of variance 2 D k_L² and 2 D k_R². So e_yaw and e_y
only determine the sum k_L² + k_R². The difference shows in the covariance of e_x with the other
two: D (k_R² - k_L²) / B with e_yaw. Reversing does not cancel it, as wheel noise does not depend on
the direction of rolling. Turning round at the far end does, since e_x then takes the errors of the
way back with the opposite sign. And e_x is small, about B / 2 times e_yaw: the reference's noise in
x hides the difference long before the sum.

The covariance of the whole path is linear in k_L² and k_R². The mean of the runs, their systematic
error, is estimated too, so the sample covariance has one degree of freedom less.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from scipy import optimize

from werrimbi_odom.errors import InputError
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.calibration.noise_likelihood import EndErrorDesign, Likelihood
from werrimbi_odom.inference.distributions import NORMAL_95, fisher_survival
from werrimbi_odom.model.motion import WheelTravel
from werrimbi_odom.model.pose import Floats


def out_and_back(
    distance: float, track: float, *, turn_round: bool = False
) -> list[WheelTravel[float]]:
    """Pieces of a drive forwards by `distance` and back to the mark [m].

    `distance`, `track`: length of the way out, and wheel base [m]. `turn_round`: false: return
    backwards. True: half a turn at the far end, return forwards, and turn back.
    """
    out = WheelTravel(distance, distance)
    if not turn_round:
        return [out, WheelTravel(-distance, -distance)]
    half_turn = 0.5 * math.pi * track
    return [out, WheelTravel(-half_turn, half_turn), out, WheelTravel(half_turn, -half_turn)]


def pivot_scatter(noise: float, track: float, turns: float) -> float:
    """Heading dispersion after `turns` about one standing wheel, from the other one [rad]."""
    return noise * math.sqrt(2.0 * math.pi * turns / track)


@dataclass(frozen=True, slots=True)
class NoiseInterval:
    """k of one wheel [m^0.5], its standard deviation and its 95 % interval."""

    value: float
    std: float
    low: float
    high: float


@dataclass(frozen=True, slots=True)
class NoiseFit:
    """Wheel noise estimated from the dispersion of the runs."""

    runs: int
    left: NoiseInterval
    right: NoiseInterval
    split_known: bool
    """Whether drive and reference can tell the wheels apart; if not, both have the same k."""
    difference_std: float
    """Standard deviation of k_R - k_L [m^0.5]; infinite where only the sum is identifiable."""
    correlation: float
    """Correlation of the estimates of k_L and k_R; -1 where only the sum is identifiable."""
    by_moments: tuple[float, float]
    """k_L, k_R by the method of moments, as in the paper [m^0.5]."""
    mean: Floats
    """Systematic error (x, y, yaw) [m, m, rad]."""
    mean_std: Floats
    mean_p: float
    """p-value of the mean against zero (Hotelling's test)."""
    data: Floats
    """Sample covariance of the runs, shape (3, 3)."""
    model: Floats
    """Model covariance with k_L and k_R, including the reference's noise."""
    misfit_p: float
    """p-value of the model (likelihood ratio test against an unrestricted covariance)."""
    missing_reference: tuple[float, float] | None
    """If the model does not fit: reference noise (xy [m], yaw [rad]) with which it would."""


def fit_noise(errors: Floats, design: EndErrorDesign) -> NoiseFit:
    """Maximum-likelihood estimate of k_L and k_R.

    `errors` (n, 3): measured minus odometry at the end of each run: x, y [m], yaw [rad]; x along
    the way out. `design`: covariance model of the drive. InputError if there are too few runs,
    their dispersion is no more than the reference's noise, or more than that of any wheels; if the
    headings are in degrees.
    """
    runs = len(errors)
    if runs < rules.LEAST_RUNS:
        raise InputError(
            f"too few runs: {runs} given, at least {rules.LEAST_RUNS} needed; "
            f"{rules.ADVISED_RUNS} tell k to about 13 %, the paper drove 60"
        )
    data = _scatter(errors)
    likelihood = Likelihood(design, data, runs - 1)
    same = likelihood.same()
    best = likelihood.best(same)
    split_known = _split_std(likelihood.covariance(same, same), same) <= rules.UNKNOWN_SPLIT
    left, right = _each(likelihood, best) if split_known else _alike(likelihood, same)
    spread = _of_roots(likelihood.covariance(*(best if split_known else (same, same))), left, right)
    known = bool(np.isfinite(spread).all())
    mean = errors.mean(axis=0)
    squared = float(mean @ np.linalg.solve(data / runs, mean))
    written = (left.value**2, right.value**2)
    misfit_p = likelihood.misfit_p(*written, 2 if split_known else 1)
    if misfit_p < rules.VERY_SURE and _fits_in_degrees(likelihood):
        raise InputError(
            "the headings look like degrees: divided by 57.3 they scatter as wheels make them that "
            "scatter x and y so, and as radians they do not; eyaw_rad is in radians"
        )
    of_both = 0.0 if split_known else math.sqrt(likelihood.interval_of_same(same)[0])
    if max(of_both, left.low, right.low) > rules.STRANGE_NOISE:
        raise InputError(
            f"k would be {left.value:.2g} and {right.value:.2g} m^0.5, and no rolling wheels err "
            f"by more than {rules.STRANGE_NOISE:g}: are the errors in metres and radians, is "
            "the distance that of one way, and were some runs disturbed?"
        )
    return NoiseFit(
        runs=runs,
        left=left,
        right=right,
        split_known=split_known,
        difference_std=_difference_std(spread) if known else math.inf,
        correlation=float(spread[0, 1] / math.sqrt(spread[0, 0] * spread[1, 1])) if known else -1.0,
        by_moments=by_moments(data, design),
        mean=mean,
        mean_std=np.sqrt(np.diag(data) / runs),
        mean_p=fisher_survival(squared * (runs - 3) / (3 * (runs - 1)), 3, runs - 3),
        data=data,
        model=design.covariance(*written),
        misfit_p=misfit_p,
        missing_reference=_missing_reference(likelihood, same)
        if misfit_p < rules.SURE_WHEN_ASKED
        else None,
    )


def _scatter(errors: Floats) -> Floats:
    """Sample covariance of the runs; InputError if it does not show all three errors."""
    flat = np.ptp(errors, axis=0) == 0.0
    if flat.all():
        raise InputError("every run has the same error: without scatter there is no noise to fit")
    if flat.any():
        which = " and ".join(np.array(["x", "y", "yaw"])[flat])
        raise InputError(
            f"every run has the same error in {which}: measure it (to a millimetre, a milliradian) "
            "in each run, as the scatter of all three is needed"
        )
    if np.linalg.matrix_rank(np.corrcoef(errors.T), tol=1e-12) < errors.shape[1]:
        raise InputError(
            "one of the errors in x, y and yaw follows from the other two in all runs: measure "
            "each by itself, more finely, or drive more"
        )
    return np.asarray(np.cov(errors.T))


def _fits_in_degrees(likelihood: Likelihood) -> bool:
    """Whether the model explains the scatter of the runs if their headings are in degrees."""
    scale = np.array([1.0, 1.0, math.radians(1.0)])
    turned = replace(likelihood, data=likelihood.data * np.outer(scale, scale))
    try:
        same = turned.same()
    except InputError:  # then the reference's noise alone would explain it
        return False
    return turned.misfit_p(*turned.best(same), 2) >= rules.SURE_WHEN_ASKED


def _missing_reference(likelihood: Likelihood, same: float) -> tuple[float, float] | None:
    """Reference noise with which the model fits; None if there is none."""
    unit = np.sqrt(np.diag(likelihood.data) / 2.0)

    def with_noise(logs: Floats) -> tuple[Likelihood, float, float]:
        left, right, xy, yaw = np.exp(logs)
        sigma_xy, sigma_yaw = unit[0] * xy, unit[2] * yaw
        given = 2.0 * np.diag([sigma_xy**2, sigma_xy**2, sigma_yaw**2])
        design = replace(likelihood.design, given=given)
        return replace(likelihood, design=design), left * same, right * same

    def cost(logs: Floats) -> float:
        assumed, left, right = with_noise(logs)
        return assumed.cost(left, right)

    start = np.log([0.5, 0.5, 0.5, 0.5])
    bounds = [(-12.0, 3.0)] * 4
    found = optimize.minimize(
        cost, start, method="Nelder-Mead", bounds=bounds, options={"maxfev": 4000}
    ).x
    assumed, left, right = with_noise(found)
    if assumed.misfit_p(left, right, 4) < rules.SURE_WHEN_ASKED:
        return None
    return float(unit[0] * math.exp(found[2])), float(unit[2] * math.exp(found[3]))


def _split_std(covariance: Floats, same: float) -> float:
    """Standard deviation of the relative difference, for equal wheels."""
    slope = np.array([-0.5, 0.5]) / same
    return (
        math.sqrt(float(slope @ covariance @ slope)) if np.isfinite(covariance).all() else math.inf
    )


def _difference_std(covariance: Floats) -> float:
    return math.sqrt(covariance[0, 0] - 2.0 * covariance[0, 1] + covariance[1, 1])


def _of_roots(covariance: Floats, left: NoiseInterval, right: NoiseInterval) -> Floats:
    """Covariance of (k_L, k_R) from that of their squares (delta method)."""
    slope = 0.5 / np.array([left.value, right.value])
    return np.asarray(slope[:, None] * covariance * slope[None, :])


def _each(likelihood: Likelihood, best: tuple[float, float]) -> tuple[NoiseInterval, NoiseInterval]:
    """Estimates of both wheels, with profile-likelihood intervals.

    If a few runs have a small dispersion by chance, k and its Fisher standard deviation are both
    too small: with ten runs, 1.96 of it covered k_L in 87 % of 400 calibrations. So the reported
    deviation is from the upper half of the interval; if the wheel may have no noise at all, it is
    from the value itself at least.
    """
    estimates = []
    for wheel in (0, 1):
        value = math.sqrt(best[wheel])
        low, high = (math.sqrt(end) for end in likelihood.interval(wheel, best))
        std = max(value if low == 0.0 else 0.0, high - value) / NORMAL_95
        estimates.append(NoiseInterval(value, std, low, high))
    return estimates[0], estimates[1]


def _alike(likelihood: Likelihood, same: float) -> tuple[NoiseInterval, NoiseInterval]:
    """Estimates with the sum shared equally: either wheel may have all of it, or none."""
    value = math.sqrt(same)
    high = math.sqrt(2.0 * likelihood.interval_of_same(same)[1])
    estimate = NoiseInterval(value, max(value, high - value) / NORMAL_95, 0.0, high)
    return estimate, estimate


def by_moments(data: Floats, design: EndErrorDesign) -> tuple[float, float]:
    """k_L, k_R by the method of moments: least squares on the normalised covariance entries.

    This is what the paper does by fitting ellipses to scatter plots. It treats all entries as
    equally well known, which they are not.
    """
    scale = 1.0 / np.sqrt(np.outer(np.diag(data), np.diag(data)))
    columns = np.stack([(design.left * scale).ravel(), (design.right * scale).ravel()], axis=-1)
    size = np.linalg.norm(columns, axis=0)
    squares, _ = optimize.nnls(columns / size, ((data - design.given) * scale).ravel())
    left, right = np.sqrt(squares / size)
    return float(left), float(right)
