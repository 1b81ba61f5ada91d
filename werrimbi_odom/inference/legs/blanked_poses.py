# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Stretches in which a reference is of no use: its lapses, and phases of much more noise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from werrimbi_odom.files.run import NoDriving, Reference
from werrimbi_odom.inference.legs.count_interpolation import Counters
from werrimbi_odom.inference.legs.noisy_phases import noisy_phases
from werrimbi_odom.inference.legs.reference_lapses import lapses
from werrimbi_odom.inference.legs.windows import later_than_all_before
from werrimbi_odom.model.robot import Robot


def without_useless_poses(
    seen: Reference, counters: Counters, robot: Robot, delay: float
) -> tuple[Reference, tuple[NoDriving, ...]]:
    """Blank the poses of such stretches, and list these in the time of the counters.

    `delay`: of the reference behind the wheels, by the robot file [s]. Another delay, found later,
    moves no pose out of a stretch or into one.
    """
    if seen.own_axes:
        return seen, ()
    in_time = seen.earlier(delay)
    rising = in_time.chosen(later_than_all_before(in_time.time))
    found = sorted([*lapses(counters, rising, robot), *noisy_phases(counters, rising, robot)])
    useless = np.zeros(seen.time.shape, dtype=np.bool_)
    for part in found:
        useless |= (in_time.time > part.begin) & (in_time.time < part.end)
    if not useless.any():
        return seen, ()
    x, y, yaw = (np.where(useless, np.nan, each) for each in (seen.x, seen.y, seen.yaw))
    return replace(seen, x=x, y=y, yaw=yaw), tuple(found)
