# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""How a number may go over the drives (a step, one drive alone, a trend), and what each explains.

All change points of one kind are scored at once: what a step at drive k would explain is a sum over
the drives from k on, so sums that run from the end give it for all k. A year of drives costs no
more than a week's does by trying one after the other.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from werrimbi_odom.inference.changes.drives import Drives
from werrimbi_odom.inference.linear import DETERMINED, ROUNDING, SILENT, Nuisance
from werrimbi_odom.inference.rules import TREND_DRIVES
from werrimbi_odom.model.pose import Floats

Kind = Literal["step", "alone", "trend"]
"""From a drive on; in one drive and no other; growing with the time from a drive on."""


@dataclass(frozen=True, slots=True)
class Shape:
    """How a number goes over the drives."""

    kind: Kind
    first: int
    """The drive at which it begins."""

    def over(self, time: Floats) -> Floats:
        """Its size in each drive, (R,); `time` in any unit."""
        number = np.arange(time.size)
        if self.kind == "step":
            return np.asarray(number >= self.first, dtype=np.float64)
        if self.kind == "alone":
            return np.asarray(number == self.first, dtype=np.float64)
        return np.asarray(np.maximum(time - time[self.first], 0.0))


def first_drives(kind: Kind, count: int) -> range:
    """Drives at which a shape of a kind may begin.

    The first drive alone, and the last, are a step; so none is the same as another one.
    """
    if kind == "step":
        return range(1, count)
    return range(1, count - 1) if kind == "alone" else range(max(count - TREND_DRIVES, 0))


class Rows(NamedTuple):
    """Drives as rows of least squares: s rows each."""

    root: Floats
    """(R, s, s); its square is the information."""
    seen: Floats
    """(R, s)"""
    time: Floats
    """From 0 to 1, (R,)."""

    def column(self, shape: Shape, directions: Floats) -> Floats:
        """Columns of a shape, (R s, d)."""
        size = shape.over(self.time)[:, None, None]
        return np.asarray((size * (self.root @ directions)).reshape(self.seen.size, -1))

    @property
    def constant(self) -> Floats:
        """Columns of all numbers as they are in all drives, (R s, s)."""
        return self.root.reshape(self.seen.size, -1)


def rows_of(drives: Drives) -> Rows:
    """The least squares that have these information matrices."""
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
        root[..., None] * turned * unit[:, None, :],
        seen,
        (drives.time - drives.time.min()) / span,
    )


class Gains(NamedTuple):
    """What the shapes of one kind would explain, by the drive at which they begin."""

    first: range
    gain: Floats
    degrees: Floats


def gains(rows: Rows, beside: Nuisance, rest: Floats, directions: Floats, kind: Kind) -> Gains:
    """Fall of the squares by each shape of a kind, all others refitted.

    Parameters
    ----------
    beside
        What the model can turn already.
    rest : ndarray, shape (R s,)
        What it leaves.
    directions : ndarray, shape (s, d)
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
    """Sums over the drives of what each has, weighted as a shape that begins at k, for all k."""
    if kind == "alone":
        return each
    if kind == "step":
        return _tail(each)
    when = time.reshape(-1, *(1,) * (each.ndim - 1))
    return np.asarray(_tail(when * each) - when * _tail(each))


def _summed_square(each: Floats, time: Floats, kind: Kind) -> Floats:
    """The same with the weights squared."""
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
