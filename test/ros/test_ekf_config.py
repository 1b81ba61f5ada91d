# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""config/ekf.yaml in a filter of robot_localization's form: honest, where other choices are not.

robot_localization has no wheel, so its prediction and correction (src/ekf.cpp, as of Jazzy) stand
here in two dimensions. The drive is a minute of arcs, stops and reversals, with counts that are
whole numbers; the truth is drawn 300 times from the wheels' noise.
"""

from __future__ import annotations

import functools
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("rclpy")

from test.ros.messages import read_by_ros
from werrimbi_odom.model.odometer import Estimate, Odometer
from werrimbi_odom.model.robot import Robot

FILE = Path(__file__).parents[2] / "config" / "ekf.yaml"
ROBOT = Robot(0.35, 0.05, 2000.0, 2000.0)
X, Y, YAW, VX, VY, VYAW, AX, AY = range(8)
PLANE = [0, 1, 5, 6, 7, 11, 12, 13]
"""The states above among robot_localization's 15."""
DEFAULT_NOISE = np.diag([0.05, 0.05, 0.06, 0.025, 0.025, 0.02, 0.01, 0.01])


@functools.cache
def configured() -> dict[str, Any]:
    """The file as ROS reads it: the types of its lists must agree, or no node starts with it."""
    return read_by_ros("ekf_filter_node", ["--ros-args", "--params-file", str(FILE)])[1]


@functools.cache
def drive(rate: float) -> tuple[list[Estimate], np.ndarray]:
    """What odom_node publishes in a minute, and 300 true final poses, shape (300, 3)."""
    time = np.arange(round(60 * rate) + 1) / rate
    speed = 0.5 * np.clip(3.0 * np.sin(2.0 * np.pi * time / 40.0), -1.0, 1.0)
    speed[time % 20.0 > 18.0] = 0.0
    turn = 0.6 * np.sin(2.0 * np.pi * time / 13.0) * (speed != 0.0)
    wheels = np.stack([speed - 0.5 * ROBOT.track * turn, speed + 0.5 * ROBOT.track * turn])
    steps = 0.5 * (wheels[:, 1:] + wheels[:, :-1]) / rate
    rolled = np.concatenate([np.zeros((2, 1)), np.cumsum(steps, axis=1)], axis=1)
    left, right = np.floor(rolled / ROBOT.left_tick + [[0.37], [0.61]]).astype(np.int64)
    odometer = Odometer(ROBOT)
    readings = zip(time.tolist(), left.tolist(), right.tolist(), strict=True)
    estimates = [e for reading in readings if (e := odometer.update(*reading)) is not None]
    noise = np.array([[[ROBOT.left_wheel_noise], [ROBOT.right_wheel_noise]]])
    chance = np.random.default_rng(4).standard_normal((300, *steps.shape))
    true = steps + noise * np.sqrt(np.abs(steps)) * chance
    along, turned = 0.5 * true.sum(axis=1), (true[:, 1] - true[:, 0]) / ROBOT.track
    yaw = np.cumsum(turned, axis=1)
    middle = yaw - 0.5 * turned
    x, y = (along * np.cos(middle)).sum(axis=1), (along * np.sin(middle)).sum(axis=1)
    return estimates, np.stack([x, y, yaw[:, -1]], axis=1)


def filtered(
    estimates: list[Estimate], noise: np.ndarray, poses: bool = False
) -> tuple[np.ndarray, np.ndarray]:
    """State and covariance of the pose after the last estimate."""
    state, covariance = np.zeros(8), 1e-9 * np.eye(8)
    before = 0.0
    for estimate in estimates:
        dt, before = estimate.time - before, estimate.time
        state, covariance = predicted(state, covariance, noise, dt)
        twist = estimate.twist_covariance
        if poses:
            seen, places = np.array(estimate.pose), [X, Y, YAW]
            error = estimate.covariance.matrix()
        else:
            seen, places = (
                np.array([estimate.twist.along, 0.0, estimate.twist.turn]),
                [VX, VY, VYAW],
            )
            error = np.diag([twist.speed, twist.speed, twist.yaw_rate])
            error[0, 2] = error[2, 0] = twist.cross
        np.fill_diagonal(error, np.maximum(error.diagonal(), 1e-9))
        sees = np.eye(8)[places]
        gain = covariance @ sees.T @ np.linalg.inv(sees @ covariance @ sees.T + error)
        state = state + gain @ (seen - state[places])
        rest = np.eye(8) - gain @ sees
        covariance = rest @ covariance @ rest.T + gain @ error @ gain.T
    return state[:3], covariance[:3, :3]


