# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A timer that is uneven by some milliseconds is known by both wheels; an even one stays even."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from werrimbi_odom.files.run import Run, Ticks
from werrimbi_odom.inference.legs.count_interpolation import counters_of
from werrimbi_odom.inference.legs.uneven_timer import with_uneven_timer
from werrimbi_odom.model.robot import Robot

PERIOD = 0.05


def speeds(random: np.random.Generator, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Of both wheels, in turns a second: lines, arcs, spins and rests, at 0.5 m/s² in between."""
    manoeuvres = 1 + int(time[-1] // 4.0)
    forth, turn = random.uniform(-1.0, 1.5, manoeuvres), random.uniform(-0.8, 0.8, manoeuvres)
    forth[random.random(manoeuvres) < 0.2] = 0.0
    turn[random.random(manoeuvres) < 0.4] = 0.0
    asked = np.array([forth - turn, forth + turn])[:, (time // 4.0).astype(int)]
    step = 1.6 * (time[1] - time[0])
    for number in range(1, time.size):
        before = asked[:, number - 1]
        asked[:, number] = before + np.clip(asked[:, number] - before, -step, step)
    return asked[0], asked[1]


def counted(
    read: np.ndarray, per_turn: float, seed: int, shake: float = 0.0
) -> tuple[np.ndarray, np.ndarray]:
    """Counts at the times of reading; one wheel's speed may `shake` five times a second."""
    time = np.arange(0.0, read[-1] + 0.1, 2e-3)
    left, right = (2e-3 * np.cumsum(speed) for speed in speeds(np.random.default_rng(seed), time))
    right = right + shake * np.sin(31.0 * time)
    return tuple(np.floor(per_turn * np.interp(read, time, turns)) for turns in (left, right))


def scatter(found: np.ndarray, read: np.ndarray) -> float:
    return float(np.std(found - read))


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("uneven", [1e-3, 2e-3, 4e-3])
def test_the_readings_of_an_uneven_timer_are_moved_to_when_they_were_made(
    uneven: float, seed: int
) -> None:
    even = PERIOD * np.arange(1.0, 2000.0)
    read = even + np.random.default_rng(seed).normal(0.0, uneven, even.size)
    found = with_uneven_timer(even, *counted(read, 2000.0, seed))
    assert (np.diff(found) > 0.0).all()
    assert scatter(found, read) < 0.85 * scatter(even, read)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("per_turn", [100.0, 2000.0])
def test_the_readings_of_an_even_timer_stay(per_turn: float, seed: int) -> None:
    even = PERIOD * np.arange(1.0, 2000.0)
    assert scatter(with_uneven_timer(even, *counted(even, per_turn, seed)), even) < 0.1e-3


def test_counters_that_bring_few_counts_at_a_time_do_not_tell_of_the_timer() -> None:
    """By their steps, which came at once, an even timer seemed uneven by 1.6 ms."""
    even = PERIOD * np.arange(1.0, 2000.0)
    random = np.random.default_rng(2)
    came = even + random.uniform(0.0, 6e-3, even.size)
    left, right = (side.astype(np.int64) for side in counted(even, 48.0, 2))
    run = Run("run", Path("run"), Ticks(came, left, right), None)
    found = counters_of(run, Robot(0.35, 0.05, 48, 48), None)
    assert found.restamped > 0.0
    assert scatter(found.time, even) < 0.5e-3


def test_one_wheel_that_shakes_is_no_uneven_timer() -> None:
    """What the one wheel says of the timer, the other must bear out."""
    even = PERIOD * np.arange(1.0, 2000.0)
    assert with_uneven_timer(even, *counted(even, 2000.0, 1, shake=5e-3)) is even


def test_across_a_gap_nothing_is_known_of_the_timer() -> None:
    """The counts of two seconds look like one step, by which no reading may be moved."""
    even = PERIOD * np.arange(1.0, 2000.0)
    even = even[(even < 30.0) | (even > 32.0)]
    read = even + np.random.default_rng(0).normal(0.0, 2e-3, even.size)
    found = with_uneven_timer(even, *counted(read, 2000.0, 0))
    beside = np.abs(even - 31.0) < 1.2
    assert np.abs(found - even)[beside].max() < 8e-3
    assert scatter(found, read) < 0.85 * scatter(even, read)
