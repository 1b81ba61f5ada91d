# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Phases in which a reference is several times noisier than in the rest of the drive.

So is a satellite receiver that loses its fixed solution for a while. One noise for all poses fits
neither part: the phase looks like a robot that is pushed about, and like wheels that err.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

from werrimbi_odom.files.run import NoDriving, Reference
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.distributions import MEDIAN_TO_SIGMA
from werrimbi_odom.inference.legs.count_interpolation import Counters
from werrimbi_odom.inference.legs.measured_motion import runs_of
from werrimbi_odom.inference.legs.windows import standing_below
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

_Complexes = NDArray[np.complex128]


def noisy_phases(counters: Counters, reference: Reference, robot: Robot) -> list[NoDriving]:
    """Find the phases by third differences of the places, in order.

    They are judged while the wheels roll, by what a robot does there: a hand that carries it is no
    noise. What stands between two noisy poses is of the same phase. `reference`: with strictly
    ascending stamps.
    """
    known = reference.has_position
    time = reference.time[known]
    if time.size < rules.NO_DRIVING_POSES:
        return []
    moved, rolled = _by_wheels(counters, time, robot)
    rolls = rolled > standing_below(rolled)
    rows = np.flatnonzero(rolls[:-2] & rolls[1:-1] & rolls[2:])
    interval = float(np.median(np.diff(time)))
    half = max(rules.AGREE_FEWEST, round(0.5 * rules.NOISY_PHASE_LASTS / interval))
    if rows.size < 2 * (2 * half + 1):
        return []
    seen = np.diff(reference.x[known]) + 1j * np.diff(reference.y[known])
    third, driven = (_third(each)[:, rows] for each in (seen, moved))
    local, by_driving = (
        np.mean([median_filter(side, 2 * half + 1) for side in each], axis=0)
        for each in (third, driven)
    )
    calm = local <= rules.NOISY_PHASE * max(float(np.median(third)), float(np.median(local)))
    usual = max(float(np.median(third[:, calm])), 1e-9)
    most = np.maximum(usual, by_driving)
    # Of poses with unit noise a third difference has the variance 20, a difference of two 2.
    noise = MEDIAN_TO_SIGMA * local * np.sqrt(2.0 / 20.0)
    surely = (local > rules.NOISY_PHASE * most) & (noise > rules.NO_DRIVING_WAY)
    found = []
    for first, last in runs_of(local > np.sqrt(rules.NOISY_PHASE) * most):
        if np.count_nonzero(surely[first : last + 1]) < half:
            continue
        times = float(np.median(local[first : last + 1])) / usual
        # Of a window, as many are noisy by chance, within two standard deviations of a half.
        unsure = round(np.sqrt(2 * half + 1))
        first, last = max(first - unsure, 0), min(last + unsure, rows.size - 1)
        begin = time[rows[first] : rows[first] + 2].mean()
        end = time[rows[last] + 2 : rows[last] + 4].mean()
        words = f"the reference scatters {times:.0f} times as much as else"
        found.append(NoDriving(float(begin), float(end), "gap", words))
    return found


def _third(steps: _Complexes) -> Floats:
    """Third differences of places, by their steps: sizes of both coordinates, (2, n - 2)."""
    third = np.diff(steps, 2)
    return np.abs(np.stack([third.real, third.imag]))


def _by_wheels(counters: Counters, time: Floats, robot: Robot) -> tuple[_Complexes, Floats]:
    """Steps of the robot between the poses, by its wheels, and how far these rolled [m]."""
    left, right = counters.travel(robot, time)
    turn = (right - left) / robot.track
    yaw = np.cumsum(turn) - 0.5 * turn
    return 0.5 * (left + right) * np.exp(1j * yaw), 0.5 * (np.abs(left) + np.abs(right))
