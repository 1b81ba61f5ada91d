# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A comparison where poses are rarer than the legs that were asked for: legs are longer."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from test.white_noise_robot import WhiteNoiseRobot, drive
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.inference.comparison.compare import compare
from werrimbi_odom.inference.comparison.prepared_runs import prepare
from werrimbi_odom.inference.comparison.verdict import verdict_of
from werrimbi_odom.model.robot import Robot

ROBOT = Robot(0.35, 0.05, 2000.0, 2000.0, left_wheel_noise=4e-4, right_wheel_noise=4e-4)
EVERY = 4.0
"""Time from a pose to the next [s], at 1 m/s."""


def straight_by_the_counters(random: np.random.Generator, number: int, *, headings: bool) -> Run:
    """A minute of a robot whose right wheel is 0.1 % larger: it bends to the left."""
    time = np.arange(0.0, 60.0, 0.02)
    counts = np.floor(time / ROBOT.left_tick).astype(int)
    seen = np.arange(0.0, 60.0, EVERY)
    bend = 0.001 / ROBOT.track
    x, y = (
        wave + 1e-3 * random.standard_normal(seen.size)
        for wave in (np.sin(bend * seen) / bend, (1.0 - np.cos(bend * seen)) / bend)
    )
    yaw = bend * seen + 2e-3 * random.standard_normal(seen.size)
    reference = Reference(seen, x, y, yaw if headings else np.full(seen.size, np.nan))
    return Run(f"{number}", Path(f"{number}"), Ticks(time, counts, counts), reference)


@pytest.mark.parametrize("leg", [1.0, EVERY])
def test_a_heading_that_bends_the_leg_is_told_once(leg: float) -> None:
    """Of legs of 4 m for 1 m asked, the end aside by half of it was told as a part of its own."""
    random = np.random.default_rng(1)
    runs = [straight_by_the_counters(random, number, headings=True) for number in range(3)]
    found = compare(runs, ROBOT, EvaluationOptions(leg=leg, sigma_xy=1e-3, sigma_yaw=2e-3))
    assert found.main.median == pytest.approx(EVERY, rel=0.01)
    told = [(part.channel, part.per) for part in verdict_of(found).systematic]
    assert told == [("heading", "travel")]


def test_positions_are_not_called_too_near_by_the_leg_that_was_asked_for() -> None:
    random = np.random.default_rng(1)
    runs = [straight_by_the_counters(random, number, headings=False) for number in range(3)]
    verdict = verdict_of(compare(runs, ROBOT, EvaluationOptions(sigma_xy=0.3)))
    assert verdict.too_short == 0.0
    assert verdict.enough


@pytest.mark.parametrize("decimals", [2, 3, 12])
def test_a_steady_robot_writes_no_rounding(decimals: int) -> None:
    """Along x at 0.3 m a pose, no two are nearer than 29 cm, which was the rounding of 84 mm."""
    random = np.random.default_rng(1)
    machine = WhiteNoiseRobot()
    line = drive(machine, (np.full(3000, 0.3), np.zeros(3000)), random, every=50, sigma_xy=2e-3)
    seen = line.reference
    assert seen is not None
    along = (seen.x + 1j * seen.y) * np.exp(-1j * seen.yaw[0])
    x, y = (part.round(decimals) for part in (along.real, along.imag))
    written = replace(line, reference=replace(seen, x=x, y=y, yaw=seen.yaw - seen.yaw[0]))
    ((_, noise),) = prepare([written], machine.entered()).noises
    assert noise.sigma_xy == pytest.approx(np.hypot(2e-3, 0.1**decimals / np.sqrt(12.0)), rel=0.4)


def test_the_noise_of_headings_is_the_same_wrapped_or_not() -> None:
    """On a circle, a pose a second: 0.34 rad if the headings run on, and 0.012 if wrapped."""
    random = np.random.default_rng(1)
    machine = WhiteNoiseRobot()
    circle = drive(machine, (np.full(3000, 0.2), np.full(3000, 1.2)), random, every=50)
    seen = circle.reference
    assert seen is not None
    for yaw in (np.unwrap(seen.yaw), np.angle(np.exp(1j * seen.yaw))):
        told = replace(circle, reference=replace(seen, yaw=yaw))
        ((_, noise),) = prepare([told], machine.entered()).noises
        assert noise.sigma_yaw == pytest.approx(2e-3, rel=0.5)
