# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Shapes of a change over the drives (a step, one drive alone, a trend), and the gain of each.

All change points of one kind are scored at once. The gain of a step at drive k is a sum over the
drives from k on, so cumulative sums from the end give it for all k. A year of drives then costs no
more than a week does by trial of one after the other.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.changes.information_of_drives import DriveNumbers
from werrimbi_odom.inference.linear import DETERMINED, ROUNDING, SILENT, Nuisance
from werrimbi_odom.model.pose import Floats

Kind = Literal["step", "alone", "trend"]
"""From a drive on; in one drive and no other; growing with time from a drive on."""


@dataclass(frozen=True, slots=True)
class Shape:
    """Shape of a change over the drives."""

    kind: Kind
    first: int
    """Drive at which it begins."""

    def over(self, time: Floats) -> Floats:
        """Size in each drive, (R,); `time` in any unit."""
        number = np.arange(time.size)
        if self.kind == "step":
            return np.asarray(number >= self.first, dtype=np.float64)
        if self.kind == "alone":
            return np.asarray(number == self.first, dtype=np.float64)
        return np.asarray(np.maximum(time - time[self.first], 0.0))


def first_drives(kind: Kind, count: int) -> range:
    """Drives at which a shape of a kind may begin.

    The first drive alone, and the last alone, equal a step, so they are left out and no two shapes
    are the same.
    """
    if kind == "step":
        return range(1, count)
    return range(1, count - 1) if kind == "alone" else range(max(count - rules.TREND_DRIVES, 0))


class Rows(NamedTuple):
    """The information of drives as rows of a least-squares problem, s rows each."""

    root: Floats
    """Square root of the information, (R, s, s)."""
    seen: Floats
    """Response, (R, s)."""
    time: Floats
    """Time scaled from 0 to 1, (R,)."""

    def column(self, shape: Shape, directions: Floats) -> Floats:
        """Columns of a shape, (R s, d)."""
        size = shape.over(self.time)[:, None, None]
        return np.asarray((size * (self.root @ directions)).reshape(self.seen.size, -1))

    @property
    def constant(self) -> Floats:
        """Columns of all parameters, constant over all drives, (R s, s)."""
        return self.root.reshape(self.seen.size, -1)


def rows_of(drives: DriveNumbers) -> Rows:
    """The least-squares problem with these information matrices."""
    size = np.sqrt(np.einsum("rii->ri", drives.information))
    unit = np.where(size > SILENT, size, 1.0)
    values, axes = np.linalg.eigh(drives.information / (unit[:, :, None] * unit[:, None, :]))
    kept = values > ROUNDING**2 * np.max(values, axis=-1, keepdims=True)
    root = np.sqrt(np.where(kept, values, 0.0))
    back = np.where(kept, 1.0 / np.where(kept, root, 1.0), 0.0)
    turned = axes.swapaxes(-1, -2)
    seen = back * (turned @ (drives.weighted / unit)[..., None])[..., 0]
    span = float(np.ptp(drives.time)) or 1.0
    return Rows(
        root[..., None] * turned * unit[:, None, :], seen, (drives.time - drives.time.min()) / span
    )


class Gains(NamedTuple):
    """Gains of the shapes of one kind, by the drive at which they begin."""

    first: range
    gain: Floats
    degrees: Floats


def gains(rows: Rows, beside: Nuisance, rest: Floats, directions: Floats, kind: Kind) -> Gains:
    """Fall of the squares by each shape of a kind, with all others refitted.

    `beside`: span of the parameters in the model. `rest` (R s,): response with that span projected
    out. `directions` (s, d): directions of the change.
    """
    count = rows.time.size
    columns = rows.root @ directions
    turned = columns.swapaxes(-1, -2)
    score = (turned @ rest.reshape(count, -1, 1))[..., 0]
    common = turned @ beside.basis.reshape(count, columns.shape[1], -1)
    square = turned @ columns
    score, common = (_summed(each, rows.time, kind) for each in (score, common))
    square = _summed_square(square, rows.time, kind)
    free = square - common @ common.swapaxes(-1, -2)
    first = first_drives(kind, count)
    chosen = slice(first.start, first.stop)
    return Gains(first, *_explained(square[chosen], free[chosen], score[chosen]))


def _summed(each: Floats, time: Floats, kind: Kind) -> Floats:
    """Sums over the drives, weighted by the shape that begins at drive k, for all k."""
    if kind == "alone":
        return each
    if kind == "step":
        return _tail(each)
    when = time.reshape(-1, *(1,) * (each.ndim - 1))
    return np.asarray(_tail(when * each) - when * _tail(each))


def _summed_square(each: Floats, time: Floats, kind: Kind) -> Floats:
    """The same with the squares of the weights."""
    if kind != "trend":
        return _summed(each, time, kind)
    when = time[:, None, None]
    plain, once, twice = (_tail(when**power * each) for power in (0, 1, 2))
    return np.asarray(twice - 2.0 * when * once + when**2 * plain)


def _tail(each: Floats) -> Floats:
    return np.asarray(np.cumsum(each[::-1], axis=0)[::-1])


def _explained(square: Floats, free: Floats, score: Floats) -> tuple[Floats, Floats]:
    """Score tests (`linear.score_test_of_products`) of many sets of d columns at once."""
    size = np.sqrt(np.maximum(np.einsum("kii->ki", square), 0.0))
    unit = np.where(size > SILENT, size, np.inf)
    values, axes = np.linalg.eigh(free / (unit[:, :, None] * unit[:, None, :]))
    kept = values > DETERMINED**2
    shares = (axes.swapaxes(-1, -2) @ (score / unit)[..., None])[..., 0]
    gain = np.sum(np.where(kept, shares**2 / np.where(kept, values, 1.0), 0.0), axis=-1)
    return np.asarray(gain), np.asarray(kept.sum(axis=-1), dtype=np.float64)
