# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Poses in a frame that is not level: motion capture with y upwards, a camera that looks down.

Their x and y alone would shorten the ways in one direction, as a floor with a grain does.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.pose import Floats

if TYPE_CHECKING:
    from scipy.spatial.transform import Rotation

TILTED = math.radians(2.0)
"""Tilt of the floor in the frame from which poses are levelled: ways are then too short by 0.06 %
in one direction, which is less than effects are seen from."""
FLAT = 0.1
"""Largest distance from the plane over the change of height (rms): heights that drift, or a floor
with ramps, are no tilted plane."""
SPREAD = 0.02
"""Largest distance from the plane over the width of the way (rms): along one line the plane's tilt
about it is not known."""
UPRIGHT = 1.0 / 3.0
"""Largest angle by which the robot leans on the plane (rms), over the tilt: where the heights are
wrong, the robot stands upright in the frame, and leans on the plane as it turns."""
TOLD = "which is not level"
"""Begins the words about poses that were levelled."""
_FEWEST = 20


def levelled(
    where: NDArray[np.float64], turn: NDArray[np.float64]
) -> tuple[Floats, Floats, Floats, str] | None:
    """Poses on the plane in which the robot moved, if that is tilted in their frame; else None.

    `where` (n, 3): positions [m]. `turn` (n, 4): quaternions x, y, z, w; invalid ones are no
    measurement. Result: x, y, yaw, each (n,), NaN where one is missing; then what was done, the
    end of a sentence. Upwards is the side of the plane to which an axis of the robot points.
    """
    from scipy.spatial.transform import Rotation

    squared = (turn**2).sum(axis=1)
    known = np.isfinite(where).all(axis=1) & (squared > 0.5) & (squared < 2.0)
    if (known & where.any(axis=1)).sum() < _FEWEST or np.ptp(where[known, 2]) == 0.0:
        return None
    turned = Rotation.from_quat(turn[known])
    seen = (where[known] != 0.0).any(axis=1)  # a tracker that saw nothing sends zeros
    up = _upwards(where[known][seen], turned[seen])
    if up is None:
        return None
    tilt = math.acos(min(abs(float(up[2])), 1.0))
    level, _ = Rotation.align_vectors([[0.0, 0.0, 1.0]], [up])
    axis = int(abs(turned.inv().apply(up)[:, 0].mean()) > math.sqrt(0.5))  # x, or y if x is upright
    ahead = (level * turned).apply(np.eye(3)[axis])
    x, y, yaw = (np.full(len(where), np.nan) for _ in range(3))
    x[known], y[known] = level.apply(where[known])[:, :2].T
    yaw[known] = np.arctan2(ahead[:, 1], ahead[:, 0])
    words = (
        f"{TOLD}: the robot moved in a plane that is tilted by {math.degrees(tilt):.0f}° in it, "
        "and its poses are taken on that plane"
    )
    return x, y, yaw, words


def _upwards(where: NDArray[np.float64], turned: Rotation) -> NDArray[np.float64] | None:
    """Normal of the plane in which the robot moved, if it is tilted, and known; else None."""
    away = where - where.mean(axis=0)
    _, sizes, axes = np.linalg.svd(away, full_matrices=False)
    normal: NDArray[np.float64] = axes[2]
    tilt = math.acos(min(abs(float(normal[2])), 1.0))
    height = float(np.linalg.norm(away[:, 2]))
    if tilt < TILTED or sizes[2] > min(FLAT * height, SPREAD * sizes[1]):
        return None
    seen = turned.inv().apply(normal)  # in the robot's frame
    mean = seen.mean(axis=0)
    leans = np.arccos(np.clip(seen @ mean / np.linalg.norm(mean), -1.0, 1.0))
    if math.sqrt(float((leans**2).mean())) > UPRIGHT * tilt:
        return None
    side = mean[np.argmax(np.abs(mean))]
    return normal if side > 0.0 else -normal