def predicted(
    state: np.ndarray, covariance: np.ndarray, noise: np.ndarray, dt: float
) -> tuple[np.ndarray, np.ndarray]:
    """One prediction as in Ekf::predict."""
    cos, sin, half = math.cos(state[YAW]), math.sin(state[YAW]), 0.5 * dt * dt
    transfer = np.eye(8)
    transfer[X, [VX, VY, AX, AY]] = cos * dt, -sin * dt, cos * half, -sin * half
    transfer[Y, [VX, VY, AX, AY]] = sin * dt, cos * dt, sin * half, cos * half
    transfer[[YAW, VX, VY], [VYAW, AX, AY]] = dt
    slope = transfer.copy()
    slope[X, YAW] = -(sin * state[VX] + cos * state[VY]) * dt
    slope[Y, YAW] = (cos * state[VX] - sin * state[VY]) * dt
    return transfer @ state, slope @ covariance @ slope.T + noise * dt


def nees(pose: np.ndarray, covariance: np.ndarray, truth: np.ndarray) -> float:
    """Mean squared error in standard deviations, over 3: 1 where the covariance is honest."""
    error = truth - pose
    error[:, 2] = np.remainder(error[:, 2] + np.pi, 2.0 * np.pi) - np.pi
    return float(np.einsum("ij,jk,ik->i", error, np.linalg.inv(covariance), error).mean() / 3.0)


def our_noise() -> np.ndarray:
    return np.array(configured()["process_noise_covariance"]).reshape(15, 15)[np.ix_(PLANE, PLANE)]


def test_it_fuses_the_twist_alone_in_the_nodes_frames() -> None:
    values = configured()
    assert [place for place, used in enumerate(values["odom0_config"]) if used] == [6, 7, 11]
    assert values["odom0"] == "odom"
    assert values["two_d_mode"] is True
    assert (values["odom_frame"], values["base_link_frame"]) == ("odom", "base_link")
    noise = np.array(values["process_noise_covariance"]).reshape(15, 15)
    assert (noise == np.diag(noise.diagonal())).all()


def test_the_published_pose_is_honest_by_itself() -> None:
    estimates, truth = drive(50.0)
    last = estimates[-1]
    assert nees(np.array(last.pose), last.covariance.matrix(), truth) == pytest.approx(
        1.0, abs=0.15
    )


def test_fused_as_the_file_says_it_stays_honest() -> None:
    """A little too careful: a filter cannot know that quantisation errors cancel."""
    estimates, truth = drive(50.0)
    assert 0.4 < nees(*filtered(estimates, our_noise()), truth) < 1.2


def test_fused_as_poses_it_is_far_too_sure() -> None:
    estimates, truth = drive(50.0)
    assert nees(*filtered(estimates, our_noise(), poses=True), truth) > 10.0


def test_the_default_process_noise_drowns_everything() -> None:
    estimates, truth = drive(50.0)
    _, covariance = filtered(estimates, DEFAULT_NOISE)
    assert math.sqrt(covariance[0, 0]) > 100.0 * truth[:, 0].std()


@pytest.mark.evidence
def test_at_high_rates_quantisation_makes_the_filter_too_careful() -> None:
    estimates, truth = drive(200.0)
    assert nees(*filtered(estimates, our_noise()), truth) < 0.3
