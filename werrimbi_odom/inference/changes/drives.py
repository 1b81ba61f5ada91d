# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What each drive tells of some numbers: its information matrix and its score, and nothing more.

To first order the likelihood of a drive is a parabola in the numbers. Its curvature and its slope
answer every question about changes: an estimate for each drive, for any stretch of drives, with any
number free to step at any drive. The drives themselves are not needed again.

Source: sufficient statistics of the linear model; Frisch, Waugh and Lovell for what each drive has
of its own (start headings, phases, a gyro's drift), which is taken off first.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference.linear import nuisance
from werrimbi_odom.model.pose import Floats


@dataclass(frozen=True, slots=True)
class Drives:
    """What R drives tell of s numbers."""

    names: tuple[str, ...]
    """Of the numbers."""
    information: Floats
    """Inverse covariance of the numbers by each drive alone, (R, s, s)."""
    weighted: Floats
    """That information times the drive's own estimate, (R, s)."""
    time: Floats
    """When each drive was, (R,) [s]."""

    @property
    def count(self) -> int:
        """Number of drives."""
        return int(self.time.size)

    def chosen(self, which: NDArray[np.intp]) -> Drives:
        """Some of the drives, in that order."""
        return Drives(self.names, self.information[which], self.weighted[which], self.time[which])

    def with_scatter(self, scatter: Floats) -> Drives:
        """The drives where each number also scatters from drive to drive.

        Parameters
        ----------
        scatter : ndarray, shape (s,)
            Standard deviation of it.
        """
        spread = np.diag(scatter**2)
        shrunk = np.linalg.inv(np.eye(scatter.size) + self.information @ spread)
        information = shrunk @ self.information
        return Drives(
            self.names,
            0.5 * (information + information.swapaxes(-1, -2)),
            (shrunk @ self.weighted[..., None])[..., 0],
            self.time,
        )


def drives_told(
    names: tuple[str, ...],
    values: Floats,
    white: Floats,
    shared: Floats,
    own: Floats,
    run: NDArray[np.intp],
    time: Floats,
) -> Drives:
    """The drives by the whitened innovations of their legs.

    Parameters
    ----------
    values : ndarray, shape (s,)
        Where the numbers stand.
    white : ndarray, shape (n,)
        Innovations there.
    shared : ndarray, shape (n, s)
        Their derivatives in the numbers.
    own : ndarray, shape (n, k)
        The same in all that single drives have of their own.
    run : ndarray, shape (n,)
        Drive of each innovation.
    time : ndarray, shape (R,)
    """
    size = len(names)
    information = np.zeros((time.size, size, size))
    weighted = np.zeros((time.size, size))
    for index in range(time.size):
        here = run == index
        mine = own[here]
        beside = nuisance(mine[:, mine.any(axis=0)])
        slopes, rest = beside.residual(shared[here]), beside.residual(white[here])
        information[index] = slopes.T @ slopes
        weighted[index] = information[index] @ values - slopes.T @ rest
    return Drives(names, information, weighted, time)
