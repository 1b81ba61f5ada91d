# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Fewer points to draw, never fewer to count: what is left out is not seen at any usual size."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

MOST = 4000
"""Points of a figure's lines, about."""

MARKS = 1000
"""Marks of a picture, at the most: each is an element of the page, dear where a point is cheap."""

FEWEST = 20
"""Points of one line of very many, so that it still has a shape."""


def along_path(places: NDArray[np.complex128], most: int = MOST) -> NDArray[np.intp]:
    """Indices of points of a path (x + iy) at about equal distances; ends and gaps are kept.

    A robot that stands still fills a record with one point; equal times would waste them there.
    """
    if places.size <= most:
        return np.arange(places.size)
    step = np.abs(np.diff(places))
    length = np.concatenate([[0.0], np.cumsum(np.nan_to_num(step))])
    wanted = np.linspace(0.0, length[-1], most)
    gaps = np.flatnonzero(~np.isfinite(places))
    edges = gaps[np.concatenate([[True], np.diff(gaps) > 1])] if gaps.size else gaps
    kept = np.concatenate([[0], np.searchsorted(length, wanted), edges, [places.size - 1]])
    return np.unique(np.minimum(kept, places.size - 1)).astype(np.intp)


def spread_and_extremes(values: NDArray[np.float64], most: int = MARKS) -> NDArray[np.intp]:
    """Indices of rows to draw as points: the largest of them in size, and of the rest every few."""
    if values.size <= most:
        return np.arange(values.size)
    size = np.nan_to_num(np.abs(values))
    largest = np.argpartition(size, -most // 4)[-most // 4 :]
    every = np.linspace(0, values.size - 1, most - largest.size).round().astype(np.intp)
    return np.unique(np.concatenate([largest, every])).astype(np.intp)


def small(values: NDArray[np.float64]) -> NDArray[np.float32]:
    """As it is drawn: seven digits are more than a screen has, in half the bytes."""
    return np.asarray(values, dtype=np.float32)
