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

from test.inference.driven import of_headings
from test.model.drives import ROBOT, read
from werrimbi_odom.files.run import Run, Ticks
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
    yaw = heading + noise + 0.002 * time
    reference = of_headings(time, yaw, "incremental")
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


def rectangle(seed: int, sense: float) -> Run:
    """A rectangle, and the whole degrees of a gyro after each side and each turn: nine headings."""
    random = np.random.default_rng(seed)
    stop, speed, yaw_rate, ends = np.zeros(25), [np.zeros(25)], [np.zeros(25)], [0]
    for side in (1.0, 0.6, 1.0, 0.6):
        line = np.full(round(side / 0.2 * RATE), 0.2)
        turn = np.full(round(0.5 * np.pi / 0.5 * RATE * random.uniform(0.97, 1.03)), 0.5)
        for now, turning in ((line, 0.0 * line), (0.0 * turn, sense * turn)):
            speed += [now, stop]
            yaw_rate += [turning, stop]
            ends.append(sum(part.size for part in speed) - 5)
    driven, turned = np.concatenate(speed), np.concatenate(yaw_rate)
    ticks = read(ROBOT, RATE, driven, turned)
    bends = turned / 1.1 + random.normal(0.0, 0.02, turned.size)
    heading = np.append(0.0, np.cumsum(bends)) / RATE
    seen = np.radians(np.round(np.degrees(heading[ends])))
    reference = of_headings(ticks.time[ends], seen, "incremental")
    name = f"rectangle_{seed}"
    return Run(name, Path(name), Ticks(ticks.time, ticks.left, ticks.right), reference)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("counts", [1.0, -1.0])
def test_a_gyro_that_counts_clockwise_is_found_by_headings_after_each_turn(
    counts: float, seed: int
) -> None:
    runs = [rectangle(3 * seed + each, sense) for each, sense in enumerate((1.0, -1.0, 1.0))]
    seen = [replace(run.reference, yaw=counts * run.reference.yaw) for run in runs if run.reference]
    runs = [replace(run, reference=each) for run, each in zip(runs, seen, strict=True)]
    findings = look_for_mistakes(runs, ROBOT).findings
    if counts > 0.0:
        assert findings == ()
    else:
        assert len(findings) == 1
        assert "reference_mirrored" in (findings[0].effect, *findings[0].twins)
