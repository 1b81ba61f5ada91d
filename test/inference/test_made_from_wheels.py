# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A reference that is made from the wheels is refused; one that was measured never is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from test.evidence import in_evidence
from test.inference.driven import of_headings
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.inference.comparison.made_from_wheels import closeness, require_independent
from werrimbi_odom.inference.legs.count_interpolation import counters_of
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.trajectory import trajectory

ROBOT = Robot(0.16, 0.033, 4096.0, 4096.0)
OTHER = Robot(0.18, 0.0335, 4096.0, 4096.0)
"""What a driver's own odometry may take the robot for."""
SEEDS = pytest.mark.parametrize("seed", [0, 1, *(in_evidence(seed) for seed in (2, 3))])
NAMED = "/odom: odom -> base_link is the robot's own odometry, made from its wheels"


@cache
def driven(seed: int, seconds: float = 60.0, per_second: float = 200.0) -> tuple[np.ndarray, ...]:
    """Time, exact counts of both wheels, and where the robot truly was."""
    rng = np.random.default_rng(seed)
    time = np.arange(0.0, seconds, 1.0 / per_second)
    knots = np.linspace(0.0, seconds, int(seconds))
    speeds = rng.uniform(-1500.0, 4000.0, (2, knots.size))
    left, right = (np.cumsum(np.interp(time, knots, each)) / per_second for each in speeds)
    path = trajectory(ROBOT, time, left, right)
    return time, left, right, path.x, path.y, path.yaw


@cache
def recorded(seed: int, per_second: float = 20.0, seconds: float = 60.0) -> tuple[Run, np.ndarray]:
    """Whole counts at 20 Hz, and the true poses at 10 Hz, between the counts' stamps."""
    time, left, right, x, y, yaw = driven(seed, seconds)
    at = np.arange(0.0, seconds - 0.2, 1.0 / per_second)
    counts = [np.rint(np.interp(at, time, each)).astype(np.int64) for each in (left, right)]
    seen = np.arange(0.013, seconds - 0.3, 0.1)
    truth = np.stack([np.interp(seen, time, each) for each in (x, y, yaw)])
    run = Run("run", Path("run"), Ticks(at, *counts), Reference(seen, *truth))
    return run, truth


def own_odometry(run: Run, robot: Robot) -> Reference:
    """What a driver makes of the counts, at their stamps."""
    ticks = run.ticks
    path = trajectory(robot, ticks.time, ticks.left, ticks.right)
    return Reference(ticks.time, path.x, path.y, path.yaw)


@SEEDS
@pytest.mark.parametrize("robot", [ROBOT, OTHER])
def test_odometry_is_refused_by_its_numbers_alone(seed: int, robot: Robot) -> None:
    run, _ = recorded(seed)
    circle = replace(run, reference=own_odometry(run, robot))
    with pytest.raises(InputError, match="it was made from the same counts"):
        require_independent(circle, ROBOT)


@pytest.mark.parametrize("per_second", [5.0, 10.0])
def test_odometry_that_goes_along_chords_is_refused_too(per_second: float) -> None:
    """Many drivers add to x and y by the heading between two messages, whatever the turn."""
    run, _ = recorded(0, per_second)
    left, right = (
        np.diff(counts) * ROBOT.left_tick for counts in (run.ticks.left, run.ticks.right)
    )
    yaw = np.concatenate([[0.0], np.cumsum((right - left) / ROBOT.track)])
    way = 0.5 * (left + right) * np.exp(0.5j * (yaw[1:] + yaw[:-1]))
    place = np.concatenate([[0j], np.cumsum(way)])
    circle = replace(run, reference=Reference(run.ticks.time, place.real, place.imag, yaw))
    with pytest.raises(InputError, match="it was made from the same counts"):
        require_independent(circle, ROBOT)


@SEEDS
def test_odometry_that_is_logged_in_millimetres_is_refused_by_its_headings(seed: int) -> None:
    """A firmware's own pose in its log: a path of whole millimetres is longer than the way."""
    run, _ = recorded(seed)
    own = own_odometry(run, OTHER)
    logged = Reference(own.time, own.x.round(3), own.y.round(3), own.yaw.round(5))
    with pytest.raises(InputError, match=r"its headings agree with the wheels to .* same counts"):
        require_independent(replace(run, reference=logged), ROBOT)


