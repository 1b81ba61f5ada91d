# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Counters that leap: found where they do, and nowhere else."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from test.inference.driven import of_headings
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Run, Ticks
from werrimbi_odom.inference.comparison.compare import compare
from werrimbi_odom.inference.legs.aligned_run import record_of
from werrimbi_odom.inference.legs.count_interpolation import counters_of
from werrimbi_odom.model.robot import Robot

ROBOT = Robot(0.3, 0.05, 1000.0, 1000.0)
INCREMENTAL = EvaluationOptions(reference_kind="incremental")
TIME = 0.05 * np.arange(400)


def driven(seed: int = 1) -> np.ndarray:
    """Two counters of a robot that drives at up to 2 turns a second, with stops."""
    rng = np.random.default_rng(seed)
    speed = np.repeat(rng.uniform(-2000.0, 2000.0, (20, 2)), 20, axis=0)
    speed[100:160] = 0.0
    return np.rint(np.cumsum(0.05 * speed, axis=0))


def run_of(counts: np.ndarray, time: np.ndarray = TIME) -> Run:
    reference = of_headings(time, np.zeros(time.size))
    return Run("run", Path("run"), Ticks(time, counts[:, 0], counts[:, 1]), reference)


def test_to_somewhere_and_back() -> None:
    counts = driven()
    leapt = counts.copy()
    leapt[250, 1] += 190_000.0  # 60 m for one message
    found = counters_of(run_of(leapt), ROBOT, None)
    ((begin, end, words),) = found.leaps
    assert (begin, end) == (pytest.approx(12.45), pytest.approx(12.55))
    assert words.startswith("the right counter leapt by 59.7 m and came back")
    assert 250 * 0.05 not in found.time
    np.testing.assert_allclose(found.right[-1], counts[-1, 1] - counts[0, 1])
    np.testing.assert_allclose(found.left[-1], counts[-1, 0] - counts[0, 0])


def test_for_good() -> None:
    counts = driven()
    leapt = counts.copy()
    leapt[250:, 0] -= 190_000.0
    found = counters_of(run_of(leapt), ROBOT, None)
    assert len(found.leaps) == 1
    assert "came back" not in found.leaps[0][2]
    assert abs(found.left[-1] - (counts[-1, 0] - counts[0, 0])) < 110.0, "a message at 2 turns/s"


def test_it_is_left_out_of_what_is_judged() -> None:
    leapt = driven()
    leapt[250, 1] += 190_000.0
    record = record_of(run_of(leapt), ROBOT)
    assert [(each.why, round(each.begin, 2)) for each in record.left_out] == [("counter", 12.45)]
    assert record.gap[
        (record.measured.time[:-1] >= 12.44) & (record.measured.time[1:] <= 12.56)
    ].all()


@pytest.mark.parametrize("seed", range(5))
def test_driving_is_no_leap(seed: int) -> None:
    """Fast starts after creeping, stamps that come in bursts, a silence of the ticks."""
    rng = np.random.default_rng(seed)
    counts = driven(seed)
    counts[:340] *= 0.02
    counts[340:] += counts[339] - counts[340]
    time = np.sort(TIME + rng.uniform(-0.024, 0.024, TIME.size))
    time[200:] += 5.0
    assert counters_of(run_of(np.rint(counts), time), ROBOT, None).leaps == ()


def by_gyro(counts: np.ndarray, shown: np.ndarray) -> Run:
    """A run with the headings of these counts, whose counters showed others."""
    run = run_of(shown)
    assert run.reference is not None
    yaw = (counts[:, 1] - counts[:, 0]) * ROBOT.left_tick / ROBOT.track
    return replace(run, reference=replace(run.reference, yaw=yaw))


def gone(counts: np.ndarray) -> float:
    return float(np.abs(np.diff(counts.mean(axis=1))).sum()) * ROBOT.left_tick


@pytest.mark.parametrize("leap", [190_000.0, 0.0])
def test_it_is_no_distance_that_was_driven(leap: float) -> None:
    """A Roomba's compare said that it had driven 60 m more than it had."""
    counts = driven()
    leapt = counts.copy()
    leapt[250, 1] += leap
    (run,) = compare([by_gyro(counts, leapt)], ROBOT, INCREMENTAL).runs
    assert run.distance_m == pytest.approx(gone(counts), rel=0.02)


def test_a_counter_that_wraps_is_no_distance_that_was_driven() -> None:
    counts = driven()
    (run,) = compare(
        [by_gyro(counts, np.mod(counts, 2.0**16))], replace(ROBOT, encoder_bits=16), INCREMENTAL
    ).runs
    assert run.distance_m == pytest.approx(gone(counts), rel=0.02)


@pytest.mark.parametrize("side", [0, 1, slice(None)])
def test_a_reset_is_left_out_and_no_travel_is_lost(side: int | slice) -> None:
    """It was told as a slip of the wheels: what they turned in that message was left at nothing."""
    counts = np.rint(np.cumsum(np.full((400, 2), [60.0, 90.0]), axis=0))
    reset = counts.copy()
    reset[250:, side] -= reset[250, side]
    run = run_of(reset)
    ((begin, end, words),) = counters_of(run, ROBOT, None).leaps
    assert (begin, end) == (pytest.approx(12.45), pytest.approx(12.5))
    assert words.startswith("a counter fell to zero")
    found = counters_of(run, ROBOT, None)
    np.testing.assert_allclose(found.left[-1], counts[-1, 0] - counts[0, 0])
    np.testing.assert_allclose(found.right[-1], counts[-1, 1] - counts[0, 1])
    assert [each.why for each in record_of(run, ROBOT).left_out] == ["counter"]


@pytest.mark.parametrize("both", [False, True])
def test_a_board_that_starts_anew_in_a_silence_is_told_once(both: bool) -> None:
    """It was told as silent ticks, with a way that nobody counted, and as a counter at zero."""
    counts = np.rint(np.cumsum(np.full((400, 2), [60.0, 90.0]), axis=0))
    counts[250:] -= counts[250]
    heard = np.r_[0:220, 250:400]
    run = run_of(counts[heard], TIME[heard])
    if not both:
        run = replace(run, reference=of_headings(TIME, np.zeros(TIME.size)))
    (only,) = record_of(run, ROBOT).left_out
    who = "reference and ticks are" if both else "the ticks are"
    told = f"{who} silent, and a counter fell to zero, as where a driver starts anew"
    assert (only.why, only.words) == ("gap", told)
    assert (only.begin, only.end) == (pytest.approx(10.95), pytest.approx(12.5))
