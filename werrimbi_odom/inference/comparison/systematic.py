# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Systematic part of the legs' errors, and the size of the wheel noise.

For each motion type, errors along, sideways and in heading are regressed on travel and turn.
Standard errors are heteroscedasticity-consistent (HC3), from the dispersion of the legs and not
from the predicted covariance, which may itself be wrong. The remaining dispersion tells by which
factor the stated wheel noise is off.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.leg_errors import LegErrors, root_mean_square
from werrimbi_odom.inference.distributions import MEDIAN_TO_SIGMA, student_survival
from werrimbi_odom.model.pose import Floats

CHANNELS = ("along", "sideways", "heading")

TERMS: dict[str, tuple[tuple[str, ...], tuple[str, ...], tuple[str, ...]]] = {
    "line": (("travel",), ("travel",), ("travel",)),
    "arc": (("travel",), ("travel", "travel × turn"), ("turn", "travel")),
    "spin": (("turn",), ("turn",), ("turn", "size of turn")),
}
"""Regressors of the error of each channel, by motion type."""
OF_A_POINT = ("travel", "sine of turn")
"""Regressors of the sideways error in arcs where a heading error is not the better cause: a point
ahead of the axle goes aside as the robot turns, whether it drives forward or back."""


@dataclass(frozen=True, slots=True)
class Systematic:
    """Part of one channel's error that is proportional to one variable, over one motion type."""

    kind: str
    channel: str
    per: str
    """travel [m], turn [rad], size of turn [rad], travel × turn [m·rad], sine of turn."""
    value: float
    """Measured minus predicted, per unit of the variable [m or rad]."""
    std: float
    p_value: float
    size: float
    """Root mean square of this part over the legs [m or rad]."""
    promised: float
    """Root mean square of the predicted standard deviation of the channel [m or rad]."""

    common: bool
    """Whether most legs show it, and not only a few outliers."""

    @property
    def finding(self) -> bool:
        """Whether it is significant, common and relevant."""
        worth = self.size >= rules.WORTH_SAYING * self.promised
        return self.common and worth and self.p_value < rules.SURE_OF_LEGS


class NoiseFactor(NamedTuple):
    """Ratio of true to stated variance of the wheel noise (a factor on k²)."""

    value: float
    low: float
    """99.9 % likelihood interval."""
    high: float

    @property
    def determined(self) -> bool:
        """Whether the interval is narrower than `NOISE_FACTOR_TOLD`."""
        return bool(
            np.isfinite(self.value) and self.high < rules.NOISE_FACTOR_TOLD * max(self.low, 1e-12)
        )


UNDETERMINED = NoiseFactor(np.nan, 0.0, np.inf)


def systematic_parts(legs: LegErrors) -> tuple[tuple[Systematic, ...], Floats]:
    """All systematic parts, and the errors without them; shape (m, 3).

    Parts that are no finding stay in the errors, as removing them would remove chance.
    """
    found: list[Systematic] = []
    left = legs.error.copy()
    for kind, channels in TERMS.items():
        for channel, names in enumerate(channels):
            rows = np.flatnonzero((legs.kind == kind) & np.isfinite(legs.error[:, channel]))
            if rows.size < rules.LEGS_OF_A_PART + len(names):
                continue
            parts, predicted = _regressed_on(legs, rows, channel, kind, names)
            if (kind, CHANNELS[channel]) == ("arc", "sideways"):
                of_point = _regressed_on(legs, rows, channel, kind, OF_A_POINT)
                if _as_likely(legs.error[rows, channel], of_point[1], predicted):
                    parts, predicted = of_point
            found += parts
            if any(part.finding for part in parts):
                left[rows, channel] -= predicted
    return tuple(found), left


def _as_likely(error: Floats, one: Floats, other: Floats) -> bool:
    """Whether errors go with one prediction, unless very strong evidence is for the other."""
    left = [max(float(np.sum((error - each) ** 2)), 1e-300) for each in (one, other)]
    return bool(error.size * np.log(left[0] / left[1]) < rules.RIVAL)


