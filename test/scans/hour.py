# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""An hour of scans, matched as they come: `python -m test.scans.hour` (five to fifteen minutes).

Every ten minutes it prints how many scans a second were matched, and the memory of the process.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from test.memory import resident
from test.scans.drives import seen
from werrimbi_odom.scans.room_odometry import RoomOdometry
from werrimbi_odom.scans.sweep import Sweep
from werrimbi_odom.simulation import rooms
from werrimbi_odom.simulation.engine import PERIOD, TruePath
from werrimbi_odom.simulation.lidar import Lidar

LAP = 28.0
"""Time of an eight of 2.4 m by 1.2 m, at 0.27 m/s [s]."""
PART, TEN_MINUTES = 60, 600
"""[s]"""


class Point(NamedTuple):
    """After ten minutes more."""

    minutes: int
    scans: int
    """So far."""
    a_second: float
    """Matched in a second of a core; the lidar's own simulation is not counted."""
    megabytes: float
    """Of the process."""


def eights(begin: float, end: float) -> TruePath:
    """A part of a drive in eights."""
    t = np.arange(begin, end, PERIOD)
    turn = 2.0 * np.pi * t / LAP
    x, y = 1.2 * np.sin(turn), 0.6 * np.sin(2.0 * turn)
    yaw = np.unwrap(np.arctan2(1.2 * np.cos(2.0 * turn), 1.2 * np.cos(turn)))
    nothing = np.zeros(t.size)
    return TruePath(t, x, y, yaw, nothing, nothing)


def sweeps(minutes: int, lidar: Lidar) -> Iterator[list[Sweep]]:
    """What a lidar sees among people, a minute at a time."""
    for part in range(minutes):
        path = eights(part * PART, (part + 1) * PART + 2.0 / lidar.rate_hz)
        given = seen(path, rooms.living_room(people=True), lidar, seed=part)[1]
        yield [sweep for sweep in given if sweep.time < (part + 1) * PART]


def hour(minutes: int = 60, rate_hz: float = 10.0) -> Iterator[Point]:
    """Match them, and look at the clock and the memory every ten minutes."""
    matcher = RoomOdometry()
    scans, spent = 0, 0.0
    for part, given in enumerate(sweeps(minutes, Lidar(rate_hz=rate_hz)), start=1):
        begun = time.process_time()
        for sweep in given:
            matcher.take(sweep)
        spent += time.process_time() - begun
        scans += len(given)
        if part * PART % TEN_MINUTES == 0:
            yield Point(part, scans, scans / spent, resident() / 2**20)
    found = matcher.path()
    assert found.time.size > 0.99 * scans, "it was lost"


if __name__ == "__main__":
    for point in hour():
        print(
            f"{point.minutes} min: {point.scans} scans, {point.a_second:.0f} a second, "
            f"{point.megabytes:.0f} MB",
            flush=True,
        )