def test_a_heading_that_is_missing_hides_no_circle_of_headings() -> None:
    """After it all turns of the drive were unknown."""
    run, _ = recorded(1, seconds=180.0)
    own = own_odometry(run, OTHER)
    yaw = own.yaw.round(5)
    yaw[yaw.size // 8 : yaw.size // 6] = np.nan
    logged = Reference(own.time, own.x.round(3), own.y.round(3), yaw)
    with pytest.raises(InputError, match="its headings agree"):
        require_independent(replace(run, reference=logged), ROBOT)


@SEEDS
def test_odometry_has_the_stamps_of_its_wheels_right_or_wrong(seed: int) -> None:
    """Wheels whose stamps scatter by 4 ms are put right for a measurement, and not for this."""
    run, _ = recorded(seed)
    late = np.random.default_rng(seed).normal(0.0, 4e-3, run.ticks.rows)
    scattered = replace(run, ticks=replace(run.ticks, time=np.sort(run.ticks.time + late)))
    circle = replace(run, ticks=scattered.ticks, reference=own_odometry(scattered, ROBOT))
    assert counters_of(circle, ROBOT, None).restamped > 2e-3
    with pytest.raises(InputError, match="it was made from the same counts"):
        require_independent(circle, ROBOT)


@SEEDS
@pytest.mark.parametrize("noise", [0.0, 0.0002, 0.001, 0.01])
def test_what_was_measured_is_never_refused(seed: int, noise: float) -> None:
    """Not even perfect poses: counts round off what they do not see."""
    assert_never_refused(*recorded(seed), noise, seed)


@SEEDS
@pytest.mark.parametrize("counts_apart", [0.0, 0.3, 1.0, 3.0])
@pytest.mark.parametrize("per_turn", [64.0, 4096.0])
def test_a_straight_drive_is_never_refused(seed: int, counts_apart: float, per_turn: float) -> None:
    """Its headings are noise, and what its wheels roll apart is rounding, or a few counts."""
    random = np.random.default_rng(seed)
    robot = replace(ROBOT, left_ticks_per_revolution=per_turn, right_ticks_per_revolution=per_turn)
    time = np.arange(0.0, 40.0, 0.05)
    rolled = 0.3 * time / robot.left_tick
    # Apart by some counts in each stretch of a few tens of centimetres, to and fro.
    apart = counts_apart * np.sin(2.0 * np.pi * 0.3 * time / 0.5)
    counts = [np.rint(each).astype(np.int64) for each in (rolled - apart, rolled + apart)]
    place = np.stack([0.3 * time, np.zeros_like(time)]) + random.normal(0.0, 1e-3, (2, time.size))
    seen = Reference(time, *place, random.normal(0.0, 2e-3, time.size))
    require_independent(Run("run", Path("run"), Ticks(time, *counts), seen), robot)


@SEEDS
@pytest.mark.parametrize("turn_rates", [(0.0, 0.4), (0.31,), (0.2, -0.37)])
def test_a_steady_drive_is_never_refused(seed: int, turn_rates: Sequence[float]) -> None:
    """A square, a circle, an eight by counters of 64 steps, read as often as the poses are.

    On a line wheels in step round off the same, and equal parts of a steady arc do too.
    """
    random = np.random.default_rng(seed)
    robot = replace(ROBOT, left_ticks_per_revolution=64.0, right_ticks_per_revolution=64.0)
    time = np.arange(0.0, 60.0, 0.1)
    rate = np.array(turn_rates)[(time / 6.0).astype(int) % len(turn_rates)]
    speed = np.where(rate == 0.4, 0.0, 0.2)
    sides = [np.cumsum(speed + side * 0.5 * robot.track * rate) * 0.1 for side in (-1.0, 1.0)]
    counts = [side / robot.left_tick + random.uniform() for side in sides]
    path = trajectory(robot, time, *counts)
    ticks = Ticks(time, *(np.floor(each).astype(np.int64) for each in counts))
    noise = random.normal(0.0, 1.0, (3, time.size))
    seen = Reference(
        time, path.x + 2e-4 * noise[0], path.y + 2e-4 * noise[1], path.yaw + 5e-4 * noise[2]
    )
    require_independent(Run("run", Path("run"), ticks, seen), robot)


@SEEDS
def test_what_is_closer_than_wheels_roll_is_suspect_and_not_refused(seed: int) -> None:
    """Way and turns between the poses of a filter, turned back into two wheels, judged by it."""
    time, left, right, *_ = driven(seed)
    run, truth = recorded(seed)
    at = run.reference.time
    counts = [np.rint(np.interp(at, time, each)).astype(np.int64) for each in (left, right)]
    seen = Run("run", Path("run"), Ticks(at, *counts), Reference(at, *truth))
    assert "closer than any wheels follow the floor" in require_independent(seen, ROBOT)
    gyro = truth[2] + np.random.default_rng(seed).normal(0.0, 1e-3, at.size)
    measured = replace(seen, reference=Reference(at, *truth[:2], gyro))
    assert require_independent(measured, ROBOT) == "", "headings that were measured"


@pytest.mark.parametrize("factor", [1000.0, 100.0, 0.01, 0.001])
def test_a_radius_in_another_unit_makes_no_circle_of_a_measurement(factor: float) -> None:
    run, truth = recorded(1)
    wrong = replace(ROBOT, wheel_radius=factor * ROBOT.wheel_radius)
    noise = np.random.default_rng(1).normal(0.0, 3e-4, truth.shape)
    measured = replace(run, reference=Reference(run.reference.time, *(truth + noise)))
    assert require_independent(measured, wrong) == ""


@pytest.mark.parametrize("factor", [1000.0, 0.001])
def test_a_radius_in_another_unit_hides_no_circle(factor: float) -> None:
    run, _ = recorded(1)
    circle = replace(run, reference=own_odometry(run, ROBOT))
    with pytest.raises(InputError, match="it was made from the same counts"):
        require_independent(circle, replace(ROBOT, wheel_radius=factor * ROBOT.wheel_radius))


def assert_never_refused(run: Run, truth: np.ndarray, noise: float, seed: int) -> None:
    """As poses, and as positions alone."""
    rng = np.random.default_rng(seed)
    assert run.reference is not None
    x, y = (each + rng.normal(0.0, noise, each.size) for each in truth[:2])
    for yaw in (truth[2], np.full(x.size, np.nan)):
        measured = replace(run, reference=Reference(run.reference.time, x, y, yaw))
        said = require_independent(measured, ROBOT)
        assert said == "" or noise == 0.0


def unrounded(seed: int) -> tuple[Run, np.ndarray]:
    """Angles as a simulator has them, without counts, and the true poses between their stamps."""
    time, left, right, x, y, yaw = driven(seed)
    every = slice(None, None, 10)
    seen = np.arange(0.013, 59.0, 0.1)
    truth = np.stack([np.interp(seen, time, each) for each in (x, y, yaw)])
    ticks = Ticks(time[every], left[every], right[every])
    return Run("run", Path("run"), ticks, Reference(seen, *truth)), truth


@SEEDS
@pytest.mark.parametrize("robot", [ROBOT, OTHER])
def test_odometry_from_angles_without_counts_is_refused_by_its_numbers(
    seed: int, robot: Robot
) -> None:
    """Whatever its topic is called: a reference.csv has no name at all."""
    run, _ = unrounded(seed)
    odometry = own_odometry(run, robot)
    between = np.arange(0.007, 59.0, 0.033)
    parts = (odometry.x, odometry.y, odometry.yaw)
    sent = Reference(between, *(np.interp(between, odometry.time, part) for part in parts))
    for reference in (odometry, odometry.chosen(np.arange(odometry.time.size) % 3 == 1), sent):
        circle = replace(run, reference=reference)
        with pytest.raises(InputError, match="closer than anything measures"):
            require_independent(circle, ROBOT)


@SEEDS
@pytest.mark.parametrize("noise", [0.0002, 0.001, 0.01])
def test_what_was_measured_of_angles_without_counts_is_never_refused(
    seed: int, noise: float
) -> None:
    assert_never_refused(*unrounded(seed), noise, seed)


def test_a_filter_is_refused_by_its_name_and_by_being_close() -> None:
    """It lags by two messages, by more or less, and has the heading of a gyro."""
    run, _ = recorded(5)
    odometry = own_odometry(run, OTHER)
    yaw = odometry.yaw * 1.03 + 0.01 * odometry.time
    steps = np.diff(odometry.x) + 1j * np.diff(odometry.y)
    along = (steps * np.exp(-1j * (odometry.yaw[:-1] + 0.5 * np.diff(odometry.yaw)))).real
    steps = along * np.exp(1j * (yaw[:-1] + 0.5 * np.diff(yaw)))
    path = np.concatenate([[0.0], np.cumsum(steps)])
    late = odometry.time + 0.1 + np.random.default_rng(5).uniform(0.0, 0.02, odometry.time.size)
    x, y, yaw = (np.interp(odometry.time, late, each) for each in (path.real, path.imag, yaw))
    circle = replace(
        run, reference=Reference(odometry.time, x, y, yaw), circle=f"/odometry/filtered: {NAMED}"
    )
    with pytest.raises(InputError) as caught:
        require_independent(circle, ROBOT)
    assert "shows none of their errors (--force takes it all the same)" in str(caught.value)


def test_a_measurement_that_is_called_odometry_is_taken_and_said() -> None:
    """A scan matcher that publishes on /odom: 2 cm of noise are no odometry's."""
    run, truth = recorded(6)
    rng = np.random.default_rng(6)
    assert run.reference is not None
    x, y = (each + rng.normal(0.0, 0.02, each.size) for each in truth[:2])
    called = replace(
        run, reference=Reference(run.reference.time, x, y, truth[2]), circle=f"/odom: {NAMED}"
    )
    assert "it is taken for a measurement" in require_independent(called, ROBOT)


def test_too_little_to_tell_leaves_the_name() -> None:
    run, _ = recorded(7)
    assert run.reference is not None
    few = replace(run, reference=run.reference.chosen(np.arange(597) < 5))
    assert closeness(few, ROBOT) is None
    assert require_independent(few, ROBOT) == ""
    with pytest.raises(InputError, match="made from its wheels"):
        require_independent(replace(few, circle=f"/odom: {NAMED}"), ROBOT)


def test_a_gyro_is_no_circle() -> None:
    run, truth = recorded(8)
    assert run.reference is not None
    gyro = replace(run, reference=of_headings(run.reference.time, truth[2]))
    assert require_independent(gyro, ROBOT) == ""
