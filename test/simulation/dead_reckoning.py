# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Dead reckoning with what a hidden effect is said to do, against where the engine's robot was."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom import simulation as sim

Floats = NDArray[np.float64]
BASE, RADIUS = 0.35, 0.05
CALM = sim.free(30.0, seed=1, speed=0.4, yaw_rate=1.0)
BRISK = sim.free(30.0, seed=2, speed=0.8, yaw_rate=2.0, acceleration=1.5)
LINE = sim.moves("line", [(3.0, 0.0)])


def drive(odd: sim.Peculiarity, manoeuvre: sim.Manoeuvre, **robot: bool) -> sim.Recording:
    return sim.record(sim.TrueRobot(**robot), manoeuvre, seed=1, hidden=[odd])


def cumulated(first: float, steps: Floats) -> Floats:
    return first + np.concatenate(([0.0], np.cumsum(steps)))


def rolled(path: sim.TruePath) -> tuple[Floats, Floats]:
    """Travel of both wheels as plain odometry has it [m]."""
    return path.left_angle_rad * RADIUS, path.right_angle_rad * RADIUS


def errors(
    path: sim.TruePath, left: Floats, right: Floats, crab: float = 0.0
) -> tuple[Floats, Floats]:
    """Of dead reckoning: distance [m] and heading [rad] from the truth, row by row."""
    dl, dr = np.diff(left), np.diff(right)
    turn = (dr - dl) / BASE
    yaw = cumulated(path.yaw_rad[0] + crab, turn)
    chord = (dl + dr) / 2 * np.sinc(turn / (2 * np.pi))
    heading = yaw[:-1] + turn / 2
    x = cumulated(path.x_m[0], chord * np.cos(heading))
    y = cumulated(path.y_m[0], chord * np.sin(heading))
    return np.hypot(x - path.x_m, y - path.y_m), np.abs(yaw - crab - path.yaw_rad)


def far(path: sim.TruePath) -> float:
    return math.hypot(path.x_m[-1] - path.x_m[0], path.y_m[-1] - path.y_m[0])


def turned(path: sim.TruePath) -> float:
    """From the first row to the last [rad]."""
    return float(path.yaw_rad[-1] - path.yaw_rad[0])
