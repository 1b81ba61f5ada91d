# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Findings of a comparison: only what is statistically significant."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.compare import KINDS, Comparison, LegFigures, OfLength
from werrimbi_odom.inference.comparison.consistency import (
    AtLength,
    Consistency,
    consistency,
    judged_lengths,
    of_all,
    trend_of,
)
from werrimbi_odom.inference.comparison.dependence import Cell
from werrimbi_odom.inference.comparison.leg_errors import LegStatistics
from werrimbi_odom.inference.comparison.systematic import CHANNELS, NoiseFactor, Systematic
from werrimbi_odom.inference.comparison.typical_errors import (
    far_beyond,
    typical_errors,
    usual_error,
)
from werrimbi_odom.inference.distributions import chi2_survival

Noise = Literal["honest", "too small", "too large", "grows", "comes and goes", "unknown"]
"""Result on the covariance. `too small`: by a factor on the wheel noise; `grows`: errors grow
faster with path length than that noise; `comes and goes`: slower."""


@dataclass(frozen=True, slots=True)
class Depends:
    """Dependence of the errors of a channel on a variable."""

    channel: str
    """along, sideways, heading, or size (of the errors, regardless of sign)."""
    variable: str
    p_value: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """Findings."""

    enough: bool
    """Whether there are enough legs for any finding."""
    systematic: tuple[Systematic, ...] = ()
    """The largest relative to the predicted deviation first; consequences of another part left
    out."""
    depends: tuple[Depends, ...] = ()
    cells: tuple[Cell, ...] = ()
    noise: Noise
    factor: NoiseFactor
    """Factor on the variance of the wheel noise, at the longest leg length with many legs."""
    judged_at: float
    """That length [m]."""
    gross: bool = False
    """Whether errors are as large as those of a set-up mistake."""
    too_short: float = 0.0
    """Noise of positions for which the legs are too short to show anything [m]; else 0."""
    few: float = 0.0
    """Share of the squared errors in the worst twentieth of the legs."""
    few_and_bad: tuple[str, ...] = ()
    """Motion types with larger errors than predicted, but too few legs to say more."""
    off: tuple[str, ...] = ()
    """Motion types whose NEES is too large after removing the systematic part."""
    lengths: tuple[AtLength, ...] = ()
    """Consistency at each length with enough legs, ascending."""
    runs: tuple[int, ...] = ()
    """Runs whose own legs show a covariance that is too small, where all legs together do not; of a
    gross error those that hold it, where it is not in all."""

    @property
    def covariance(self) -> Consistency:
        """Whether the covariance is consistent at every length with enough legs."""
        return of_all(self.lengths)

    @property
    def mean_is_right(self) -> bool:
        """Whether no systematic error was found, in travel and turn or in any other variable."""
        depends = any(item.channel in CHANNELS for item in self.depends)
        return not self.systematic and not depends and not self.cells

    @property
    def off_at_all(self) -> tuple[str, ...]:
        """Motion types with larger errors than predicted, of few or many legs."""
        return (*self.off, *self.few_and_bad)

    @property
    def good(self) -> bool:
        """Whether the model explains the drives."""
        honest = self.noise == "honest" and self.covariance == "honest"
        return self.enough and self.mean_is_right and honest and not self.off_at_all


def verdict_of(comparison: Comparison) -> Verdict:
    """Judge a comparison."""
    main = comparison.main
    systematic = _primary(main)
    noise, factor, leg = _noise(comparison)
    depends = _depends(comparison, noise)
    enough = main.all.figures.count >= rules.FEWEST_LEGS
    off = tuple(kind for kind in KINDS if _scatters(main.by_motion[kind]))
    cells = tuple(cell for cell in comparison.cells if cell.stands_out and _too_small(cell.figures))
    too_short = _too_short(comparison)
    if not enough or too_short:
        return Verdict(
            enough=False, noise="unknown", factor=factor, judged_at=leg, too_short=too_short
        )
    gross = _gross(comparison, systematic)
    few = _held_by_few(comparison)
    bad = tuple(kind for kind in KINDS if _bad(main.by_motion[kind]))
    lengths = judged_lengths([item.consistency for item in comparison.lengths])
    return Verdict(
        enough=True,
        systematic=systematic,
        depends=depends,
        cells=cells,
        noise=noise,
        factor=factor,
        judged_at=leg,
        gross=gross,
        few=few,
        few_and_bad=bad,
        off=off,
        lengths=lengths,
        runs=_standing_out(comparison, gross),
    )


