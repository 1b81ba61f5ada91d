# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Line elements: local line fits to a cloud of echoes, to average out their noise.

The nearest neighbour in a raw cloud tends to be the point with similar noise, so point-to-point
residuals underestimate the noise by about half. A line through all echoes nearby has no such bias.
How far its own echoes scatter about it says what it is worth: those of a far wall scatter more, and
so do those of an element that takes in both sides of a cupboard's edge.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.pose import Floats

if TYPE_CHECKING:
    from scipy.spatial import cKDTree

CELL = 0.05
"""Grid cell with one element each [m]."""
REACH = 0.12
"""Echoes within this distance of a cell's mean are fitted by its element [m] ..."""
BEAMS = 3.0
"""... or within this many distances between beams: three neighbours on each side make a line ..."""
MOST_REACH = 0.25
"""... but not beyond this, where another object begins [m]. With 0.6 elements of far walls took in
the cupboards before them: in a simulated room of 9 m the path walked by 3.6 mm in 8 m, in place of
2.3 mm, and its headings by 2.1 mrad, in place of 1.3 (radius_drift of a sound robot)."""
FEWEST = 4
"""Least number of echoes of an element."""
FLAT = 0.25
"""Largest ratio of the standard deviations across and along an element: above it, it is a corner, a
chair's leg or a person."""
PRIOR = 10.0
"""Echoes that the usual scatter counts as, in an element's own. By four echoes alone it is told to
half. With 3 to 30 poses err alike, but with 3 those of a brisk robot by a tenth more than
stated."""
LEAST_NOISE = 1e-3
"""Least noise of ranges [m]: no lidar is better."""


class Elements(NamedTuple):
    """Line elements; m of them."""

    centres: Floats
    """Shape (m, 2) [m]."""
    normals: Floats
    """Unit normals, shape (m, 2)."""
    worth: Floats
    """Usual scatter of echoes about their elements over that of its own, shape (m,)."""
    tilt: Floats
    """Standard deviation of its direction, by the noise of its echoes, shape (m,) [rad]."""
    reach: Floats
    """Distance from its centre up to which an element is valid, shape (m,) [m]."""
    tree: cKDTree
    """k-d tree of the elements' cells. Lone cells share all their echoes, and so their centre to
    the last digit: among centres, a rounding error would decide."""


def line_elements(points: Floats, spacing: Floats) -> Elements | None:
    """Fit line elements to a cloud of echoes; None if there are none.

    Parameters
    ----------
    points : ndarray, shape (n, 2)
        Echoes [m].
    spacing : ndarray, shape (n,)
        Distance between neighbouring beams at each echo [m].
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
    count, across = number[flat], np.maximum((half - gap)[flat], LEAST_NOISE**2)
    usual = np.median(across)
    across = (count * across + PRIOR * usual) / (count - 2.0 + PRIOR)
    worth, tilt = np.sqrt(usual / across), np.sqrt(across / (count * (half + gap)[flat]))
    return Elements(centres, normals, worth, tilt, reach[flat], _tree(middles[flat] + origin))


def _tree(points: Floats) -> cKDTree:
    """Its import is a sixth of a command's start, and most recordings hold no scans."""
    from scipy.spatial import cKDTree

    return cKDTree(points)


def _about(middles: Floats, reach: Floats, sums: Floats) -> Floats:
    """Sums over all cells within reach of each cell, shape (6, m)."""
    pairs = _tree(middles).query_pairs(float(reach.max()), output_type="ndarray")
    one, other = pairs.T
    apart = np.hypot(*(middles[one] - middles[other]).T)
    to: NDArray[np.intp] = np.concatenate([one[apart <= reach[one]], other[apart <= reach[other]]])
    of = np.concatenate([other[apart <= reach[one]], one[apart <= reach[other]]])
    added = [np.bincount(to, row[of], minlength=len(middles)) for row in sums]
    return np.asarray(sums + np.array(added))
