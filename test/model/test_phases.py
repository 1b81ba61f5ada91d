# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The phase of an eccentric wheel is learnt from a measured heading, and so is how surely."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from test.model.drives import ROBOT, Ticks, random_drive, read
from werrimbi_odom.effects import find
from werrimbi_odom.model.odometer import Odometer
from werrimbi_odom.model.phase_learner import PhaseLearner
from werrimbi_odom.model.phases import (
    KNOWN_WELL_ENOUGH,
    Phase,
    learnable,
    phases_of_run,
)
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.trajectory import trajectory

AMPLITUDE = 8e-4
LEFT, RIGHT = find("eccentric_left_wheel"), find("eccentric_right_wheel")
UNKNOWN = replace(ROBOT, effects=(LEFT.using(amplitude=AMPLITUDE),))


def true_robot(phase: float) -> Robot:
    return replace(ROBOT, effects=(LEFT.using(amplitude=AMPLITUDE, phase=phase),))


def drive(seed: int = 1, seconds: float = 60.0) -> Ticks:
    return random_drive(seed, rate=20.0, duration=seconds)


def gyro_heading(
    ticks: Ticks, true: Robot, chance: np.random.Generator, bias: float = 0.02, noise: float = 1e-3
) -> np.ndarray:
    """A gyro's rate summed up: heading with a bias [rad/s] and a random walk [rad/s^0.5]."""
    steps = np.diff(ticks.time, prepend=ticks.time[0])
    walk = np.cumsum(chance.normal(0.0, noise * np.sqrt(steps)))
    return trajectory(true, *ticks).yaw + bias * (ticks.time - ticks.time[0]) + walk


def learnt(ticks: Ticks, yaw: np.ndarray, robot: Robot = UNKNOWN) -> tuple[Phase, ...]:
    return phases_of_run(robot, *ticks, ticks.time, yaw)


def off(phase: Phase, true: float) -> float:
    return math.remainder(phase.value - true, 2.0 * math.pi)


@pytest.mark.parametrize("true", [-3.0, -1.0, 0.0, 2.0])
def test_a_perfect_heading_tells_the_phase_to_the_resolution_of_the_counters(true: float) -> None:
    ticks = drive()
    (phase,) = learnt(ticks, trajectory(true_robot(true), *ticks).yaw)
    assert (phase.effect, phase.parameter) == ("eccentric_left_wheel", "phase")
    assert abs(off(phase, true)) < 1e-6
    assert phase.amplitude == pytest.approx(AMPLITUDE, rel=1e-6)


def test_what_it_says_of_its_own_error_is_true() -> None:
    """Over many gyros the errors are as large as the deviations that are told, or smaller."""
    scores = []
    for seed in range(40):
        chance = np.random.default_rng(seed)
        ticks, true = drive(seed, 40.0), chance.uniform(-math.pi, math.pi)
        (phase,) = learnt(ticks, gyro_heading(ticks, true_robot(true), chance))
        assert phase.std < KNOWN_WELL_ENOUGH
        scores.append(off(phase, true) / phase.std)
    # 40 scores of unit variance have a root mean square of 1 ± 0.11
    assert 0.67 < np.sqrt(np.mean(np.square(scores))) < 1.33


def test_a_bias_and_a_wrong_base_are_not_taken_for_the_wheel() -> None:
    ticks, true = drive(), 1.0
    yaw = gyro_heading(ticks, true_robot(true), np.random.default_rng(3), bias=0.05)
    believed = replace(UNKNOWN, wheel_separation_multiplier=1.02)
    (phase,) = learnt(ticks, yaw, believed)
    assert phase.std < KNOWN_WELL_ENOUGH
    assert abs(off(phase, true)) < 3.0 * phase.std


def test_poses_from_a_camera_tell_it_too() -> None:
    """Absolute headings with noise of their own: differences of them are anticorrelated."""
    ticks, true, chance = drive(), -2.0, np.random.default_rng(4)
    noise = chance.normal(0.0, 2e-3, ticks.time.size)
    (phase,) = learnt(ticks, trajectory(true_robot(true), *ticks).yaw + noise)
    assert phase.std < KNOWN_WELL_ENOUGH
    assert abs(off(phase, true)) < 3.0 * phase.std


