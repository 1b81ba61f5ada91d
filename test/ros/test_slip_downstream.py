# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A filter downstream of odom_node where wheels slip, in the engine: with a gyro, and without.

It integrates the twist with its covariance, as any EKF that fuses it does, and takes a fix (x, y to
20 mm, heading to 20 mrad) every five seconds.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

pytest.importorskip("rclpy")
pytest.importorskip("mujoco", reason="needs mujoco (pip install werrimbi_odom[all])")

from test.ros.messages import in_plane, stamp_at
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.model.slip import NOTHING, SlipGuard
from werrimbi_odom.ros.live_odometer import LiveOdometer
from werrimbi_odom.ros.odometry_messages import OdometryMessage
from werrimbi_odom.simulation import LiveRobot, Peculiarity, TrueRobot, free
from werrimbi_odom.simulation.engine import Shift, Shifter, Stride
from werrimbi_odom.simulation.hidden.floor import SlipperySpot
from werrimbi_odom.simulation.recorder import wheel_speeds

ROBOT = read_robot_file(Path(__file__).parents[2] / "config" / "robot.yaml")
FIX = np.diag([0.02**2, 0.02**2, 0.02**2])
FIX_EVERY = 5.0
"""[s]"""


@dataclass(frozen=True)
class Wall(Peculiarity):
    """A wall across the world, at which the robot stops, and turns no more, while it drives on."""

    at: float

    def shifter(self, robot: TrueRobot, rng: np.random.Generator) -> Shifter:
        base = robot.nominal.wheel_separation

        def shift(stride: Stride) -> Shift:
            along = 0.5 * (stride.left + stride.right)
            if stride.pose.x < self.at or along * math.cos(stride.pose.yaw) <= 0.0:
                return Shift(0.0, 0.0, 0.0)
            return Shift(-along, 0.0, -(stride.right - stride.left) / base)

        return shift


class Filter:
    """Pose and covariance of a robot, from twists and fixes."""

    def __init__(self) -> None:
        self.pose, self.covariance = np.zeros(3), 1e-8 * np.eye(3)

    def predict(self, twist: np.ndarray, covariance: np.ndarray, dt: float) -> None:
        """Forward speed, sideways speed and yaw rate, held for dt."""
        cos, sin = np.cos(self.pose[2]), np.sin(self.pose[2])
        into = np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]]) * dt
        moved = into @ twist
        slope = np.eye(3)
        slope[:2, 2] = -moved[1], moved[0]
        self.covariance = slope @ self.covariance @ slope.T + into @ covariance @ into.T
        middle = self.pose[2] + 0.5 * dt * twist[2]
        self.pose += [dt * twist[0] * np.cos(middle), dt * twist[0] * np.sin(middle), moved[2]]

    def correct(self, fix: np.ndarray) -> None:
        """A measured pose."""
        gain = self.covariance @ np.linalg.inv(self.covariance + FIX)
        self.pose += gain @ _apart(fix, self.pose)
        self.covariance = (np.eye(3) - gain) @ self.covariance

    def deviation(self, truth: np.ndarray) -> float:
        """NEES, over three."""
        error = _apart(truth, self.pose)
        return float(error @ np.linalg.solve(self.covariance, error)) / 3.0


def _apart(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    difference = one - other
    difference[2] = np.remainder(difference[2] + np.pi, 2.0 * np.pi) - np.pi
    return difference


class Followed(NamedTuple):
    """Of a drive: mean NEES, rms distance from the truth [m], and how often slip was seen."""

    nees: float
    error: float
    slips: int


def followed(
    hidden: Sequence[Peculiarity], seed: int, *, watched: bool, seconds: float = 30.0
) -> Followed:
    """A free drive, by the messages that odom_node would publish."""
    truth = TrueRobot(left_wheel_noise=4.0e-4, right_wheel_noise=5.8e-4)
    live = LiveRobot(truth, seed=seed, hidden=hidden)
    tracker = LiveOdometer(ROBOT.robot, ROBOT.tolerance, ROBOT.limits)
    guard = SlipGuard(ROBOT.robot.track, ROBOT.robot.left_tick)
    message, ekf, rng = OdometryMessage("odom", "base_link"), Filter(), np.random.default_rng(seed)
    speeds = wheel_speeds(truth, free(seconds, seed=seed, yaw_rate=1.2))
    radius, base = truth.nominal.wheel_radius, truth.nominal.wheel_separation
    nees, errors, before = [], [], 0.0
    for period, (left, right) in enumerate(speeds.tolist(), start=1):
        live.command(0.5 * radius * (left + right), radius * (right - left) / base)
        live.advance()
        time = live.time
        if period % 2 == 0:
            guard.gyro(time, live.gyro(time - 0.01, time))
        if period % 4:
            continue
        stamp = stamp_at(time + 1.0)
        estimate = tracker.take(stamp, *live.counters(time))
        if estimate is not None:
            missed = guard.wheels(time, tracker.heading)
            odometry = message.filled(stamp, estimate, missed if watched else NOTHING)
            twist = odometry.twist.twist
            block = in_plane(odometry.twist.covariance)
            said = np.array([twist.linear.x, twist.linear.y, twist.angular.z])
            ekf.predict(said, block, time - before)
        before = time
        pose = np.array(live.pose)
        if period % round(200 * FIX_EVERY) == 0:
            ekf.correct(pose + rng.multivariate_normal(np.zeros(3), FIX))
        if period % 20 == 0 and time > 1.0:
            nees.append(ekf.deviation(pose))
            errors.append(float(np.sum((ekf.pose - pose)[:2] ** 2)))
    return Followed(float(np.mean(nees)), math.sqrt(np.mean(errors)), guard.times)


FLOORS: dict[str, list[Peculiarity]] = {
    "no slip": [],
    "10 % on a stain": [SlipperySpot(0.1, 0.8, 0.3, 0.25)],
    "30 % on a stain": [SlipperySpot(0.3, 0.8, 0.3, 0.25)],
    "30 % on three stains": [
        SlipperySpot(0.3, x, y, 0.25) for x, y in ((0.6, 0.2), (0.0, 0.8), (-0.6, -0.4))
    ],
    "against a wall": [Wall(0.5)],
}


@pytest.mark.evidence
def test_a_filter_downstream_is_told_of_slip() -> None:
    floor = FLOORS["30 % on a stain"]
    plain, watched = (followed(floor, 4, watched=each, seconds=20.0) for each in (False, True))
    assert watched.slips > 0
    assert plain.nees > 30.0
    assert watched.nees < 0.1 * plain.nees
    assert watched.error < plain.error


@pytest.mark.evidence
@pytest.mark.parametrize("floor", FLOORS)
def test_a_filter_downstream_with_and_without(floor: str) -> None:
    """Fresh seeds: none of them was looked at when the numbers of `model.slip` were chosen."""
    found = {
        watched: np.array(
            [followed(FLOORS[floor], seed, watched=watched) for seed in range(901, 909)]
        ).mean(axis=0)
        for watched in (False, True)
    }
    for watched, (nees, error, slips) in found.items():
        print(f"{floor}, gyro {watched}: NEES {nees:.2f}, {1e3 * error:.0f} mm, {slips:.1f} slips")
    plain, watched = found[False], found[True]
    if floor == "no slip":
        np.testing.assert_allclose(watched[:2], plain[:2], rtol=0.05)
    else:
        assert watched[0] < 0.2 * plain[0]
        assert watched[1] < plain[1]
