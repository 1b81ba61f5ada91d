# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Selectable parts of the drives, and the legs that belong to each."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference.comparison.compare import KINDS, Comparison
from werrimbi_odom.inference.comparison.leg_errors import LegStatistics, statistics
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.report.comparison.phrases import NAMES

Which = NDArray[np.bool_]

MOST_OF = 0.2
"""Share of the legs shown for a cell of the evidence map: those with the largest errors."""

CHANNELS = {
    "left": "the left wheel's travel",
    "right": "the right wheel's travel",
    "along": "travel along the way",
    "sideways": "sideways motion",
    "heading": "the heading",
}


@dataclass(frozen=True)
class MotionPart:
    """All legs of one type of motion."""

    kind: str

    @property
    def words(self) -> str:
        """Description."""
        return NAMES[self.kind]

    def legs(self, comparison: Comparison) -> Which:
        """Mask of the legs, shape (m,)."""
        return np.asarray(comparison.legs.errors.kind == self.kind)


@dataclass(frozen=True)
class BinPart:
    """Legs within a range of one variable."""

    variable: str
    """Name with unit."""
    low: float
    high: float
    last: bool
    """Whether `high` is included."""
    digits: int = 2
    """Decimals, according to the whole range."""

    @property
    def words(self) -> str:
        """Description."""
        return f"legs with {self.variable.split(' [')[0]} {self.range}"

    @property
    def range(self) -> str:
        """Limits with the unit."""
        name, _, unit = self.variable.partition(" [")
        unit = unit.rstrip("]")
        low, high = self.low, self.high
        if name == "heading":
            low, high, unit = float(np.degrees(low)), float(np.degrees(high)), "°"
            return f"{low:.0f} to {high:.0f}{unit}"
        return f"{low:.{self.digits}f} to {high:.{self.digits}f} {unit}".strip()

    def legs(self, comparison: Comparison) -> Which:
        """Mask of the legs, shape (m,)."""
        values = comparison.legs.variables.get(self.variable)
        if values is None:
            return np.zeros(comparison.legs.run.size, dtype=np.bool_)
        if self.variable.startswith("heading"):
            values = np.mod(values + np.pi, 2.0 * np.pi) - np.pi
        below = values <= self.high if self.last else values < self.high
        return np.asarray((values >= self.low) & below)


@dataclass(frozen=True)
class PlacePart:
    """Legs near a place on the floor."""

    x: float
    y: float
    side: float

    @property
    def words(self) -> str:
        """Description."""
        return f"legs about x {self.x:.1f} m, y {self.y:.1f} m"

    def legs(self, comparison: Comparison) -> Which:
        """Mask of the legs, shape (m,)."""
        legs = comparison.legs
        x, y = 0.5 * (legs.x + legs.end_x), 0.5 * (legs.y + legs.end_y)
        half = 0.5 * self.side
        return np.asarray((np.abs(x - self.x) <= half) & (np.abs(y - self.y) <= half))


@dataclass(frozen=True)
class CellPart:
    """Legs with the largest errors of one channel: a cell of the evidence map."""

    channel: str
    variable: str

    @property
    def words(self) -> str:
        """Description."""
        share = round(100 * MOST_OF)
        return f"the {share} % of legs with the largest error of {CHANNELS[self.channel]}"

    def legs(self, comparison: Comparison) -> Which:
        """Mask of the legs, shape (m,)."""
        size = np.abs(channel_error(comparison, self.channel))
        size[comparison.legs.outlier] = np.nan
        if not np.isfinite(size).any():
            return np.zeros(size.size, dtype=np.bool_)
        return np.asarray(size >= np.nanquantile(size, 1.0 - MOST_OF))


Part = MotionPart | BinPart | PlacePart | CellPart


def channel_error(comparison: Comparison, channel: str) -> Floats:
    """Error of one channel of every leg, shape (m,) [m; heading: rad]."""
    along, sideways, heading = comparison.legs.errors.error.T
    if channel in ("left", "right"):
        half = 0.5 * comparison.model.robot.track * heading
        return np.asarray(along - half if channel == "left" else along + half)
    return np.array({"along": along, "sideways": sideways, "heading": heading}[channel])


def motion_parts(comparison: Comparison) -> list[MotionPart]:
    """The driven types of motion."""
    return [MotionPart(kind) for kind in KINDS if comparison.main.by_motion[kind].figures.count > 0]


def bin_parts(comparison: Comparison) -> dict[str, list[tuple[BinPart, LegStatistics]]]:
    """Bins of each variable, with the statistics of their legs."""
    found = {}
    for item in comparison.variables:
        whole = max(item.bins[-1].high - item.bins[0].low, 1e-9)
        digits = max(0, 1 - math.floor(math.log10(whole)))
        last = len(item.bins) - 1
        found[item.name] = [
            (BinPart(item.name, part.low, part.high, index == last, digits), part.figures)
            for index, part in enumerate(item.bins)
        ]
    return found


def figures_of(comparison: Comparison, which: Which) -> LegStatistics:
    """Statistics over some legs, without those on which the reference jumped."""
    return statistics(comparison.legs.errors.chosen(which & ~comparison.legs.outlier))


def worst(comparison: Comparison, which: Which, most: int = 8) -> list[int]:
    """Indices of the legs with the largest normalised errors, in descending order."""
    legs = comparison.legs
    size = np.where(which & ~legs.outlier, legs.errors.deviation, -np.inf)
    order = np.argsort(-size, kind="stable")[:most]
    return [int(index) for index in order if np.isfinite(size[index])]
