# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Line elements: local line fits to a cloud of echoes, to average out their noise.

The nearest neighbour in a raw cloud tends to be the point with similar noise, so point-to-point
residuals underestimate the noise by about half. A line through all echoes nearby has no such bias.
How far its own echoes scatter about it says what it is worth: those of a far wall scatter more, and
so do those of an element that takes in both sides of a cupboard's edge.
"""

from __future__ import annotations

from collections.abc import Sequence
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
NOISES, WIDEST = 7.5, 0.5
"""Where ranges are poor, within this many of their noises, of which 6.9 make a line (`FLAT`), but
not beyond this [m]. By its beams alone a lidar of 360 and 15 mm + 1 % saw no lines in a room, where
218 beams of the same noise did; with 0.25 m it saw none by 2 %."""
LEAST_REACH = 0.08
"""Least reach [m]: all cells that touch. With less an element chose echoes by their noise."""
ENOUGH = 12.0
"""Echoes that are enough for half of that reach, if they make a line: an element then seldom takes
in both sides of a cupboard's edge. Those that do turn as the robot passes, all in one sense, and
make paths along corridors too long. With half of the reach throughout, a fast robot is lost among
the far walls of a large room."""
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


def reach_of(spacing: Floats, noise: Floats) -> Floats:
    """Distance over which echoes show the direction of a wall [m].

    Their distance from one another, and the noise of their ranges [m], are of one shape.
    """
    by_beams = np.clip(BEAMS * spacing, REACH, MOST_REACH)
    return np.asarray(np.maximum(by_beams, np.minimum(NOISES * noise, WIDEST)))


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
    age: Floats
    """How many key scans ago its echoes joined the map, their mean, shape (m,)."""
    reach: Floats
    """Distance from its centre up to which an element is valid, shape (m,) [m]."""
    tree: cKDTree
    """k-d tree of the elements' cells. Lone cells share all their echoes, and so their centre to
    the last digit: among centres, a rounding error would decide."""


def line_elements(points: Floats, reach: Floats, age: Floats) -> Elements | None:
    """Fit line elements to a cloud of echoes; None if there are none.

    Parameters
    ----------
    points : ndarray, shape (n, 2)
        Echoes [m].
    reach : ndarray, shape (n,)
        Of each echo (`reach_of`) [m].
    age : ndarray, shape (n,)
        How many key scans ago each joined the map.
    """
    if len(points) < FEWEST:
        return None
    origin = points.mean(axis=0)
    cells = np.floor((points - origin) / CELL).astype(np.int64)
    _, cell = np.unique(cells[:, 0] * (1 << 32) + cells[:, 1], return_inverse=True)
    x, y = (points - origin).T
    count = np.bincount(cell).astype(np.float64)
    parts = (x, y, x * x, x * y, y * y, age, reach)
    sums: Floats = np.array([np.bincount(cell, each) for each in parts], dtype=np.float64)
    reach = sums[6] / count
    middles = (sums[:2] / count).T
    half = np.maximum(0.5 * reach, LEAST_REACH)
    whole, near = _about(middles, (reach, half), np.vstack([count, sums[:6]]))
    nearer = _is_flat(near, ENOUGH)
    sums, reach = np.where(nearer, near, whole), np.where(nearer, half, reach)
    flat = nearer | _is_flat(whole, FEWEST)
    if not flat.any():
        return None
    count = sums[0, flat]
    x, y, age = sums[[1, 2, 6]][:, flat] / count
    across, length, along = _shape(sums[:, flat])
    across = np.maximum(across, LEAST_NOISE**2)
    centres = np.column_stack([x, y]) + origin
    normals = np.column_stack([-np.sin(along), np.cos(along)])
    usual = np.median(across)
    across = (count * across + PRIOR * usual) / (count - 2.0 + PRIOR)
    worth, tilt, reach = np.sqrt(usual / across), np.sqrt(across / (count * length)), reach[flat]
    return Elements(centres, normals, worth, tilt, age, reach, _tree(middles[flat] + origin))


def _tree(points: Floats) -> cKDTree:
    """Its import is a sixth of a command's start, and most recordings hold no scans."""
    from scipy.spatial import cKDTree

    return cKDTree(points)


def _about(middles: Floats, reaches: Sequence[Floats], sums: Floats) -> list[Floats]:
    """Sums (7, m) over all cells within each reach of each cell."""
    farthest = max(float(reach.max()) for reach in reaches)
    pairs = _tree(middles).query_pairs(farthest, output_type="ndarray")
    apart = np.tile(np.hypot(*(middles[pairs[:, 0]] - middles[pairs[:, 1]]).T), 2)
    to: NDArray[np.intp] = np.concatenate([pairs[:, 0], pairs[:, 1]])
    of = np.concatenate([pairs[:, 1], pairs[:, 0]])
    found = []
    for reach in reaches:
        near = apart <= reach[to]
        at, by = to[near], of[near]
        added = [np.bincount(at, row[by], minlength=row.size) for row in sums]
        found.append(sums + np.array(added))
    return found


def _shape(sums: Floats) -> tuple[Floats, Floats, Floats]:
    """Variances across and along, and the direction of clouds of given sums (7, m)."""
    x, y, xx, xy, yy = sums[1:6] / sums[0]
    xx, xy, yy = xx - x * x, xy - x * y, yy - y * y
    middle, gap = 0.5 * (xx + yy), np.hypot(0.5 * (xx - yy), xy)
    return middle - gap, middle + gap, 0.5 * np.arctan2(2.0 * xy, xx - yy)


def _is_flat(sums: Floats, fewest: float) -> NDArray[np.bool_]:
    across, along, _ = _shape(sums)
    return np.asarray((sums[0] >= fewest) & (across < FLAT**2 * along))
