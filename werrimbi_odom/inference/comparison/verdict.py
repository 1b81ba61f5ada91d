# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What of a comparison deserves to be said: by statistics, so that noise is never a finding."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from werrimbi_odom.inference.chances import chi2_above
from werrimbi_odom.inference.comparison.compare import KINDS, Comparison, LegFigures, OfLength
from werrimbi_odom.inference.comparison.groups import DEPENDS_P, Cell
from werrimbi_odom.inference.comparison.systematic import (
    CERTAIN_P,
    CHANNELS,
    NoiseFactor,
    Systematic,
)
from werrimbi_odom.inference.legs.cutting import QUARTER_TURN

FEWEST = 10
"""Legs, below which nothing is judged."""

LARGE, SMALL = 1.5, 0.67
"""NEES, or a factor on the noise, beyond which a covariance is called too small, or too large."""

GROSS = 0.15
"""A share of travel or turn beyond which no calibration, but the set-up, is wrong."""

GROSS_LEG = 0.1
"""A share of the leg that position errors have in the median, for the same."""

_MANY = 30
_ALIKE = 1.3  # times that the intervals of the noise factor, at short legs and long, are apart

Noise = Literal["honest", "too small", "too large", "grows", "comes and goes", "unknown"]
"""The covariance. `grows`: the errors grow faster with the way than the wheels' noise does;
`comes and goes`: slower."""


@dataclass(frozen=True, slots=True)
class Depends:
    """Errors of a channel that go with a variable."""

    channel: str
    """along, sideways, heading, or size (of the errors, whatever their sign)."""
    variable: str
    p_value: float


@dataclass(frozen=True, slots=True)
class Verdict:
    """What is to be said."""

    enough: bool
    """Whether there are legs enough to say anything."""
    systematic: tuple[Systematic, ...]
    """The largest first, compared with what is promised; consequences of another left out."""
    depends: tuple[Depends, ...]
    cells: tuple[Cell, ...]
    noise: Noise
    factor: NoiseFactor
    """On the variance of the wheels' noise, at the longest legs that are many."""
    judged_at: float
    """Their length [m]."""
    gross: bool
    """Whether errors are those of a set-up mistake."""
    few: float
    """Share of the squared errors that the worst twentieth of the legs holds."""
    few_and_bad: tuple[str, ...]
    """Motion types of too few legs to say more than that their errors are larger than promised."""
    off: tuple[str, ...]
    """Motion types whose NEES is too large when their systematic part is taken off."""

    @property
    def mean_is_right(self) -> bool:
        """Whether nothing systematic was found, in travel and turn or in anything else."""
        depends = any(item.channel in CHANNELS for item in self.depends)
        return not self.systematic and not depends and not self.cells

    @property
    def off_at_all(self) -> tuple[str, ...]:
        """Motion types whose errors are larger than promised, few legs or many."""
        return (*self.off, *self.few_and_bad)

    @property
    def good(self) -> bool:
        """Whether the model explains the drives."""
        return self.enough and self.mean_is_right and self.noise == "honest" and not self.off_at_all


def verdict_of(comparison: Comparison) -> Verdict:
    """Judge a comparison."""
    main = comparison.main
    systematic = _primary(main)
    noise, factor, leg = _noise(comparison)
    depends = _depends(comparison, noise)
    enough = main.all.figures.count >= FEWEST
    off = tuple(kind for kind in KINDS if _scatters(main.by_motion[kind]))
    cells = tuple(
        cell for cell in comparison.cells if cell.stands_out and cell.figures.nees > LARGE
    )
    if not enough:
        return Verdict(False, (), (), (), "unknown", factor, leg, False, 0.0, (), ())
    gross = _gross(main, systematic)
    few = _held_by_few(comparison)
    bad = tuple(kind for kind in KINDS if _bad(main.by_motion[kind]))
    return Verdict(True, systematic, depends, cells, noise, factor, leg, gross, few, bad, off)


def _gross(main: OfLength, systematic: tuple[Systematic, ...]) -> bool:
    shares = {("along", "travel"), ("sideways", "travel"), ("heading", "turn")}
    figures = main.all.figures
    return (
        any((part.channel, part.per) in shares and abs(part.value) > GROSS for part in systematic)
        or figures.median_position_m > GROSS_LEG * main.leg
        or any(item.figures.rmse_yaw_rad > GROSS * QUARTER_TURN for item in main.by_motion.values())
    )


def _held_by_few(comparison: Comparison) -> float:
    legs = comparison.legs.errors.chosen(~comparison.legs.outlier)
    deviation = np.sort(legs.deviation)
    count = max(deviation.size // 20, 1)
    return float(deviation[-count:].sum() / max(float(deviation.sum()), 1e-300))


def _primary(main: OfLength) -> tuple[Systematic, ...]:
    """One part for each motion and channel; a heading error bends the path, that is no other."""
    found = [part for part in main.systematic if part.finding]
    largest: dict[tuple[str, str], Systematic] = {}
    for part in sorted(found, key=lambda part: part.size, reverse=True):
        if part.per != "travel × turn":
            largest.setdefault((part.kind, part.channel), part)
    kept = []
    for (kind, channel), part in largest.items():
        heading = largest.get((kind, "heading"))
        length = main.leg
        bent = 0.75 * heading.size * length if heading and kind != "spin" else 0.0
        if channel != "heading" and part.size <= bent:
            continue
        kept.append(part)
    return tuple(sorted(kept, key=lambda part: part.size / part.promised, reverse=True))


def _depends(comparison: Comparison, noise: Noise) -> tuple[Depends, ...]:
    """Dependences of the mean error; of its size only where it is larger than promised."""
    found = [
        Depends(channel, item.name, p_value)
        for item in comparison.variables
        for channel, p_value in item.p_values.items()
        if p_value < DEPENDS_P
    ]
    found.sort(key=lambda item: item.p_value)
    mean = [item for item in found if item.channel in CHANNELS]
    return tuple(mean or (found if noise not in ("honest", "too large") else ()))


def _scatters(figures: LegFigures) -> bool:
    return (
        figures.figures.count >= FEWEST
        and figures.scatter_nees > LARGE
        and figures.noise.low > LARGE
    )


def _bad(figures: LegFigures) -> bool:
    """Whether a few legs err beyond any chance, be it in one direction alone."""
    count, nees = figures.figures.count, figures.figures.nees
    if not 0 < count < FEWEST or not nees > LARGE:
        return False
    return chi2_above(count * nees, count) < CERTAIN_P


def _noise(comparison: Comparison) -> tuple[Noise, NoiseFactor, float]:
    """The wheels' noise, at the longest legs of which there are many, and at the shortest."""
    many = [item for item in comparison.lengths if item.all.figures.count >= _MANY]
    main = comparison.main
    longest = many[-1] if many else main
    longest = longest if longest.leg >= main.leg else main
    factor = longest.all.noise
    if not np.isfinite(factor.value) or longest.all.figures.count < FEWEST:
        return "unknown", factor, longest.leg
    if factor.low > LARGE and longest.all.scatter_nees > LARGE:
        short = main.all.noise
        if factor.low > _ALIKE * short.high:
            return "grows", factor, longest.leg
        if short.low > _ALIKE * factor.high:
            return "comes and goes", factor, longest.leg
        return "too small", factor, longest.leg
    if main.all.noise.low > LARGE and main.all.scatter_nees > LARGE:
        return "comes and goes", main.all.noise, main.leg
    if factor.high < SMALL:
        return "too large", factor, longest.leg
    return "honest", factor, longest.leg
