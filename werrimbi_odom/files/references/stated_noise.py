# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A stated noise that the poses themselves contradict: while the robot stands they scatter more."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.model.pose import Floats, wrap_all

MORE = 3.0
"""Scatter at rest, in stated standard deviations, above which these are wrong. Chosen: of ten poses
a median deviation is known to a quarter, so three times is far beyond chance."""
FEWEST = 10
"""Differences of poses at rest that tell a scatter."""
BESIDE = 0.25
"""Time [s] before and after a pose in which no counter changes where the robot stands."""
MEDIAN_OF_THIRD = 0.6745 * 20.0**0.5
"""Median size of a third difference of values with a standard deviation of 1. Chosen, as a hand or
a wander that moves them evenly adds nothing to it."""


def without_wrong_noise(run: Run) -> Run:
    """Without columns of noise that are far below what the poses show while the wheels stand.

    The noise is fitted then. Of headings alone it stays: what is stated tells that they are no
    gyro's.
    """
    seen = run.reference
    if seen is None or seen.own_axes or not seen.has_position.any():
        return run
    stands = _stands(run.ticks, seen)
    of_xy = _scatter((np.diff(seen.x), np.diff(seen.y)), stands)
    of_yaw = _scatter((wrap_all(np.diff(seen.yaw)),), stands)
    told = []
    if _is_wrong(seen.sigma_xy, of_xy):
        told.append(f"positions scatter by {1e3 * of_xy:.2g} mm")
    if _is_wrong(seen.sigma_yaw, of_yaw):
        told.append(f"headings scatter by {np.degrees(of_yaw):.2g}°")
    if not told:
        return run
    words = (
        f"the reference's {' and its '.join(told)} while the wheels stand, more than {MORE:g} "
        "times what is stated: its noise is estimated instead"
    )
    # What is stated of the other came from the same hand; it is taken only if it is seen to hold.
    holds_xy = of_xy > 0.0 and not _is_wrong(seen.sigma_xy, of_xy)
    holds_yaw = of_yaw > 0.0 and not _is_wrong(seen.sigma_yaw, of_yaw)
    seen = replace(
        seen,
        sigma_xy=seen.sigma_xy if holds_xy else None,
        sigma_yaw=seen.sigma_yaw if holds_yaw else None,
    )
    return replace(run, reference=seen, damage=(*run.damage, words))


def _is_wrong(stated: Floats | None, scatter: float) -> bool:
    if stated is None or not np.isfinite(stated).any():
        return False
    return scatter > MORE * float(np.sqrt(np.nanmean(np.square(stated))))


def _stands(ticks: Ticks, seen: Reference) -> NDArray[np.bool_]:
    """Whether no counter changes about each pose, (m,)."""
    stamps = np.maximum.accumulate(ticks.time)
    changes = (np.diff(ticks.left) != 0) | (np.diff(ticks.right) != 0)
    changed = np.concatenate([[0], np.cumsum(changes)])
    before, after = (
        np.clip(np.searchsorted(stamps, seen.time + side * BESIDE), 0, changed.size - 1)
        for side in (-1.0, 1.0)
    )
    return np.asarray(changed[before] == changed[after])


def _scatter(steps: tuple[Floats, ...], stands: NDArray[np.bool_]) -> float:
    """Standard deviation of single poses at rest; 0 if too few tell."""
    four = stands[:-3] & stands[1:-2] & stands[2:-1] & stands[3:]
    third = np.abs([np.diff(each, 2)[four] for each in steps])
    third = third[np.isfinite(third)]
    if third.size < FEWEST:
        return 0.0
    return float(np.median(third) / MEDIAN_OF_THIRD)
