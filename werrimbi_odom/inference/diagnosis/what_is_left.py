# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What is left with everything found, beside the reference's own noise: its size and its whiteness.

A significant dependence may be a small part of what is left. Whether any law could lower the error
by much is another question: not where the reference's own noise, which its small differences tell
without any model, is as large by itself.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.judged_legs import Legs
from werrimbi_odom.inference.comparison.prepared_runs import PreparedRuns
from werrimbi_odom.inference.comparison.systematic import CHANNELS
from werrimbi_odom.inference.diagnosis.paired_comparison import Unit, error_of, promised_of
from werrimbi_odom.inference.distributions import chi2_survival, fisher_survival
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.whitened_innovations import Point, unexpected


@dataclass(frozen=True, slots=True)
class LeftOfLegs:
    """Root mean square error of legs without an abrupt event, and what the reference makes of it.

    [m] or [rad]
    """

    error: float
    reference: float
    """By the reference's own noise and the rounding of the counts."""

    @property
    def is_noise(self) -> bool:
        """Whether the reference's own noise is the error, but for a little."""
        return self.error <= rules.OWN_NOISE * self.reference


@dataclass(frozen=True, slots=True)
class NeighbourCorrelation:
    """Correlation of the innovations of neighbouring legs of the fit in one channel."""

    correlation: float
    p_value: float


@dataclass(frozen=True, slots=True)
class WhatIsLeft:
    """The error with everything found, of fitted and of held-out drives."""

    train: LeftOfLegs
    holdout: LeftOfLegs
    unit: Unit
    neighbours: Mapping[str, NeighbourCorrelation]
    """By channel that was measured: independent innovations have no correlation."""

    @property
    def is_noise(self) -> bool:
        """Whether the reference's own noise is what is left, in all drives."""
        return self.train.is_noise and self.holdout.is_noise

    @property
    def not_white(self) -> dict[str, float]:
        """Correlations beyond chance, by channel."""
        return _beyond_chance(self.neighbours)


def what_is_left(
    train: tuple[PreparedRuns, Legs, Legs],
    holdout: tuple[PreparedRuns, Legs, Legs],
    unit: Unit,
    runs: Concatenated,
    point: Point,
) -> WhatIsLeft | None:
    """Compare what is left with the reference's noise; None where that or the legs are too few.

    `train`, `holdout`: drives and their legs, judged with everything found, and again with the
    wander of the reference that this leaves, where one wanders. `runs`, `point`: the
    fitted drives in the legs of the fit, and the fit.
    """
    if not all(_noise_is_known(prepared) for prepared, *_ in (train, holdout)):
        return None
    found = []
    for _, legs, promising in (train, holdout):
        quiet = legs.quiet
        if np.count_nonzero(~quiet.outlier) < rules.FEWEST_LEGS:
            return None
        found.append(
            LeftOfLegs(error_of(quiet, unit), promised_of(promising.quiet, unit, wheels=False))
        )
    return WhatIsLeft(found[0], found[1], unit, _neighbours(runs, point))


def neighbours_are_alike(runs: Concatenated, point: Point) -> bool:
    """Whether neighbouring legs of a fit err alike in a channel, beyond chance."""
    return any(size > 0.0 for size in _beyond_chance(_neighbours(runs, point)).values())


def lasts_along_alone(runs: Concatenated, point: Point) -> float | None:
    """How much more errors add up along the path than to the side, if beyond chance; else None.

    The error of a reference has no direction along the path: what makes its errors last from leg to
    leg along it does so to the side too. So whitened innovations are added up over stretches of the
    drives: the variance of the sums, in that of single legs, is held against the same of those to
    the side (Fisher's F).
    """
    found = unexpected(runs, point)
    white = found.whitened()[:, :2]
    told = np.asarray(found.known[:, :2].all(axis=1))
    each = max(int(np.count_nonzero(told)) // rules.STRETCHES, 2)
    sums = []
    for first, last in zip(runs.legs[:-1], runs.legs[1:], strict=True):
        own = white[first:last][told[first:last]]
        whole = own.shape[0] // each
        sums.append(own[: whole * each].reshape(whole, each, 2).sum(axis=1))
    single = np.sum(white[told] ** 2, axis=0)
    together = np.concatenate(sums)
    count = together.shape[0]
    if count < 2 or not single.all():
        return None
    along, sideways = np.sum(together**2, axis=0) / single
    ratio = float(along / sideways)
    sure = fisher_survival(ratio, count, count) < rules.SURE_WHEN_ASKED
    return ratio if sure and ratio > rules.LASTS_ALONG else None


def _beyond_chance(neighbours: Mapping[str, NeighbourCorrelation]) -> dict[str, float]:
    sure = rules.SURE_WHEN_ASKED / max(len(neighbours), 1)
    return {name: it.correlation for name, it in neighbours.items() if it.p_value < sure}


def _noise_is_known(prepared: PreparedRuns) -> bool:
    """Whether the noise of all that is measured is estimated, stated or given, and not assumed."""
    return all(
        (group.measure == "heading" or group.own.freedom[0] > 0.0)
        and (group.measure == "position" or group.own.freedom[1] > 0.0)
        for group in prepared.groups
    )


def _neighbours(runs: Concatenated, point: Point) -> dict[str, NeighbourCorrelation]:
    found = unexpected(runs, point)
    white, together = found.whitened(), runs.run_of_leg[1:] == runs.run_of_leg[:-1]
    of_channels = {}
    for column, channel in enumerate(CHANNELS):
        known = found.known[:, column]
        pairs = together & known[1:] & known[:-1]
        one, other = white[:-1, column][pairs], white[1:, column][pairs]
        scale = float(np.sqrt(np.sum(one**2) * np.sum(other**2)))
        if scale > 0.0:
            size = float(np.sum(one * other)) / scale
            p_value = chi2_survival(one.size * size**2, 1.0)
            of_channels[channel] = NeighbourCorrelation(size, p_value)
    return of_channels
