# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A run of a robot whose wheels err by white noise alone, and what its robot file says."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from test.white_noise_robot import WhiteNoiseRobot, drive, wandering
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.model.robot import Robot

TRUE = WhiteNoiseRobot()
ROBOT = Robot(TRUE.separation, TRUE.left_radius, *2 * [TRUE.ticks_per_revolution])


def driven(seed: int, moves: float = 60.0, **seen: float) -> Run:
    """Lines, curves, spins and stops, forwards and backwards."""
    random = np.random.default_rng(seed)
    recorded = drive(TRUE, wandering(random, moves), random, every=5, **seen)
    ticks, poses = recorded.ticks, recorded.reference
    return Run(
        "drive",
        Path("drive"),
        Ticks(ticks.time, ticks.left, ticks.right),
        Reference(poses.time, poses.x, poses.y, poses.yaw),
    )
