# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What poses of scans err: by what their matches say, and by what no match can see."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d

from werrimbi_odom.model.pose import Floats
from werrimbi_odom.scans.limits import CALM, COMMON, COMMON_SURE, FEWEST_POSES, MOVING
from werrimbi_odom.scans.matching import MAD

_BESIDE = 5
"""Scans before and after one that tell its covariance, and how calmly the lidar moves."""
_MEDIAN_OF_TWO = 2.0 * np.log(2.0)
"""Median of chi squared with two degrees of freedom."""


def usual_about(covariances: Floats, piece: NDArray[np.intp]) -> Floats:
    """Covariances (n, 3, 3), each as the mean of those of scans about it, in axes of the piece.

    The residuals of one scan tell its variance to a factor of two only, and who believes the small
    ones weighs poses by chance. What a lidar sees hardly changes in half a second.
    """
    found = np.empty_like(covariances)
    for each in np.unique(piece):
        rows = piece == each
        found[rows] = uniform_filter1d(covariances[rows], 2 * _BESIDE + 1, axis=0, mode="nearest")
    return found


def common_noise(
    poses: Floats, covariances: Floats, piece: NDArray[np.intp]
) -> tuple[float, float]:
    """What poses err beyond the covariances of their matches; see `ScanPath.common`.

    A lidar whose turns begin at an angle that jitters: no match can see it. It turns the heading
    alone. What positions err beyond their matches has the directions of those: along a corridor it
    is not what it is across. Both are read off the fourth differences of five poses, which no
    smooth course has, one by one, of a lidar that moves: at rest, what a driver does to the beams
    is the same in each scan. Starts and stops have such differences too: only the calmest part
    counts, by the poses before and after the five.
    """
    middle = np.arange(_BESIDE, len(poses) - _BESIDE)
    middle = middle[piece[middle - _BESIDE] == piece[middle + _BESIDE]]

    def step(first: int, last: int) -> Floats:
        return np.asarray(poses[middle + last] - poses[middle + first])

    moved = np.abs(step(-_BESIDE, 0)) + np.abs(step(0, _BESIDE))
    moving = (np.hypot(*moved[:, :2].T) > MOVING) | (moved[:, 2] > MOVING)
    if np.count_nonzero(moving) >= FEWEST_POSES:
        middle = middle[moving]
    if len(middle) < FEWEST_POSES:
        return 1.0, 0.0
    changes = step(3, _BESIDE) - step(-_BESIDE, -3)
    of_both = np.column_stack([np.hypot(*changes[:, :2].T), np.abs(changes[:, 2])])
    still, steady = (of_both <= np.quantile(of_both, CALM, axis=0)).T
    rough = step(1, 2) - 3.0 * step(0, 1) + 3.0 * step(-1, 0) - step(-2, -1)
    stated = 70.0 * covariances[middle]  # 1, -4, 6, -4, 1
    place = rough[still, :2]
    solved = np.linalg.solve(stated[still, :2, :2], place[..., None])[..., 0]
    ratios = (
        float(np.median((place * solved).sum(axis=1))) / _MEDIAN_OF_TWO,
        (MAD * float(np.median(np.abs(rough[steady, 2])))) ** 2
        / float(np.median(stated[steady, 2, 2])),
    )
    # A standard deviation by the median of n has a relative error of 1.17 / root n.
    least = [
        max(COMMON, 1.0 + 2.0 * 1.17 * COMMON_SURE / np.sqrt(np.count_nonzero(rows)))
        for rows in (still, steady)
    ]
    wider, more = (
        ratio if ratio > bound else 1.0 for ratio, bound in zip(ratios, least, strict=True)
    )
    return wider, float(np.sqrt((more - 1.0) * np.median(covariances[middle, 2, 2])))
