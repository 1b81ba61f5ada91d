# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A reference whose clock gains or loses on the wheels', found before anything else is.

After a minute at two per cent its stamps are more than a second off, and what it saw of any turn
lies beside what the wheels did: as if the robot had been held, and then moved by hand. The rate
itself is fitted with the model (`reference_clock_drift`); this one is to look at the drive by.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.ndimage import uniform_filter1d

from werrimbi_odom.files.run import Reference
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.legs.count_interpolation import Counters
from werrimbi_odom.inference.legs.windows import windows_of
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot


class ReferenceClock(NamedTuple):
    """A reference's clock against the wheels'."""

    delay: float = 0.0
    """By which its stamps are late at `since` [s]."""
    rate: float = 0.0
    """What it gains in a second [s/s]."""
    since: float = 0.0
    """Begin of the drive, by its stamps [s]."""

    def put_right(self, reference: Reference) -> Reference:
        """The reference by the time of the wheels."""
        if self.rate == 0.0:
            return reference.earlier(self.delay)
        gyro = reference.gyro
        if gyro is not None:
            gyro = gyro._replace(time=self._by_wheels(gyro.time))
        return replace(reference, time=self._by_wheels(reference.time), gyro=gyro)

    def _by_wheels(self, time: Floats) -> Floats:
        return time - self.delay - self.rate * (time - self.since)

    def stamp(self, time: float) -> float:
        """Its stamp at a time of the wheels [s]."""
        return self.since + (time + self.delay - self.since) / (1.0 - self.rate)


def clock_of(
    counters: Counters, reference: Reference, robot: Robot, delay: float
) -> ReferenceClock:
    """The clock by which a reference moves as the wheels do, but for the rest of a delay.

    Its rate is zero where the motion of both agrees as it is, and where no rate makes it agree.
    `delay`: by the robot file [s].
    """
    as_filed = ReferenceClock(delay)
    in_time = reference.earlier(delay)
    ways = not in_time.turns().has_yaw.any()
    windows = windows_of(counters, in_time if ways else in_time.turns(), robot, ways=ways)
    if windows is None:
        return as_filed
    known = np.isfinite(windows.measured)
    if np.count_nonzero(known) < rules.CLOCK_WINDOWS:
        return as_filed
    time, seen = windows.time[known], np.abs(windows.measured[known])
    turned = windows.rolled if ways else np.abs(windows.right - windows.left) / robot.track
    first, last = float(time[0]), float(time[-1])
    step = max(windows.step, (last - first) / rules.CLOCK_TIMES)
    grid = np.arange(first, last, step)
    wheels = _moving(np.interp(grid, windows.time, turned), step)
    most = round(rules.AGREE_LATEST / step)
    at_lags = np.stack([np.roll(wheels, lag) for lag in range(-most, most + 1)])

    def agrees(rate: float) -> float:
        """Largest correlation of the two at any lag."""
        stamps = first + (grid - first) / (1.0 - rate)
        moved = _moving(np.interp(stamps, time, seen), step)
        sizes = float(np.linalg.norm(wheels) * np.linalg.norm(moved))
        return float((at_lags @ moved).max()) / max(sizes, 1e-300)

    if agrees(0.0) >= rules.CLOCK_IN_STEP:
        return as_filed
    coarse = rules.CLOCK_COARSE / (last - first)
    count = min(int(np.ceil(rules.CLOCK_RATE / coarse)), rules.CLOCK_RATES)
    best = max(coarse * np.arange(-count, count + 1), key=agrees)
    best = max(best + coarse * np.linspace(-0.75, 0.75, 13), key=agrees)
    if agrees(best) < rules.CLOCK_IN_STEP:
        return as_filed
    return ReferenceClock(delay, float(best), first + delay)


def _moving(values: Floats, step: float) -> Floats:
    """How much more or less than usual about that time, (n,)."""
    usual = uniform_filter1d(values, max(1, round(rules.CLOCK_USUAL / step)))
    return np.asarray(values - usual)
