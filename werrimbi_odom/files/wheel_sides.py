# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Several wheels on a side, recorded, as one counter: what the node does to each message."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.counter_wraps import differences
from werrimbi_odom.model.pose import Floats


def side_counts(counts: Floats, per_revolution: float, bits: int) -> Floats:
    """Mean counter of a side's wheels, each wrapped and reset on its own.

    Parameters
    ----------
    counts : ndarray, shape (n, wheels)
    per_revolution : float
        Counts of one turn.
    bits : int
        Width at which the counters wrap; 0: they do not.

    Returns
    -------
    ndarray, shape (n,)
        NaN where any wheel's count is not finite. A wheel that alone falls to near zero (its
        driver was restarted) is taken to have rolled like the others; where all of them fall the
        mean falls too, for the encoder model to judge.
    """
    if counts.shape[1] == 1:
        return counts[:, 0]
    known = np.isfinite(counts).all(axis=1)
    mean = np.full(len(counts), np.nan)
    if known.any():
        mean[known] = _counted_on(counts[known], per_revolution, bits).mean(axis=1)
    return mean


def _counted_on(counts: Floats, per_revolution: float, bits: int) -> Floats:
    raw = np.diff(counts, axis=0)
    steps, _ = differences(counts, bits)
    fell = (np.abs(counts[1:]) < per_revolution) & (np.abs(steps) > per_revolution)
    all_fell: NDArray[np.bool_] = np.logical_and.reduce(fell, axis=1)
    some_fell = fell.any(axis=1) & ~all_fell
    if some_fell.any():
        rolled = np.where(fell, np.nan, steps)[some_fell]
        mean = np.nanmean(rolled, axis=1, keepdims=True)
        steps[some_fell] = np.where(np.isnan(rolled), mean, rolled)
    # What the counters hide, summed since all of them last fell: zero, exactly, where nothing odd
    # happened, which sums of steps would not be.
    hidden = np.zeros_like(counts)
    np.cumsum(np.where(all_fell[:, None], 0.0, steps - raw), axis=0, out=hidden[1:])
    since = np.maximum.accumulate(np.append(0, np.arange(1, len(counts)) * all_fell))
    return np.asarray(counts + hidden - hidden[since], dtype=np.float64)