def _standing_out(comparison: Comparison, gross: bool) -> tuple[int, ...]:
    """Runs that are unlike the others, by `Verdict.runs`."""
    main = comparison.main
    if gross:
        errors = typical_errors(comparison.legs, len(comparison.runs))
        wrong = rules.WRONG_OF_A_LEG * _length(main)
        if set(comparison.prepared.measures) == {"heading"}:
            wrong = rules.WRONG_SHARE * rules.QUARTER_TURN
        return far_beyond(errors, errors) if usual_error(errors) <= wrong else ()
    if _too_small(main.all.figures):
        return ()
    return tuple(
        index
        for index, item in enumerate(comparison.runs)
        if item.legs.figures.count >= rules.FEWEST_LEGS and _too_small(item.legs.figures)
    )


def _too_small(figures: LegStatistics) -> bool:
    return consistency(figures.nees, figures.freedom) == "too small"


def _too_short(comparison: Comparison) -> float:
    """Position noise for which the chord of a leg gives no heading [m]; else 0."""
    noises = comparison.prepared.noises
    if any(measure != "position" for measure, _ in noises):
        return 0.0
    noise = max((each.sigma_xy for _, each in noises), default=0.0)
    return noise if _length(comparison.main) < rules.SHORTEST_OF_POSITIONS * noise else 0.0


def _length(main: OfLength) -> float:
    """Length of the legs [m]: longer than asked for where poses are rare, as two a drive."""
    return max(main.leg, main.median)


def _gross(comparison: Comparison, systematic: tuple[Systematic, ...]) -> bool:
    """Whether errors are as large as those of a set-up mistake."""
    main = comparison.main
    shares = {("along", "travel"), ("sideways", "travel"), ("heading", "turn")}
    figures = main.all.figures
    if not figures.nees > rules.WRONG_NEES:
        return False
    return (
        any(
            (part.channel, part.per) in shares and abs(part.value) > rules.WRONG_SHARE
            for part in systematic
        )
        or figures.median_position_m > rules.WRONG_OF_A_LEG * _length(main)
        or any(
            item.figures.rmse_yaw_rad > rules.WRONG_SHARE * rules.QUARTER_TURN
            for item in main.by_motion.values()
        )
    )


