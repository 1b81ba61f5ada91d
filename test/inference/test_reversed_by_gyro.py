# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A gyro alone tells a reversed wheel on three metres that are straight but for a few short turns.

By the file such a robot spins on the spot while its gyro shows nearly nothing; so does one that is
held while its wheels spin. What tells them apart is the little that it turns, and when.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from test.model.drives import ROBOT, read
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.inference.set_up.search import look_for_mistakes

RATE = 50.0
SEEDS = range(6)


def driven(seed: int, stands: float) -> Run:
    """Nearly straight for 20 s at 0.15 m/s, with three corrections of about a degree."""
    random = np.random.default_rng(seed)
    seconds = stands + 20.0
    time = np.arange(0.0, seconds, 1.0 / RATE)
    speed = np.where(time > stands, 0.15, 0.0)
    yaw_rate = np.zeros(time.size)
    for begin in stands + random.uniform(1.0, 19.0, 3):
        yaw_rate[(time > begin) & (time < begin + 0.3)] += random.choice([-1.0, 1.0]) * 0.08
    ticks = read(ROBOT, RATE, speed, yaw_rate)
    heading = np.cumsum(np.append(0.0, yaw_rate)) / RATE
    return seen_by_gyro(ticks.time, ticks.left, ticks.right, heading, random)


def seen_by_gyro(
    time: np.ndarray,
    left: np.ndarray,
    right: np.ndarray,
    heading: np.ndarray,
    random: np.random.Generator,
) -> Run:
    noise = np.cumsum(random.normal(0.0, 1e-5, time.size))
    nothing = np.full(time.size, np.nan)
    yaw = heading + noise + 0.002 * time
    reference = Reference(time, nothing, nothing, yaw, kind="incremental")
    return Run("run", Path("run"), Ticks(time, left, right), reference)


WRONG: dict[str, Callable[[Ticks], Ticks]] = {
    "left_wheel_reversed": lambda ticks: replace(ticks, left=-ticks.left),
    "right_wheel_reversed": lambda ticks: replace(ticks, right=-ticks.right),
}


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("stands", [4.0, 60.0])
@pytest.mark.parametrize("name", WRONG)
def test_a_reversed_wheel_is_named(name: str, stands: float, seed: int) -> None:
    run = driven(seed, stands)
    found = look_for_mistakes([replace(run, ticks=WRONG[name](run.ticks))], ROBOT).findings
    assert [each.effect for each in found] == [name]


@pytest.mark.parametrize("seed", SEEDS)
def test_a_sound_robot_that_drives_straight_is_set_up_right(seed: int) -> None:
    assert look_for_mistakes([driven(seed, 10.0)], ROBOT).findings == ()


@pytest.mark.parametrize("seed", SEEDS)
def test_a_robot_that_is_held_is_no_reversed_wheel(seed: int) -> None:
    """Its wheels spin it on the spot, and a hand holds it: its gyro shows nothing but noise."""
    random = np.random.default_rng(seed)
    time = np.arange(0.0, 30.0, 1.0 / RATE)
    ticks = read(ROBOT, RATE, np.zeros(time.size), np.where(time > 4.0, 0.9, 0.0))
    run = seen_by_gyro(ticks.time, ticks.left, ticks.right, np.zeros(time.size + 1), random)
    wired = {each.effect for each in look_for_mistakes([run], ROBOT).findings}
    assert not wired & {"left_wheel_reversed", "right_wheel_reversed", "wheels_swapped"}
