# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Scatter of parameters from drive to drive, and changes that exceed it."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.changes.change_points import ChangePoints, GroupChange
from werrimbi_odom.inference.changes.information_of_drives import DriveNumbers
from werrimbi_odom.inference.distributions import bonferroni, fisher_survival
from werrimbi_odom.model.pose import Floats

_MEDIAN_CHI2_1 = 0.4549


class Values(NamedTuple):
    """Estimates of s parameters in each of R drives."""

    value: Floats
    """Shape (R, s)."""
    spread: Floats
    """Covariance, (R, s, s)."""


def scatter_of(values: Floats, std: Floats) -> float:
    """Standard deviation from drive to drive, by the median of successive differences."""
    if values.size < rules.SCATTER_DRIVES:
        return 0.0
    squares = np.diff(values) ** 2
    noise = std[1:] ** 2 + std[:-1] ** 2

    def lacking(size: float) -> float:
        return float(np.median(squares / (noise + 2.0 * size**2))) - _MEDIAN_CHI2_1

    # With that much, not even the largest difference exceeds the usual one.
    low, high = 0.0, math.sqrt(float(np.max(squares)) / (2.0 * _MEDIAN_CHI2_1))
    if lacking(low) <= 0.0:
        return 0.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if lacking(middle) > 0.0 else (low, middle)
    return high


def beyond_scatter(
    drives: DriveNumbers, found: ChangePoints, own: Values, scatter: Floats
) -> list[GroupChange]:
    """The changes that exceed the scatter between drives, by Fisher's F.

    The scatter is estimated from few drives, separately for each parameter. So the test uses the
    deviations of a parameter from its level, with the degrees of freedom of the drives that know
    it: others, of another reference, do not show its scatter.
    """
    lasting = []
    for step in found.steps:
        usual, free = 1.0, math.inf
        for name in step.group.numbers:
            number = drives.names.index(name)
            spread = own.spread[:, number, number] + scatter[number] ** 2
            told = spread < rules.SHOWS_NO_SCATTER**2 * spread.min()
            about = (own.value[:, number] - found.levels[:, number]) ** 2 / spread
            moved = sum(each.degrees for each in found.steps if name in each.group.numbers)
            left = int(told.sum()) - 1 - moved
            usual, free = max(usual, float(np.sum(about[told])) / max(left, 1)), min(free, left)
        worth = step.gain / step.degrees / usual
        if (
            free > 0
            and bonferroni(found.tried, fisher_survival(worth, step.degrees, free))
            < rules.SURE_OF_A_CHANGE
        ):
            lasting.append(step)
    return lasting
