# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Differences of counters that wrap at the end of their range."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.pose import Floats


def wrapped(difference: float, bits: int) -> float:
    """Unwrap a difference of two readings of a counter of `bits` bits (0: it does not wrap)."""
    if bits == 0:
        return difference
    half = 1 << (bits - 1)
    if -half <= difference < half:
        return difference
    return (difference + half) % (2 * half) - half


def differences(
    counts: NDArray[np.float64] | NDArray[np.int64], bits: int
) -> tuple[Floats, NDArray[np.bool_]]:
    """Return unwrapped differences of consecutive counts (n, ...), and where they wrapped."""
    steps = np.diff(counts, axis=0)
    wraps = np.zeros(steps.shape, dtype=np.bool_)
    if bits > 0:
        half = 1 << (bits - 1)
        wraps = (steps < -half) | (steps >= half)
        if wraps.any():
            steps[wraps] = (steps[wraps] + half) % (2 * half) - half
    return steps.astype(np.float64, copy=False), wraps


def running_on(counts: NDArray[np.float64] | NDArray[np.int64], bits: int) -> Floats:
    """Counts (n,) from the first on, without the wraps of a counter of `bits` bits."""
    steps, _ = differences(counts, bits)
    return np.concatenate([counts[:1], counts[0] + np.cumsum(steps)])
