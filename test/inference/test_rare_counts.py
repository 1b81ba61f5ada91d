# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Counts that come rarely: what the wheels did between two messages is uncertain, and no law."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from test.evidence import in_evidence
from werrimbi_odom.effects import find
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.inference.legs.aligned_run import record_of
from werrimbi_odom.inference.legs.count_interpolation import Counters, counters_of
from werrimbi_odom.inference.legs.matched_run import divided
from werrimbi_odom.model.robot import Robot

ROBOT = Robot(0.35, 0.05, 2000.0, 2000.0)
STEP = 1e-3
LIBRARY = tuple(map(find, ("track_width", "unequal_wheel_radii", "lateral_slip", "castor_kick")))


def followed(command: np.ndarray, acceleration: float) -> np.ndarray:
    """A command as a motor follows it."""
    speed = np.zeros(command.size)
    for row in range(1, command.size):
        short = command[row] - speed[row - 1]
        speed[row] = speed[row - 1] + np.clip(short, -acceleration * STEP, acceleration * STEP)
    return speed


def driven(seed: int, hertz: float, seconds: int = 90) -> tuple[Run, np.ndarray]:
    """Hard starts and stops, turns at once; and the travel of both wheels at 1 kHz in counts."""
    random = np.random.default_rng(seed)
    lasts = random.integers(700, 2500, seconds)
    stands = random.random(seconds) < 0.25
    speed = np.repeat(np.where(stands, 0.0, random.uniform(-0.2, 0.5, seconds)), lasts)
    rate = np.repeat(random.uniform(-1.2, 1.2, seconds) * (random.random(seconds) < 0.6), lasts)
    speed, rate = (each[: 1000 * seconds] for each in (speed, rate))
    speed, rate = followed(speed, 3.0), followed(rate, 12.0)
    travel = np.stack([speed - 0.175 * rate, speed + 0.175 * rate]) * STEP
    counts = np.cumsum(travel, axis=1) / ROBOT.left_tick
    real = travel + 3e-4 * np.sqrt(np.abs(travel)) * random.standard_normal(travel.shape)
    turned = (real[1] - real[0]) / ROBOT.track
    yaw = np.cumsum(turned)
    path = np.cumsum(real.mean(axis=0) * np.exp(1j * (yaw - 0.5 * turned)))
    time = STEP * np.arange(speed.size)
    rows, seen = slice(7, None, round(1000 / hertz)), slice(13, None, 50)
    x, y, angle = random.standard_normal((3, time[seen].size))
    reference = Reference(
        time[seen], path[seen].real + 1e-3 * x, path[seen].imag + 1e-3 * y, yaw[seen] + 2e-3 * angle
    )
    ticks = Ticks(time[rows], np.floor(counts[0, rows]), np.floor(counts[1, rows]))
    return Run(f"run_{seed}", Path("run"), ticks, reference), counts


def missed(counters: Counters, counts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Errors of interpolated counts anywhere, and what is stated for them."""
    rows = np.arange(500, counts.shape[1] - 500, 17)
    time = STEP * rows
    error = counters.at(time) - (counts[:, rows] - counts[:, [7]]).T
    return error - np.median(error), counters.unseen_at(time)


@pytest.mark.parametrize("seed", [0, *map(in_evidence, (1, 2, 3))])
@pytest.mark.parametrize("hertz", [2.0, in_evidence(5.0), 10.0])
def test_what_is_missed_between_messages_is_stated(seed: int, hertz: float) -> None:
    run, counts = driven(seed, hertz)
    error, stated = missed(counters_of(run, ROBOT, None), counts)
    deviation = np.abs(error) / np.hypot(stated, 0.4)
    assert np.quantile(deviation, 0.99) < 3.0
    large = stated > 3.0
    assert 0.1 < np.sqrt(np.mean(deviation[large] ** 2)) < 1.2


def test_nothing_is_stated_at_usual_rates() -> None:
    run, _ = driven(1, 20.0)
    counters = counters_of(run, ROBOT, None)
    assert not counters.unseen_at(counters.time + 0.02).any()
    assert not counters.within.size


def test_steps_end_within_rare_messages() -> None:
    run, _ = driven(1, 5.0)
    record = record_of(run, ROBOT)
    legs = divided(record, np.arange(0, record.measured.time.size, 100))
    assert np.diff(legs.time).max() < 0.075
    counted = legs.counters.at(legs.time[[0, -1]])
    assert legs.left.sum() == pytest.approx(np.diff(counted[:, 0])[0])


@pytest.mark.evidence
def test_hard_starts_between_rare_counts_are_no_events_and_no_law() -> None:
    """Something was said to be missing, in others the reference to jump at thirty of them."""
    found = diagnose([driven(20 + each, 5.0)[0] for each in range(3)], ROBOT, LIBRARY)
    assert found.verdict == "none"
    assert not found.happened.events