def _regressed_on(
    legs: LegErrors, rows: np.ndarray, channel: int, kind: str, names: tuple[str, ...]
) -> tuple[list[Systematic], Floats]:
    """Regress one channel's errors of some legs on the given variables."""
    variables = {
        "travel": legs.along,
        "turn": legs.turn,
        "size of turn": np.abs(legs.turn),
        "travel × turn": legs.along * legs.turn,
        "sine of turn": np.sin(legs.turn),
    }
    design = np.stack([variables[name][rows] for name in names], axis=-1)
    size = np.sqrt(np.sum(design**2, axis=0))
    design = design / np.where(size > 0.0, size, 1.0)
    error = legs.error[rows, channel]
    # HC3: MacKinnon and White, J. Econometrics 29 (1985).
    inverse = np.linalg.pinv(design.T @ design, rcond=1e-3, hermitian=True)
    slopes = inverse @ design.T @ error
    predicted = design @ slopes
    hat = np.einsum("ij,jk,ik->i", design, inverse, design)
    scaled = design * ((error - predicted) / np.maximum(1.0 - hat, 0.05))[:, None]
    std = np.sqrt(np.maximum(np.diag(inverse @ (scaled.T @ scaled) @ inverse), 0.0))
    of_most = _huber_slopes(design, error, slopes)
    promised = float(np.sqrt(np.mean(legs.covariance[rows, channel, channel])))
    parts = []
    for column, name in enumerate(names):
        if size[column] == 0.0:
            continue
        ratio = slopes[column] / std[column] if std[column] > 0.0 else np.inf
        parts.append(
            Systematic(
                kind,
                CHANNELS[channel],
                name,
                float(slopes[column] / size[column]),
                float(std[column] / size[column]),
                2.0 * student_survival(abs(ratio), rows.size - len(names)),
                root_mean_square(design[:, column] * slopes[column]),
                promised,
                bool(
                    of_most[column] * np.sign(slopes[column]) >= rules.OF_MOST * abs(slopes[column])
                ),
            )
        )
    return parts, predicted


_HUBER = 1.5  # Huber's threshold, in standard deviations


def _huber_slopes(design: Floats, error: Floats, slopes: Floats) -> Floats:
    """Robust slopes: Huber's M-estimate, by iteratively reweighted least squares."""
    for _ in range(20):
        left = np.abs(error - design @ slopes)
        scale = _HUBER * MEDIAN_TO_SIGMA * float(np.median(left))
        weight = scale / np.maximum(left, max(scale, 1e-300))
        root = np.sqrt(weight)
        slopes = np.asarray(
            np.linalg.lstsq(design * root[:, None], error * root, rcond=1e-2)[0], dtype=np.float64
        )
    return slopes


_FACTORS = np.logspace(-4.0, 8.0, 241)
_SAME = 10.828  # of minus two log-likelihood: a 99.9 % interval, as a dozen are examined
_BLOCK = 512  # legs per block, which fits the cache


def noise_factors(
    errors: Floats, covariance: Floats, wheels: Floats, groups: NDArray[np.bool_]
) -> list[NoiseFactor]:
    """Maximum-likelihood factors on the wheel part of the covariance.

    `errors` (m, 3): errors of legs without the systematic part; NaN where not measured.
    `covariance`, `wheels` (m, 3, 3): predicted covariance, and its part from the wheel noise.
    `groups` (g, m): for each factor, a mask of its legs.
    """
    known = np.isfinite(errors)
    told = known.any(axis=1) & groups.any(axis=0)
    groups = groups[:, told]
    noisy = np.any(wheels[told] > 0.0, axis=(1, 2))
    if noisy.size < rules.LEGS_OF_A_PART or not noisy.any():
        return [UNDETERMINED] * groups.shape[0]
    sizes, squares = _by_wheels(known[told], errors[told], covariance[told], wheels[told])
    cost = np.zeros((_FACTORS.size, groups.shape[0]))
    for begin in range(0, sizes.shape[0], _BLOCK):
        block = slice(begin, begin + _BLOCK)
        variances = [1.0 + np.outer(_FACTORS, axis) for axis in sizes[block].T]
        of_leg = np.log(variances[0] * variances[1] * variances[2])
        for square, variance in zip(squares[block].T, variances, strict=True):
            of_leg += square / variance
        cost += of_leg @ groups[:, block].T.astype(np.float64)
    return [
        _likeliest(own)
        if which.sum() >= rules.LEGS_OF_A_PART and noisy[which].any()
        else UNDETERMINED
        for own, which in zip(cost.T, groups, strict=True)
    ]


def _by_wheels(
    known: NDArray[np.bool_], errors: Floats, covariance: Floats, wheels: Floats
) -> tuple[Floats, Floats]:
    """Generalised eigenvalues (m, 3) of the wheel part, and the squared errors along these axes."""
    both = known[:, :, None] & known[:, None, :]
    rest = np.where(both, covariance - wheels, 0.0)
    rest = rest + np.where(known, 0.0, 1.0)[:, :, None] * np.eye(3)
    factor = np.linalg.cholesky(rest)
    white = np.linalg.solve(factor, np.where(known, errors, 0.0)[..., None])[..., 0]
    own = np.linalg.solve(factor, np.where(both, wheels, 0.0))
    own = np.linalg.solve(factor, own.transpose(0, 2, 1))
    sizes, axes = np.linalg.eigh(0.5 * (own + own.transpose(0, 2, 1)))
    return np.maximum(sizes, 0.0), np.einsum("mji,mj->mi", axes, white) ** 2


def _likeliest(cost: Floats) -> NoiseFactor:
    """Factor of least cost, with its likelihood interval."""
    best = int(np.argmin(cost))
    near = _FACTORS[cost <= cost[best] + _SAME]
    low = 0.0 if near[0] == _FACTORS[0] else float(near[0])
    high = np.inf if near[-1] == _FACTORS[-1] else float(near[-1])
    return NoiseFactor(float(_FACTORS[best]), low, high)
