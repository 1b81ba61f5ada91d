# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A reference that repeats one pose to the last digit, told apart from a robot that is held."""

from __future__ import annotations

import numpy as np

from werrimbi_odom.files.run import NoDriving, Reference
from werrimbi_odom.inference.legs.measured_motion import runs_of
from werrimbi_odom.inference.rules import NO_DRIVING_FEWEST, NO_DRIVING_STUCK

STUCK = "the reference repeated one pose to the last digit, and the wheels turned: it stood still"


def as_stuck(part: NoDriving, reference: Reference) -> NoDriving:
    """Put a stretch down to the reference if that repeated one pose.

    Measurements of a robot that is held differ by their noise. A gyro that reads zero is none.
    """
    time, poses = reference.time, np.stack([reference.x, reference.y, reference.yaw])
    rows = np.flatnonzero((time >= part.begin) & (time <= part.end))
    if rows.size < NO_DRIVING_FEWEST or not np.isfinite(poses[0, rows]).any():
        return part
    repeats = np.zeros(time.size, dtype=np.bool_)
    repeats[1:] = ((poses[:, 1:] == poses[:, :-1]) | np.isnan(poses[:, 1:])).all(axis=0)
    if np.mean(repeats[rows[1:]]) < NO_DRIVING_STUCK:
        return part
    stuck = [each for each in runs_of(repeats) if each[1] >= rows[0] and each[0] <= rows[-1]]
    first, last = stuck[0][0] - 1, min(stuck[-1][1] + 1, time.size - 1)
    begin, end = min(part.begin, float(time[first])), max(part.end, float(time[last]))
    return NoDriving(begin, end, "gap", STUCK)
