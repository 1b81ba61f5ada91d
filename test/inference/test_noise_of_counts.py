# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Robots that keep to their course, by a gyro or whoever steers them: the noise is in the counts.

What an error seems to go with is then that noise, on both sides of the law.
"""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import pytest

from werrimbi_odom.effects import LIBRARY
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.inference.diagnosis.variables import curve_knots
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

BASE, RADIUS, TICKS = 0.3, 0.05, 2000.0
ENTERED = Robot(BASE, RADIUS, TICKS, TICKS)
STEP = 0.02
BY_GYRO = EvaluationOptions(reference_kind="incremental")


def by_stick(random: np.random.Generator) -> tuple[Floats, Floats]:
    """Speeds and yaw rates of 45 s: two seconds each of a line or one of two rates of turning."""
    rates = random.choice([0.0, 0.6, -0.6, 0.3, -0.3], 24, p=[0.4, 0.15, 0.15, 0.15, 0.15])
    speeds = random.choice([0.3, 0.4, 0.25, 0.0, -0.2], 24, p=[0.4, 0.3, 0.1, 0.1, 0.1])
    ends = [*[0] * 50, *[1] * 2200, *[0] * 50]
    smooth = np.ones(15) / 15.0
    speed, rate = (np.repeat(each, 100)[: len(ends)] * ends for each in (speeds, rates))
    return np.convolve(speed, smooth, "same"), np.convolve(rate, smooth, "same")


def steered(random: np.random.Generator, speed: Floats, rate: Floats, *, gyro: bool) -> Run:
    """A drive as commanded, of a robot whose base is 3 % wider; its counts scatter."""
    travel = np.stack([speed - 0.515 * BASE * rate, speed + 0.515 * BASE * rate]) * STEP
    counted = travel + 5e-4 * np.sqrt(np.abs(travel)) * random.standard_normal(travel.shape)
    counts = np.floor(np.cumsum(counted, axis=1) / (2.0 * np.pi * RADIUS) * TICKS)
    time = np.arange(speed.size) * STEP
    yaw = np.cumsum(rate) * STEP
    turned = np.diff(yaw, prepend=0.0)
    path = np.cumsum(speed * STEP * np.exp(1j * (yaw - 0.5 * turned)))
    if gyro:
        headings = np.cumsum(turned + 0.002 * STEP * random.standard_normal(yaw.size))
        unknown = np.full(yaw.size, np.nan)
        reference = Reference(time, unknown, unknown, headings, kind="incremental")
    else:
        rows = slice(0, None, 3)
        x, y, noise = random.standard_normal((3, time[rows].size))
        at = path[rows]
        reference = Reference(
            time[rows], at.real + 2e-3 * x, at.imag + 2e-3 * y, yaw[rows] + 3e-3 * noise
        )
    return Run("steered", Path("steered"), Ticks(time, counts[0], counts[1]), reference)


@pytest.mark.evidence
@pytest.mark.parametrize("seed", [5, 8])
def test_a_straight_course_that_is_kept_makes_no_law_of_the_turn_rate(seed: int) -> None:
    random = np.random.default_rng(seed)
    runs = [steered(random, *by_stick(random), gyro=True) for _ in range(3)]
    found = diagnose(runs, ENTERED, LIBRARY, BY_GYRO)
    assert found.verdict != "unknown"
    assert "track_width" in found.found


@pytest.mark.evidence
@pytest.mark.parametrize("seed", [1, 2])
def test_circles_at_one_speed_make_no_law_of_it(seed: int) -> None:
    random = np.random.default_rng(seed)
    ramp = np.clip(np.minimum(np.arange(3000), np.arange(3000)[::-1]) / 50.0, 0.0, 1.0)
    runs = [steered(random, 0.3 * ramp, side * 0.5 * ramp, gyro=False) for side in (1, -1, 1)]
    found = diagnose(runs, ENTERED, LIBRARY)
    assert found.verdict != "unknown"
    assert "track_width" in found.found


def test_no_piece_of_a_curve_lies_within_the_noise_of_what_it_goes_over() -> None:
    random = np.random.default_rng(1)
    two_speeds = np.repeat([0.1, 0.5], 5000) + 0.01 * random.standard_normal(10_000)
    knots = curve_knots(two_speeds, 0.01)
    for low, high in itertools.pairwise(knots):
        assert np.std(two_speeds[(two_speeds >= low) & (two_speeds <= high)]) > 0.03
    assert (
        curve_knots(np.linspace(0.0, 1.0, 1000), 0.001).size
        == curve_knots(np.linspace(0.0, 1.0, 1000)).size
    )
