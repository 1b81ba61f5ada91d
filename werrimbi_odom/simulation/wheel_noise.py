# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""White noise of each wheel's travel along its path (Chong and Kleeman 1997)."""

from __future__ import annotations

import math

import numpy as np

from .engine import Shift, Shifter, Stride
from .robot import TrueRobot


def wheel_noise(robot: TrueRobot, rng: np.random.Generator) -> Shifter:
    """Travel noise of both wheels.

    Over a stride of path length s the left wheel errs by N(0, k_L^2 s), the right one by N(0,
    k_R^2 s), independently (section 4 of the paper). The noise has no force, so the body is moved
    after the step; the encoders see only the rolling.
    """

    def shift(stride: Stride) -> Shift:
        a, b = rng.standard_normal(2)
        left = robot.left_wheel_noise * math.sqrt(abs(stride.left)) * a
        right = robot.right_wheel_noise * math.sqrt(abs(stride.right)) * b
        return Shift((left + right) / 2, 0.0, (right - left) / robot.wheel_separation)

    return shift
