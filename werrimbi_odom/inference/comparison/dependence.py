# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Dependence of the errors on speed, heading, time and so on, and on the place on the floor."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.leg_errors import LegErrors, LegStatistics, statistics
from werrimbi_odom.inference.comparison.systematic import CHANNELS
from werrimbi_odom.inference.distributions import bonferroni, fisher_survival, student_survival
from werrimbi_odom.model.pose import Floats


@dataclass(frozen=True, slots=True)
class Bin:
    """Legs within a range of one variable."""

    low: float
    high: float
    figures: LegStatistics
    mean: tuple[float, float, float]
    """Mean error along, sideways and in heading [m, m, rad]."""


@dataclass(frozen=True, slots=True)
class ByVariable:
    """Errors binned over one variable."""

    name: str
    """Name with unit."""
    bins: tuple[Bin, ...]
    p_values: Mapping[str, float]
    """p-value of a dependence of the mean errors along, sideways, in heading, and of the `size` of
    errors (Bonferroni over all variables and channels), after removing what is systematic in travel
    and turn."""


@dataclass(frozen=True, slots=True)
class Cell:
    """A square cell of the floor."""

    x: float
    """Centre [m]."""
    y: float
    side: float
    figures: LegStatistics
    p_value: float
    """p-value of larger errors here than elsewhere (Bonferroni)."""

    @property
    def stands_out(self) -> bool:
        """Whether errors are significantly larger here."""
        return self.p_value < rules.SURE_OF_LEGS


def by_variables(
    legs: LegErrors, left: Floats, variables: Mapping[str, Floats]
) -> tuple[ByVariable, ...]:
    """Bins and tests of every variable that varies.

    `legs`: errors of m legs. `left` (m, 3): errors without the systematic part. `variables`: value
    of each leg by name with unit; angles (`heading`) are binned in sectors.
    """
    members = {name: _bins(name, values) for name, values in variables.items()}
    members = {name: found for name, found in members.items() if len(found) > 1}
    tried = max(len(members) * (len(CHANNELS) + 1), 1)
    result = []
    for name, found in members.items():
        p_values = {
            channel: bonferroni(tried, _differ([signs[rows] for _, _, rows in found]))
            for channel, signs in _signals(legs, left).items()
        }
        bins = tuple(
            Bin(low, high, statistics(legs.chosen(rows)), _means(legs.error[rows]))
            for low, high, rows in found
        )
        result.append(ByVariable(name, bins, p_values))
    return tuple(result)


def _signals(legs: LegErrors, left: Floats) -> dict[str, Floats]:
    """Errors normalised by their standard deviation, and the log of their size; shape (m,) each."""
    promised = np.sqrt(np.maximum(np.diagonal(legs.covariance, axis1=1, axis2=2), 1e-300))
    white = left / promised
    signals = {channel: white[:, index] for index, channel in enumerate(CHANNELS)}
    mean = np.nanmean(np.where(np.isfinite(white), white, 0.0) ** 2, axis=1)
    signals["size"] = np.log(mean + 1e-2)
    return signals


def _bins(name: str, values: Floats) -> list[tuple[float, float, NDArray[np.bool_]]]:
    known = np.isfinite(values)
    if known.sum() < 2 * rules.LEGS_IN_A_BIN:
        return []
    if name.startswith("heading"):
        edges = np.linspace(-np.pi, np.pi, rules.SECTORS + 1)
        values = np.mod(values + np.pi, 2.0 * np.pi) - np.pi
    else:
        count = min(rules.BINS, int(known.sum()) // rules.LEGS_IN_A_BIN)
        edges = np.unique(np.quantile(values[known], np.linspace(0.0, 1.0, count + 1)))
        scale = float(np.abs(edges).max())
        edges = edges[np.concatenate([[True], np.diff(edges) > 1e-3 * scale])]
    found = []
    for low, high in pairwise(edges.tolist()):
        rows = known & (values >= low) & ((values < high) | (high == edges[-1]))
        if rows.sum() >= rules.LEGS_IN_A_BIN:
            found.append((float(low), float(high), rows))
    return found


def _differ(groups: list[Floats]) -> float:
    """p-value of a difference in group means: Welch's analysis of variance."""
    groups = [
        known
        for group in groups
        if (known := group[np.isfinite(group)]).size >= rules.LEGS_IN_A_BIN
    ]
    if len(groups) < 2:
        return 1.0
    count = np.array([group.size for group in groups], dtype=np.float64)
    mean = np.array([group.mean() for group in groups])
    variance = np.array([group.var(ddof=1) for group in groups])
    if not (variance > 0.0).all():
        return 1.0
    weight = count / variance
    total = weight.sum()
    between = float(np.sum(weight * (mean - np.sum(weight * mean) / total) ** 2))
    free = len(groups) - 1
    lam = float(np.sum((1.0 - weight / total) ** 2 / (count - 1.0)))
    ratio = between / free / (1.0 + 2.0 * (free - 1) / ((free + 1) ** 2 - 1.0) * lam)
    return fisher_survival(ratio, free, ((free + 1) ** 2 - 1.0) / (3.0 * max(lam, 1e-300)))


def _means(errors: Floats) -> tuple[float, float, float]:
    known = [column[np.isfinite(column)] for column in errors.T]
    along, sideways, heading = (float(part.mean()) if part.size else np.nan for part in known)
    return along, sideways, heading


def cells_of(legs: LegErrors, left: Floats, x: Floats, y: Floats, leg: float) -> tuple[Cell, ...]:
    """Cells of the floor with the legs driven there, lowest p-value first.

    `legs`: errors of m legs. `left` (m, 3): errors without the systematic part. `x`, `y` (m,):
    midpoint of each leg [m]; NaN where not measured. `leg`: length of a leg, the least size of a
    cell [m].
    """
    known = np.isfinite(x) & np.isfinite(y)
    if known.sum() < 2 * rules.LEGS_IN_A_BIN:
        return ()
    extent = max(float(np.ptp(x[known])), float(np.ptp(y[known])))
    side = max(leg, extent / rules.CELLS_ACROSS)
    column = np.where(known, np.floor(np.nan_to_num(x) / side), np.inf)
    row = np.where(known, np.floor(np.nan_to_num(y) / side), np.inf)
    size = _signals(legs, left)["size"]
    places = np.unique(np.stack([column[known], row[known]], axis=-1), axis=0)
    found = []
    for at in places:
        here = known & (column == at[0]) & (row == at[1])
        others = known & ~here
        if here.sum() < rules.LEGS_IN_A_CELL or others.sum() < rules.LEGS_IN_A_BIN:
            continue
        spread = np.sqrt(
            size[here].var(ddof=1) / here.sum() + size[others].var(ddof=1) / others.sum()
        )
        ahead = float((size[here].mean() - size[others].mean()) / max(spread, 1e-12))
        chance = student_survival(ahead, here.sum() - 1)
        found.append(
            Cell(
                float((at[0] + 0.5) * side),
                float((at[1] + 0.5) * side),
                side,
                statistics(legs.chosen(here)),
                bonferroni(len(places), chance),
            )
        )
    return tuple(sorted(found, key=lambda cell: cell.p_value))
