# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A reference that stands still while the wheels drive: it measured nothing of the drive."""

from __future__ import annotations

import numpy as np

from werrimbi_odom.files.run import Reference, Ticks
from werrimbi_odom.files.tables.counter_columns import FEWEST
from werrimbi_odom.model.pose import wrap_all
from werrimbi_odom.model.robot import Robot

LEAST_TURNED = 0.5
"""Turn by the wheels that any heading must show [rad]; straight on, they differ by some degrees."""

STANDS = 0.05
"""Extent [m] within which a reference may stand still: no drive that is worth judging is smaller.
One that does not stand goes from pose to pose by less than it scatters in all."""
LEAST_DRIVEN = 0.5
"""Way ahead by the wheels that any position must show [m]: ten times that extent."""


def stands_still(ticks: Ticks, reference: Reference, robot: Robot) -> str:
    """Poses that stay where they are while the wheels drive; "" if they do not.

    They need not be equal to the last digit: so errs a tracker of another thing, too, but each by
    its own noise. A robot that was put back on its mark after each lap stands where it is measured.
    """
    rows = np.flatnonzero(reference.has_position)
    turns = reference.yaw[rows][reference.has_yaw[rows]]
    if rows.size < FEWEST or (np.abs(wrap_all(turns - turns[:1])) > LEAST_TURNED).any():
        return ""
    place = reference.x[rows] + 1j * reference.y[rows]
    extent = float(np.hypot(np.ptp(place.real), np.ptp(place.imag)))
    goes_on = extent > 0.0 and np.mean(np.abs(np.diff(place)) ** 2) < np.var(place)
    if extent > STANDS or goes_on:
        return ""
    read = np.isfinite(ticks.left) & np.isfinite(ticks.right)
    if not read.any():
        return ""
    stamps = np.maximum.accumulate(ticks.time[read])
    left, right = (
        counts[read] * tick
        for counts, tick in ((ticks.left, robot.left_tick), (ticks.right, robot.right_tick))
    )
    steps = np.abs(np.diff([left, right], prepend=np.nan))
    rolls = steps[:, np.minimum(np.searchsorted(stamps, reference.time[rows]), stamps.size - 1)]
    driven = np.ptp(0.5 * (left + right)) >= LEAST_DRIVEN
    turned = turns.size > 0 and np.ptp(right - left) >= LEAST_TURNED * robot.track
    if not (driven or turned) or np.count_nonzero((rolls > 0.0).any(axis=0)) < FEWEST:
        return ""
    way = float(np.nansum(steps, axis=1).max())
    where = "one pose" if not extent else f"within {1e3 * extent:.2g} mm"
    return (
        f"the reference stands still ({where} in {rows.size} rows) while the wheels drive "
        f"({way:.3g} m): it measured nothing of this drive (a localiser that is stuck, a tracker "
        "of something else), or the robot was held all the time; take another reference, or leave "
        "the drive out"
    )


def no_turn(ticks: Ticks, reference: Reference, robot: Robot) -> str:
    """Headings alone that never change: no gyro that measures is without noise."""
    known = reference.yaw[reference.has_yaw]
    if reference.has_position.any() or known.size < FEWEST or np.ptp(known) > 0.0:
        return ""
    turn = (ticks.right * robot.right_tick - ticks.left * robot.left_tick) / robot.track
    turned = float(np.nanmax(turn) - np.nanmin(turn)) if np.isfinite(turn).any() else 0.0
    if turned < LEAST_TURNED:
        return ""
    return (
        f"the reference's heading is {known[0]:g} in all rows, while the wheels turn the robot by "
        f"{np.degrees(turned):.0f}°: no turn was measured (an IMU that gives its orientation alone "
        "has yaw rates of 0, and is no gyro); take another reference"
    )
