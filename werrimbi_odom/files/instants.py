# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Instants a step apart, on which drives are looked at."""

from __future__ import annotations

import numpy as np

from werrimbi_odom.model.pose import Floats


def instants(begin: float, end: float, step: float, stamps: Floats, reach: float) -> Floats:
    """Instants a `step` apart from `begin` on to before `end`, near any of the stamps, (n,) [s].

    `stamps`: ascending (m,) [s]. In a silence longer than twice `reach` [s] only so much at either
    side is kept: there a clock may leap by years, once a computer is told the time of day.
    """
    silent = np.flatnonzero(np.diff(stamps) > 2.0 * reach)
    edges = np.stack([stamps[[0, *(silent + 1)]] - reach, stamps[[*silent, -1]] + reach])
    every = int(np.ceil((end - begin) / step))
    rows = np.clip(np.ceil((edges - begin) / step), 0, every).astype(np.intp)
    return np.asarray(begin + step * np.concatenate([np.arange(*both) for both in rows.T]))
