# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What one drive leaves behind: counters, a reference, and, for judging alone, the truth."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from .engine import TruePath

Floats = NDArray[np.float64]
Counts = NDArray[np.int64]


@dataclass(frozen=True)
class Recording:
    """One recorded drive; n rows of counters, m rows of reference, on the same clock.

    Parameters
    ----------
    name : str
        The manoeuvre's.
    t_s : ndarray, shape (n,)
        When the counters were read [s].
    left_ticks, right_ticks : ndarray of int64, shape (n,)
        Cumulative signed counters, started anywhere, positive forwards.
    reference_t_s, reference_x_m, reference_y_m, reference_yaw_rad : ndarray, shape (m,)
        What the reference measured: the axle's midpoint in the reference's frame; yaw wrapped to
        (-pi, pi], as a motion capture system gives it.
    true_path : TruePath
        The axle's midpoint in the world, free of measuring noise (wheel noise moved the robot, so
        it is in it).
    channels : mapping of str to ndarray of shape (n,)
        Further measured columns of ticks.csv.
    """

    name: str
    t_s: Floats
    left_ticks: Counts
    right_ticks: Counts
    reference_t_s: Floats
    reference_x_m: Floats
    reference_y_m: Floats
    reference_yaw_rad: Floats
    true_path: TruePath
    channels: Mapping[str, Floats] = field(default_factory=dict)
