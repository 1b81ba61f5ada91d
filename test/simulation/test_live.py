# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A robot that is driven now sees what a recorded one sees of the same commands."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("mujoco", reason="needs mujoco (pip install werrimbi_odom[all])")


from werrimbi_odom import simulation as sim
from werrimbi_odom.simulation.live import KEPT
from werrimbi_odom.simulation.manoeuvres import MoveLimits
from werrimbi_odom.simulation.recorder import wheel_speeds
from werrimbi_odom.simulation.rooms import arena

ROBOT = sim.TrueRobot(left_wheel_noise=4.0e-4, right_wheel_noise=5.8e-4)
EXACT = sim.ReferenceSensor(sigma_xy=0.0, sigma_yaw=0.0)
DRIVE = sim.moves(
    "there", [(0.6, 0.5), (-0.3, 0.2)], MoveLimits(speed=0.7, acceleration=2.0, pause=0.1)
)
START = sim.AxlePose(0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    "wish",
    [
        *("left_backlash=0.004", "right_missed_ticks=0.05", "encoder_skew=0.015"),
        *("wheels_swapped", "reference_delay=-0.08", "base_by_payload"),
    ],
)
def test_live_and_recorded_are_one(wish: str) -> None:
    odd = [sim.wished(wish, seed=3).peculiarity]
    recorded = sim.record(ROBOT, DRIVE, seed=5, start=START, hidden=odd, reference=EXACT)
    live = sim.LiveRobot(ROBOT, seed=5, start=START, hidden=odd, reference=EXACT)
    radius, base = ROBOT.nominal.wheel_radius, ROBOT.nominal.wheel_separation
    counts, poses = [], []
    ticks, measured = recorded.t_s.tolist(), recorded.reference_t_s.tolist()
    for left, right in wheel_speeds(ROBOT, DRIVE).tolist():
        live.command(0.5 * radius * (left + right), radius * (right - left) / base)
        live.advance()
        while len(counts) < len(ticks) and ticks[len(counts)] + live.counters_lag <= live.time:
            counts.append(live.counters(ticks[len(counts)]))
        while len(poses) < len(measured) and (
            measured[len(poses)] + live.reference_lag <= live.time
        ):
            poses.append(live.reference(measured[len(poses)]))
    assert len(counts) > 0.9 * len(ticks)
    both = np.column_stack([recorded.left_ticks, recorded.right_ticks])[: len(counts)]
    assert np.abs(both - np.array(counts)).max() <= 1  # rounding, at a mark
    assert np.ptp(both, axis=0).min() > 1000
    there = np.column_stack([recorded.reference_x_m, recorded.reference_y_m])[: len(poses)]
    np.testing.assert_allclose(there, np.array(poses)[:, :2], atol=1e-6)


def test_the_gyro_integrates_to_the_turn_and_memory_stays_bounded() -> None:
    live = sim.LiveRobot(ROBOT, seed=2)
    live.command(0.2, 0.8)
    turned, before = 0.0, 0.0
    for step in range(3 * KEPT):
        live.advance()
        if step % 2:
            turned += live.gyro(before, live.time) * (live.time - before)
            before = live.time
    assert live.pose.yaw == pytest.approx(turned, rel=0.03)  # its bias and scale
    assert live.pose.yaw > 4.0
    assert len(live._rows) == 2 * KEPT


def test_the_lidar_sees_the_room_from_where_the_robot_is() -> None:
    live = sim.LiveRobot(ROBOT, seed=2, room=arena(2.6))
    live.command(0.4, 0.0)
    turn = 1.0 / live.lidar.rate_hz
    beams = live.lidar.beams
    ahead = []
    for step in range(300):
        live.advance()
        if step in (40, 280):
            ranges = live.sweep(live.time - turn)
            ahead.append(np.median(ranges[[beams // 2 - 1, beams // 2, beams // 2 + 1]]))
    assert ahead[0] == pytest.approx(1.3, abs=0.1)  # behind the robot, where nothing stands
    assert ahead[1] - ahead[0] == pytest.approx(0.4 * 240 * 0.005, abs=0.03)


def test_a_wish_that_cannot_be_is_told() -> None:
    with pytest.raises(sim.UnknownEffectError, match="castor_kick"):
        sim.wished("castor_kik", seed=1)
    with pytest.raises(sim.StrengthError, match="'much' is not a number"):
        sim.wished("castor_kick=much", seed=1)
