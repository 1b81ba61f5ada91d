# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Line elements: what a cloud of echoes says of walls, smoothed so that no echo's noise is left.

The nearest neighbour in a raw cloud is the one whose noise agrees with the echo's, and a match with
it seems twice as good as it is. A line through all echoes about has no such choice.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from werrimbi_odom.model.pose import Floats

CELL = 0.05
"""One element a cell of this size [m]."""
REACH = 0.12
"""Echoes within this distance of a cell's make its element [m] ..."""
BEAMS = 3.0
"""... or within so many distances between beams: three neighbours on a side make a line ..."""
MOST_REACH = 0.6
"""... but not beyond this: what is farther away is another thing [m]."""
FEWEST = 4
"""Echoes of an element."""
FLAT = 0.25
"""Standard deviation across an element over that along it, above which it is no line but a corner,
a chair's leg, a person."""


class Elements(NamedTuple):
    """Lines; m of them."""

    centres: Floats
    """Shape (m, 2) [m]."""
    normals: Floats
    """Unit vectors across, shape (m, 2)."""
    reach: Floats
    """How far from its centre an element goes on, shape (m,) [m]."""
    tree: cKDTree
    """Of the cells whose lines they are. Lone cells share all their echoes, and so their centre to
    the last digit: by centres a rounding error would choose among them."""


def line_elements(points: Floats, spacing: Floats) -> Elements | None:
    """Line elements of a cloud; None where it has none.

    Parameters
    ----------
    points : ndarray, shape (n, 2)
        Echoes [m].
    spacing : ndarray, shape (n,)
        Distance between neighbouring beams at each [m].
    """
    if len(points) < FEWEST:
        return None
    origin = points.mean(axis=0)
    cells = np.floor((points - origin) / CELL).astype(np.int64)
    _, cell = np.unique(cells[:, 0] * (1 << 32) + cells[:, 1], return_inverse=True)
    x, y = (points - origin).T
    count = np.bincount(cell).astype(np.float64)
    sums = np.stack([np.bincount(cell, each) for each in (x, y, x * x, x * y, y * y, spacing)])
    reach = np.clip(BEAMS * sums[5] / count, REACH, MOST_REACH)
    middles = (sums[:2] / count).T
    number, x, y, xx, xy, yy = _about(middles, reach, np.vstack([count, sums[:5]]))
    x, y = x / number, y / number
    xx, xy, yy = xx / number - x * x, xy / number - x * y, yy / number - y * y
    half, gap = 0.5 * (xx + yy), np.hypot(0.5 * (xx - yy), xy)
    flat = (number >= FEWEST) & (half - gap < FLAT**2 * (half + gap))
    if not flat.any():
        return None
    along = 0.5 * np.arctan2(2.0 * xy, xx - yy)[flat]
    centres = np.column_stack([x, y])[flat] + origin
    normals = np.column_stack([-np.sin(along), np.cos(along)])
    return Elements(centres, normals, reach[flat], cKDTree(middles[flat] + origin))


def _about(middles: Floats, reach: Floats, sums: Floats) -> Floats:
    """Sums (6, m) over all cells within reach of each."""
    pairs = cKDTree(middles).query_pairs(float(reach.max()), output_type="ndarray")
    one, other = pairs.T
    apart = np.hypot(*(middles[one] - middles[other]).T)
    to: NDArray[np.intp] = np.concatenate([one[apart <= reach[one]], other[apart <= reach[other]]])
    of = np.concatenate([other[apart <= reach[one]], one[apart <= reach[other]]])
    added = [np.bincount(to, row[of], minlength=len(middles)) for row in sums]
    return np.asarray(sums + np.array(added))
