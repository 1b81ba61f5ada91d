# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Random walks of a reference over legs: of increments, and of the map that scans are matched with.

Each scan that shows something new joins the map at its estimated pose, with the error of its match,
and an old one leaves it. So the map goes with the mean of its scans' errors, and what is measured
on it walks: by a small share of a match's error at a time, but for good.
"""

from __future__ import annotations

import numpy as np

from werrimbi_odom.inference.fitting.prediction import Prediction
from werrimbi_odom.model.covariance import PathNoise, piece_covariance
from werrimbi_odom.model.motion import BodyMotion
from werrimbi_odom.model.pose import Floats


def walked(prediction: Prediction, growth: Floats, xy: Floats, yaw: Floats) -> Floats:
    """Covariance of each leg by a walk, evenly along its path, shape (..., m, 3, 3).

    `growth` (m,): variances gained over each leg, in units of `xy` and `yaw`. `xy`, `yaw` (..., m)
    or (..., 1): variances of position and heading [m², rad²].
    """
    none = np.zeros_like(growth)
    leg = BodyMotion(prediction.along, none, prediction.turn)
    swing = piece_covariance(leg, PathNoise(none, growth, none), none).matrix()
    flat = growth[:, None, None] * np.diag([1.0, 1.0, 0.0])
    return np.asarray(xy[..., None, None] * flat + yaw[..., None, None] * swing)


def map_walk(prediction: Prediction, growth: Floats, xy: Floats, yaw: Floats) -> Floats:
    """The same of the map of scans: `growth` (m, 2) in units of the variances of a pose on it."""
    whole = np.ones(len(growth))
    return walked(prediction, whole, xy * growth[:, 0], yaw * growth[:, 1])
