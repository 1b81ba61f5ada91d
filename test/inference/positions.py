# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Drives of which positions of one point were measured, and no headings."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from test.model.drives import ROBOT, read
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.trajectory import trajectory

FRAME = 1.5
"""Start heading of every drive in the reference's frame [rad]."""


def positions_of_a_point(
    name: str,
    speeds: Sequence[float],
    yaw_rates: Sequence[float],
    point: complex = 0j,
    *,
    truth: Robot = ROBOT,
    seed: int = 0,
) -> Run:
    """Ten seconds at each speed and yaw rate, with a rest before and after.

    `point` is what was measured, ahead of the axle's middle and left of it [m].
    """
    random = np.random.default_rng(seed)
    driven = [np.pad(np.repeat(part, 200), 40) for part in (speeds, yaw_rates)]
    ticks = read(ROBOT, 20.0, *driven)
    path = trajectory(truth, *ticks)
    place = np.exp(1j * FRAME) * (path.x + 1j * path.y + point * np.exp(1j * path.yaw))
    noise = random.normal(0.0, 1e-3, (2, place.size))
    reference = Reference(
        path.time, place.real + noise[0], place.imag + noise[1], np.full(place.size, np.nan)
    )
    counted = Ticks(ticks.time, ticks.left.astype(float), ticks.right.astype(float), {})
    return Run(name, Path(name), counted, reference)
