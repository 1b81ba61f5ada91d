# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Poses whose every step goes along their own heading: added up, as odometry is, not measured.

What observes a robot sits beside the middle of its axle and looks past its course by some
milliradians, and each of its positions errs by itself. A log's own odometry has none of this,
whatever wheels, filter or gyro it was made from.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.run import Reference
from werrimbi_odom.model.pose import Floats, wrap_all

CHORD, FEWEST = 0.25, 8
"""Parts of the path that are compared [m], and how many there must be."""
SIDEWAYS = 3e-4
"""Share of a part that it goes sideways, below which nothing measured it: 75 um in 0.25 m. Of four
drives seen by motion capture, the best has 1.6 mm."""
COARSE = 2e-4
"""Resolution of positions [m] above which so little cannot be seen."""
TURNED = 0.5
"""Turn [rad] that shows where on the robot a position was measured."""


def words_about_own_headings(reference: Reference) -> str:
    """Suspicion about such a reference; "" if it goes sideways as measurements do.

    It is no proof: the true path of a simulator without slip goes along its headings as well, and
    so does a heading that was computed from the positions.
    """
    rows = np.flatnonzero(reference.has_position & reference.has_yaw)
    if rows.size < FEWEST:
        return ""
    place = reference.x[rows] + 1j * reference.y[rows]
    yaw = reference.yaw[rows]
    turns = wrap_all(np.diff(yaw))
    steps = np.diff(place)
    way = np.concatenate([[0.0], np.abs(steps).cumsum()])
    count = int(way[-1] / CHORD)
    resolution = _resolution(np.concatenate([reference.x[rows], reference.y[rows]]))
    if count < FEWEST or np.abs(turns).sum() < TURNED or resolution > COARSE:
        return ""
    ends = np.searchsorted(way, np.linspace(0.0, way[-1], count + 1)).clip(max=way.size - 1)
    # Programs add a step along the heading before it, after it, or midway.
    apart = min(
        _sideways(steps * np.exp(-1j * (yaw[:-1] + share * turns)), ends)
        for share in (0.0, 0.5, 1.0)
    )
    part = float(way[-1] / count)
    if apart > float(np.hypot(SIDEWAYS * part, 0.5 * resolution)):
        return ""
    return (
        f"it goes along its own headings to {1e3 * apart:.2g} mm in {part:.2g} m, closer than "
        "anything measures. If the robot computed it from its wheels, it shows none of their "
        "errors, and what is said by it is not of the wheels; headings that were computed from the "
        "positions are to be left empty (a simulator's true pose without noise is like this too)"
    )


def _sideways(moved: NDArray[np.complex128], ends: NDArray[np.intp]) -> float:
    """Typical way sideways (rms) between some rows [m]."""
    across = np.concatenate([[0.0], np.imag(moved).cumsum()])
    return float(np.sqrt(np.mean(np.diff(across[ends]) ** 2)))


def _resolution(values: Floats) -> float:
    """Smallest step between different values [m]; rounding of floats is none."""
    steps = np.diff(np.unique(np.round(values, 9)))
    return float(steps.min()) if steps.size else 0.0
