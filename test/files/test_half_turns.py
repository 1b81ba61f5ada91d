# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A marker that is seen from its other side turns the robot's heading round, and nothing else."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from werrimbi_odom.files.references.half_turns import without_half_turns
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.model.pose import wrap_all

TIME = np.arange(0.0, 60.0, 0.05)
FORTH = np.where(TIME % 20.0 < 14.0, 0.3, -0.3)
YAW = np.cumsum(0.05 * 0.6 * np.sin(0.3 * TIME))
PLACE = np.cumsum(0.05 * FORTH * np.exp(1j * YAW))
BEHIND = (TIME > 5.0) & (TIME < 30.0) | (TIME > 40.0)


def a_run(yaw: np.ndarray, place: np.ndarray = PLACE, sense: float = 1.0) -> Run:
    noise = np.random.default_rng(0).normal(0.0, 3e-3, (3, TIME.size))
    way, turn = np.cumsum(0.05 * FORTH), 0.15 * YAW
    left, right = (np.rint(sense * 6366.0 * (way + side * turn)) for side in (-1.0, 1.0))
    ticks = Ticks(TIME, left, right)
    seen = Reference(TIME, place.real + noise[0], place.imag + noise[1], wrap_all(yaw + noise[2]))
    return Run("marker", Path("marker"), ticks, seen)


def off(run: Run) -> np.ndarray:
    assert run.reference is not None
    return np.abs(wrap_all(run.reference.yaw - YAW))


@pytest.mark.parametrize("begins", [0.0, np.pi])
def test_headings_are_turned_to_where_the_wheels_roll_ahead(begins: float) -> None:
    """Also if most look behind. Of a sound robot 20 % of the counts were said to be lost."""
    run = without_half_turns(a_run(YAW + np.pi * BEHIND + begins), 0)
    assert off(run).max() < 0.05
    assert "3 times" in run.damage[0]


def test_without_positions_the_sense_of_most_headings_is_kept() -> None:
    gone = np.full(TIME.size, np.nan + 1j * np.nan)
    run = without_half_turns(a_run(YAW + np.pi * BEHIND, gone), 0)
    assert np.ptp(off(run)) < 0.05
    assert off(run).min() > 3.0  # they look behind in 45 s of 60 s


@pytest.mark.parametrize("by", [1.2, 2.7])
def test_another_mistake_of_a_tracker_is_not_turned_back(by: float) -> None:
    run = a_run(YAW + by * BEHIND)
    assert without_half_turns(run, 0) is run


def test_a_track_that_was_taken_for_another_is_not_turned_back() -> None:
    """It is wrong in its place too, and left out."""
    run = a_run(YAW + np.pi * BEHIND, PLACE + 0.4 * BEHIND)
    assert without_half_turns(run, 0) is run


@pytest.mark.parametrize("rate", [3.0, 6.0])
def test_a_robot_that_spins_past_180_degrees_stays(rate: float) -> None:
    run = a_run(np.cumsum(0.05 * np.full(TIME.size, rate)) + np.pi)
    assert without_half_turns(run, 0) is run
