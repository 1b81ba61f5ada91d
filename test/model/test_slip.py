# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Where a gyro contradicts the wheels the pose is less sure, by what was missed; else as before."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.model.slip import NOTHING, Missed, SlipGuard

ROBOT = Path(__file__).parents[2] / "config" / "robot.yaml"
TRACK, TICK = 0.35, 1.6e-4


def driven(turned: float, body: float, seconds: float = 2.0) -> tuple[SlipGuard, Missed]:
    """A turn of the wheels in which the body makes another; what is added in all."""
    guard, total = SlipGuard(TRACK, TICK), NOTHING
    for step in range(round((seconds + 2.0) * 100)):
        time = 0.01 * (step + 1)
        share = min(max((time - 1.0) / seconds, 0.0), 1.0)
        guard.gyro(time, body / seconds if 0.0 < share < 1.0 else 0.0)
        if step % 2:
            missed = guard.wheels(time, turned * share)
            total = Missed(total.along + missed.along, total.heading + missed.heading)
    return guard, total


@pytest.mark.parametrize(("turned", "body"), [(0.4, 0.0), (-0.4, 0.0), (1.5, 1.0), (0.0, 0.5)])
def test_the_heading_is_unsure_by_all_that_was_missed(turned: float, body: float) -> None:
    guard, total = driven(turned, body)
    away = abs(turned - body)
    assert guard.times == 1
    assert guard.missed == pytest.approx(away, rel=0.05)
    assert math.sqrt(total.heading) == pytest.approx(away, rel=0.05)
    assert math.sqrt(total.along) == pytest.approx(0.5 * TRACK * away, rel=0.05)


def test_a_gyro_whose_messages_come_twice_shows_the_slip_too() -> None:
    guard = SlipGuard(TRACK, TICK)
    for step in range(400):
        time = 0.01 * step
        for _ in range(2):
            guard.gyro(time, 0.0)
        guard.wheels(time, 0.4 * min(max(time - 1.0, 0.0), 1.0))
    assert (guard.times, guard.missed) == (1, pytest.approx(0.4, rel=0.05))


def test_a_slip_does_not_go_on_where_the_clock_is_set_back() -> None:
    """Wheels that spin twice as fast as the robot turns, in a bag that is played again."""
    guard, missed = SlipGuard(TRACK, TICK), 0.0
    for begin in (5000.0, 0.0):
        for step in range(200):
            time = begin + 0.01 * step
            guard.gyro(time, 0.5)
            missed += guard.wheels(time, 0.01 * step).heading
    assert guard.times == 2
    assert guard.missed == pytest.approx(2.0, rel=0.05)
    assert missed == pytest.approx(2.0, rel=0.1)


def test_what_gyros_and_clocks_do_is_no_slip() -> None:
    """A bias, a scale, noise, and stamps that are apart, in a drive of hard turns."""
    rng = np.random.default_rng(1)
    guard = SlipGuard(TRACK, TICK)
    rate, yaw = 0.0, 0.0
    for step in range(6000):
        if step % 100 == 0:
            wanted = float(rng.uniform(-1.5, 1.5))
        rate += min(max(wanted - rate, -0.03), 0.03)
        yaw += 0.01 * rate
        time = 0.01 * (step + 1)
        guard.gyro(time + 0.01, 1.02 * rate + 0.005 + 0.003 * rng.standard_normal())
        if step % 2:
            assert guard.wheels(time + 0.004 * rng.uniform(), yaw) == NOTHING
    assert guard.times == 0


def nees(seed: int, loss: float, *, watched: bool, seconds: float = 20.0) -> tuple[float, int]:
    """Mean NEES of the pose on a free drive in the engine over an oil stain, and slips found."""
    pytest.importorskip("mujoco", reason="needs mujoco (pip install werrimbi_odom[all])")
    pytest.importorskip("rclpy", reason="the tracker takes ROS stamps")
    from builtin_interfaces.msg import Time

    from werrimbi_odom.ros.live_odometer import LiveOdometer
    from werrimbi_odom.simulation import LiveRobot, TrueRobot, free
    from werrimbi_odom.simulation.hidden.floor import SlipperySpot
    from werrimbi_odom.simulation.recorder import wheel_speeds

    truth = TrueRobot(left_wheel_noise=4.0e-4, right_wheel_noise=5.8e-4)
    stain = [SlipperySpot(loss, 0.8, 0.3, 0.25)] if loss else []
    live = LiveRobot(truth, seed=seed, hidden=stain)
    file = read_robot_file(ROBOT)
    tracker = LiveOdometer(file.robot, file.tolerance, file.limits)
    guard = SlipGuard(file.robot.track, file.robot.left_tick)
    speeds = wheel_speeds(truth, free(seconds, seed=seed, yaw_rate=1.2))
    radius, base = truth.nominal.wheel_radius, truth.nominal.wheel_separation
    found = []
    for period, (left, right) in enumerate(speeds.tolist(), start=1):
        live.command(0.5 * radius * (left + right), radius * (right - left) / base)
        live.advance()
        time = live.time
        if period % 2:
            continue
        guard.gyro(time, live.gyro(time - 0.01, time))
        if period % 4:
            continue
        seconds_, nano = divmod(round(1e9 * (time + 1.0)), 10**9)
        estimate = tracker.take(Time(sec=seconds_, nanosec=nano), *live.counters(time))
        if estimate is None:
            continue
        missed = guard.wheels(time, tracker.heading)
        if watched and missed.heading:
            tracker.grow(missed)
        if period % 400 == 0:
            x, y, yaw = (a - b for a, b in zip(live.pose, tracker.pose, strict=True))
            error = np.array([x, y, math.remainder(yaw, 2.0 * math.pi)])
            covariance = tracker.odometer.covariance().matrix()
            found.append(error @ np.linalg.solve(covariance, error) / 3.0)
    return float(np.mean(found)), guard.times


@pytest.mark.evidence
def test_over_an_oil_stain_the_covariance_is_honest_again() -> None:
    plain, _ = nees(4, 0.1, watched=False)
    watched, times = nees(4, 0.1, watched=True)
    assert times > 0
    assert plain > 30.0
    assert watched < 3.0


@pytest.mark.evidence
@pytest.mark.parametrize(("loss", "most"), [(0.0, 1.3), (0.1, 2.0), (0.3, 5.0)])
def test_nees_with_and_without_a_gyro(loss: float, most: float) -> None:
    seeds = range(1, 9)
    plain, watched = (
        np.mean([nees(seed, loss, watched=each, seconds=30.0)[0] for seed in seeds])
        for each in (False, True)
    )
    print(f"loss {loss}: NEES {plain:.2f} without, {watched:.2f} with")
    assert watched < most
    assert plain > 100.0 or not loss
    if not loss:
        assert watched == pytest.approx(plain, rel=0.02)


def test_nothing_is_added_where_there_is_no_gyro() -> None:
    guard = SlipGuard(TRACK, TICK)
    assert all(guard.wheels(0.02 * step, 0.1 * step) == NOTHING for step in range(100))