def test_two_wheels_are_told_apart() -> None:
    ticks, chance = drive(seconds=120.0), np.random.default_rng(5)
    phases = (0.7, -2.5)
    effects = [
        each.using(amplitude=AMPLITUDE, phase=phase)
        for each, phase in zip((LEFT, RIGHT), phases, strict=True)
    ]
    yaw = gyro_heading(ticks, replace(ROBOT, effects=tuple(effects)), chance)
    unknown = (LEFT.using(amplitude=AMPLITUDE), RIGHT.using(amplitude=AMPLITUDE))
    found = learnt(ticks, yaw, replace(ROBOT, effects=unknown))
    for phase, true in zip(found, phases, strict=True):
        assert phase.std < KNOWN_WELL_ENOUGH
        assert abs(off(phase, true)) < 3.0 * phase.std


def test_nothing_is_learnt_at_rest_nor_from_a_wheel_that_is_round() -> None:
    rest = read(ROBOT, 20.0, np.zeros(1200), np.zeros(1200))
    noise = np.random.default_rng(6).normal(0.0, 1e-3, rest.time.size)
    assert learnt(rest, noise)[0].std == math.inf
    ticks = drive()
    yaw = gyro_heading(ticks, ROBOT, np.random.default_rng(7), noise=3e-3)
    assert learnt(ticks, yaw)[0].std > KNOWN_WELL_ENOUGH


def test_a_reference_that_jumps_is_left_out_there() -> None:
    ticks, true = drive(), 0.3
    yaw = gyro_heading(ticks, true_robot(true), np.random.default_rng(8))
    jumped = yaw + np.where(ticks.time > 30.0, 2.0, 0.0)
    (phase,) = learnt(ticks, jumped)
    assert abs(off(phase, true)) < 3.0 * phase.std
    assert phase.std < KNOWN_WELL_ENOUGH


def test_learnable_is_what_lacks_its_phase_alone() -> None:
    known = LEFT.using(amplitude=AMPLITUDE, phase=0.1)
    round_wheel = RIGHT.using()
    slip = find("lateral_slip").using(creep=0.01)
    assert learnable(replace(ROBOT, effects=(known, round_wheel, slip))) == ()
    assert learnable(UNKNOWN) == UNKNOWN.effects


# ------------------------------------------------------------------------ live


def learner_after(
    ticks: Ticks,
    readings: list[tuple[float, float]],
    *,
    late: int = 0,
    rate: bool = False,
    times: int = 1,
) -> PhaseLearner:
    """Feed steps and readings in the order of time, the readings some rows late, or repeated."""
    odometer, learner = Odometer(UNKNOWN), PhaseLearner(UNKNOWN)
    see = learner.see_rate if rate else learner.see_yaw
    for row, message in enumerate(zip(*(column.tolist() for column in ticks), strict=True)):
        if odometer.update(*message) is not None and odometer.driven_step is not None:
            learner.step(message[0], odometer.driven_step)
        if row >= late:
            for _ in range(times):
                see(*readings[row - late])
    return learner


@pytest.mark.parametrize("late", [0, 4])
def test_live_it_learns_what_the_record_tells(late: int) -> None:
    """From yaws stamped between the rows, in time or late."""
    ticks = drive()
    yaw = gyro_heading(ticks, true_robot(1.0), np.random.default_rng(9))
    at = ticks.time + 0.013
    between = np.interp(at, ticks.time, yaw)
    kept = slice(1, ticks.time.size - 1 - late)
    learner = learner_after(ticks, list(zip(at.tolist(), between.tolist(), strict=True)), late=late)
    (live,) = learner.phases()
    (recorded,) = phases_of_run(UNKNOWN, *ticks, at[kept], between[kept])
    assert live.value == pytest.approx(recorded.value, abs=0.3 * recorded.std)
    assert live.std == pytest.approx(recorded.std, rel=0.05)
    assert abs(off(live, 1.0)) < 3.0 * live.std


