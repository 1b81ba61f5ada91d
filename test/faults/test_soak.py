# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Ten hours of driving in simulated time: flat memory, and a covariance that does not drift."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import numpy as np
import pytest

from test.memory import resident
from werrimbi_odom.model.covariance import path_noise, piece_covariance
from werrimbi_odom.model.motion import WheelTravel, wheels_to_body
from werrimbi_odom.model.odometer import Odometer
from werrimbi_odom.model.robot import Robot

ROBOT = Robot(0.35, 0.05, 2000.0, 2000.0)
RATE = 50
HOURS = 10
LEFT, RIGHT = 58, 61
"""Counts a message: 0.47 m/s, a circle of 7 m."""


def circling(seconds: int) -> Iterator[tuple[float, int, int]]:
    """A circle, with a stop of two seconds each minute, so that pieces begin and end."""
    left = right = 0
    for row in itertools.count():
        time = row / RATE
        if time > seconds:
            return
        if time % 60.0 < 58.0:
            left, right = left + LEFT, right + RIGHT
        yield time, left, right


def after(seconds: int) -> tuple[Odometer, list[float], tuple[int, int]]:
    """The odometer at the end, memory at each tenth, and the last counts."""
    odometer, memory = Odometer(ROBOT), []
    every = seconds * RATE // 10
    counts = (0, 0)
    for row, (time, left, right) in enumerate(circling(seconds)):
        odometer.update(time, left, right)
        counts = left, right
        if row and row % every == 0:
            memory.append(resident() / 2**20)
    return odometer, memory, counts


def drift(seconds: int) -> tuple[float, list[float]]:
    """Largest error of the covariance against the closed form of the whole way, and memory.

    The way is one circle, however often the robot has stopped on it: the noise of the wheels comes
    with what they roll. So equation 17 of the paper, used once, has the whole of it.
    """
    odometer, memory, (left, right) = after(seconds)
    first = (LEFT, RIGHT)  # the first reading is where the odometer begins
    travel = WheelTravel((left - first[0]) * ROBOT.left_tick, (right - first[1]) * ROBOT.right_tick)
    motion = wheels_to_body(travel, ROBOT.track)
    whole = piece_covariance(motion, path_noise(ROBOT, travel.left, travel.right), 0.0).matrix()
    found = odometer.covariance().matrix()
    scale = np.sqrt(np.outer(whole.diagonal(), whole.diagonal()))
    return float((np.abs(found - whole) / scale).max()), memory


def test_half_an_hour() -> None:
    error, _ = drift(1800)
    assert error < 1e-6


@pytest.mark.evidence
def test_ten_hours() -> None:
    error, memory = drift(HOURS * 3600)
    print(f"covariance off by {error:.1e}; memory {memory[0]:.1f} to {memory[-1]:.1f} MB")
    assert error < 1e-6
    assert memory[-1] - memory[0] < 1.0