def _held_by_few(comparison: Comparison) -> float:
    """Share of the squared errors in the worst twentieth of the legs."""
    legs = comparison.legs.errors.chosen(~comparison.legs.outlier)
    deviation = np.sort(legs.deviation)
    count = max(deviation.size // rules.WORST_OF, 1)
    return float(deviation[-count:].sum() / max(float(deviation.sum()), 1e-300))


def _primary(main: OfLength) -> tuple[Systematic, ...]:
    """Largest part per motion and channel, without position errors caused by heading errors."""
    found = [part for part in main.systematic if part.finding]
    largest: dict[tuple[str, str], Systematic] = {}
    for part in sorted(found, key=lambda part: part.size, reverse=True):
        if part.per != "travel × turn":
            largest.setdefault((part.kind, part.channel), part)
    kept = []
    for (kind, channel), part in largest.items():
        heading = largest.get((kind, "heading"))
        length = _length(main)
        bent = rules.BENT_BY_HEADING * heading.size * length if heading and kind != "spin" else 0.0
        if channel != "heading" and part.size <= bent:
            continue
        kept.append(part)
    return tuple(sorted(kept, key=lambda part: part.size / part.promised, reverse=True))


def _depends(comparison: Comparison, noise: Noise) -> tuple[Depends, ...]:
    """Dependences of the mean error; of its size only if that is larger than predicted."""
    found = [
        Depends(channel, item.name, p_value)
        for item in comparison.variables
        for channel, p_value in item.p_values.items()
        if p_value < rules.SURE_OF_LEGS
    ]
    found.sort(key=lambda item: item.p_value)
    mean = [item for item in found if item.channel in CHANNELS]
    return tuple(mean or (found if noise not in ("honest", "too large") else ()))


def _scatters(figures: LegFigures) -> bool:
    known = figures.figures
    return (
        known.count >= rules.FEWEST_LEGS
        and consistency(figures.dispersion_nees, known.freedom) == "too small"
        and figures.noise.low > rules.HONEST_WITHIN
    )


def _bad(figures: LegFigures) -> bool:
    """Whether a few legs have significant errors, even if in one direction only."""
    count, nees = figures.figures.count, figures.figures.nees
    if not 0 < count < rules.FEWEST_LEGS or not nees > rules.HONEST_WITHIN:
        return False
    return chi2_survival(count * nees, count) < rules.SURE_OF_LEGS


def _noise(comparison: Comparison) -> tuple[Noise, NoiseFactor, float]:
    """Verdict on the noise by the dispersion of the legs; `too small` if one factor explains it.

    The factor is estimated at the longest leg length with many legs, or where that shows nothing
    at the length whose NEES is largest, and compared with that at the requested length, and with
    the most that longer legs leave open, as the noise of a wheel adds up along them. The result
    is never too small or too large unless NEES is, at some length.
    """
    many = [item for item in comparison.lengths if item.all.figures.count >= rules.MANY_LEGS]
    main = comparison.main
    longest = many[-1] if many else main
    longest = longest if longest.leg >= main.leg else main
    factor, short = longest.all.noise, main.all.noise
    scatter = [item.consistency_of_dispersion for item in comparison.lengths]
    said = of_all(scatter)
    if said == "unknown":
        return "unknown", factor, longest.leg
    if said == "honest":
        return "honest", factor, longest.leg
    if said == "too large":
        return "too large", factor, longest.leg
    small = [item for item in comparison.lengths if item.consistency_of_dispersion.says == said]
    if longest not in small or not factor.low > rules.HONEST_WITHIN:
        longest = max(small, key=lambda item: item.consistency_of_dispersion.nees)
        factor = longest.all.noise
    if _of_the_reference(scatter, longest.consistency_of_dispersion.nees, factor):
        return "comes and goes", factor, longest.leg
    if factor.determined:
        if factor.low > rules.ALIKE * short.high:
            return "grows" if longest.leg > main.leg else "comes and goes", factor, longest.leg
        beyond = (item.all for item in comparison.lengths if item.leg > longest.leg)
        most = min(
            (each.noise.high for each in beyond if each.figures.count >= rules.FEWEST_LEGS),
            default=np.inf,
        )
        if short.low > rules.ALIKE * factor.high or factor.low > rules.ALIKE * most:
            return "comes and goes", factor, longest.leg
        return "too small", factor, longest.leg
    growing = trend_of(scatter) == "longer" or longest.leg > main.leg
    return "grows" if growing else "comes and goes", factor, longest.leg


def _of_the_reference(scatter: Sequence[AtLength], nees: float, factor: NoiseFactor) -> bool:
    """Whether NEES is too large by the reference's own noise: nearly alike over all lengths.

    `nees`: at the length of `factor`. It is 1 + share * (factor - 1), with the wheels' share.
    """
    judged = judged_lengths(scatter)
    if len(judged) < 2 or not nees - 1.0 < rules.WHEELS_SHARE * (factor.value - 1.0):
        return False
    first, last = judged[0], judged[-1]
    grown = max(last.nees - 1.0, 0.0) / max(first.nees - 1.0, 1e-9)
    return bool(grown <= (last.leg / first.leg) ** rules.WHEELS_GROWTH)