def test_live_from_the_rates_of_a_gyro() -> None:
    ticks, chance = drive(), np.random.default_rng(10)
    true = trajectory(true_robot(-1.3), *ticks)
    rates = (
        np.append(np.diff(true.yaw) * 20.0, 0.0) + 0.03 + chance.normal(0.0, 0.005, true.yaw.size)
    )
    at = ticks.time + 0.025  # a rate is the mean of the step around its stamp
    learner = learner_after(ticks, list(zip(at.tolist(), rates.tolist(), strict=True)), rate=True)
    (phase,) = learner.phases()
    assert phase.std < KNOWN_WELL_ENOUGH
    assert abs(off(phase, -1.3)) < 3.0 * phase.std


def test_a_gyro_whose_messages_come_twice_tells_it_too() -> None:
    ticks = drive()
    rates = np.append(np.diff(trajectory(true_robot(-1.3), *ticks).yaw) * 20.0, 0.0)
    told = list(zip((ticks.time + 0.025).tolist(), rates.tolist(), strict=True))
    once, twice = (learner_after(ticks, told, rate=True, times=times) for times in (1, 2))
    assert once.phases() == twice.phases()
    assert once.phases()[0].std < KNOWN_WELL_ENOUGH


@pytest.mark.filterwarnings("error")
def test_nothing_is_learnt_of_a_wheel_that_stands_while_the_other_turns() -> None:
    ticks = drive()
    still = Ticks(ticks.time, np.zeros_like(ticks.left), ticks.right)
    yaw = trajectory(UNKNOWN, *still).yaw + np.random.default_rng(3).normal(
        0.0, 1e-3, still[0].size
    )
    (phase,) = learnt(still, yaw)
    assert (phase.std, phase.amplitude) == (math.inf, 0.0)


def test_a_gap_of_the_gyro_is_not_bridged() -> None:
    """What it did not see would otherwise be taken for an error of the wheel."""
    ticks = drive()
    true = trajectory(true_robot(0.5), *ticks)
    rates = np.append(np.diff(true.yaw) * 20.0, 0.0)
    readings = list(zip((ticks.time + 0.025).tolist(), rates.tolist(), strict=True))
    for row in range(300, 340):
        readings[row] = (math.nan, math.nan)
    (phase,) = learner_after(ticks, readings, rate=True).phases()
    assert phase.std < KNOWN_WELL_ENOUGH
    assert abs(off(phase, 0.5)) < 3.0 * phase.std


def test_what_was_learnt_survives_other_values_of_the_robot() -> None:
    ticks = drive()
    yaw = gyro_heading(ticks, true_robot(1.0), np.random.default_rng(11))
    learner = learner_after(ticks, list(zip(ticks.time.tolist(), yaw.tolist(), strict=True)))
    (before,) = learner.phases()
    learner.retune(replace(true_robot(1.0), wheel_separation_multiplier=1.01))
    assert learner.phases() == (before,)
    assert learner.effects[0].unknown == ("phase",)


def test_its_memory_does_not_grow() -> None:
    """Steps without a reference, and readings of a time that never comes."""
    ticks = drive()
    odometer, learner = Odometer(UNKNOWN), PhaseLearner(UNKNOWN)
    for message in zip(*(column.tolist() for column in ticks), strict=True):
        if odometer.update(*message) is not None and odometer.driven_step is not None:
            learner.step(message[0], odometer.driven_step)
            learner.see_yaw(1e9, 0.0)
    assert len(learner._nodes) == len(learner._waiting) == learner.MEMORY


def test_a_clock_that_is_set_back_costs_one_interval() -> None:
    """Readings that wait for a time that does not come again are in nobody's way."""
    ticks = drive()
    back = np.where(np.arange(ticks.time.size) < 200, ticks.time, ticks.time - 7.0)
    yaw = gyro_heading(ticks, true_robot(1.0), np.random.default_rng(12))
    readings = list(zip((back + 0.01).tolist(), yaw.tolist(), strict=True))
    (phase,) = learner_after(Ticks(back, ticks.left, ticks.right), readings).phases()
    assert phase.std < KNOWN_WELL_ENOUGH
    assert abs(off(phase, 1.0)) < 3.0 * phase.std + 0.01 * 14.0  # the yaws are 10 ms late
