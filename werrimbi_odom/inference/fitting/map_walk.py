# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Random walk of the local map with which scans are matched.

Each scan that shows something new joins the map at its estimated pose, with the error of its match,
and an old one leaves it. So the map goes with the mean of its scans' errors, and what is measured
on it walks: by a small share of a match's error at a time, but for good.
"""

from __future__ import annotations

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.prediction import Prediction
from werrimbi_odom.model.covariance import PathNoise, piece_covariance
from werrimbi_odom.model.motion import BodyMotion
from werrimbi_odom.model.pose import Floats


def map_walk(runs: Concatenated, prediction: Prediction, xy: Floats, yaw: Floats) -> Floats:
    """Covariance of each leg by the walk of the map, shape (..., m, 3, 3).

    Parameters
    ----------
    xy, yaw : ndarray, shape (..., m) or (..., 1)
        Variances of a pose on the map [m², rad²].
    """
    none = np.zeros(runs.count)
    worth = prediction.length + np.abs(prediction.turn) / rules.QUARTER_TURN
    renewed = rules.MAP_WALK**2 * worth
    leg = BodyMotion(prediction.along, none, prediction.turn)
    swing = piece_covariance(leg, PathNoise(none, renewed, none), none).matrix()
    flat = renewed[:, None, None] * np.diag([1.0, 1.0, 0.0])
    return np.asarray(xy[..., None, None] * flat + yaw[..., None, None] * swing)
