# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A gyro that is mounted on its side is read about the axis that is upwards."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import werrimbi_odom as wo
from test.files.conftest import MakeRobot
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.references.gyro import yaw_rate

MS = 10**6


def mounted(axis: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Yaw rate, and what gyro and accelerometer measure of a robot that turns and shakes."""
    random = np.random.default_rng(1)
    rate = np.sin(np.linspace(0.0, 20.0, 500))
    rates = np.outer(rate, axis) + random.normal(0.0, 1e-3, (500, 3))
    return rate, rates, 9.81 * axis + random.normal(0.0, 2.0, (500, 3))


@pytest.mark.parametrize(
    ("axis", "said"),
    [
        ((0.0, 1.0, 0.0), "upwards is its y axis"),
        ((-1.0, 0.0, 0.0), "upwards is its minus x axis"),
        ((0.0, math.sqrt(0.5), math.sqrt(0.5)), "upwards is 4"),
    ],
)
def test_on_its_side(axis: tuple[float, ...], said: str) -> None:
    rate, rates, forces = mounted(np.array(axis))
    found, words = yaw_rate(rates, forces)
    assert np.abs(found - rate).max() < 0.02
    assert said in words


@pytest.mark.parametrize("lean", [0.0, 10.0, 25.0])
def test_upright_it_is_its_z_axis(lean: float) -> None:
    axis = np.array([0.0, math.sin(math.radians(lean)), math.cos(math.radians(lean))])
    _, rates, forces = mounted(axis)
    found, words = yaw_rate(rates, forces)
    assert (found == rates[:, 2]).all()
    assert words == ""


@pytest.mark.parametrize("force", [(0.0, 0.0, 0.0), (0.0, 1.0, 0.0)])
def test_an_accelerometer_that_says_nothing_is_not_asked(force: tuple[float, ...]) -> None:
    """None, and one in units of gravity."""
    _, rates, _ = mounted(np.array([0.0, 0.0, 1.0]))
    found, words = yaw_rate(rates, np.tile(force, (500, 1)))
    assert (found == rates[:, 2]).all()
    assert words == ""


def test_upside_down_is_said_and_not_mended() -> None:
    """It may be the driver that has the sign the other way; then its turning is right."""
    _, rates, _ = mounted(np.array([0.0, 0.0, 1.0]))
    found, words = yaw_rate(rates, np.tile((0.0, 0.3, -9.81), (500, 1)))
    assert (found == rates[:, 2]).all()
    assert "upside down" in words
    assert "if that has the right sign" in words


def test_a_gyro_of_one_axis_is_read(tmp_path: Path, ros: Any, robot: MakeRobot) -> None:
    """Its driver leaves x and y unsaid."""
    names = ["left_wheel_joint", "right_wheel_joint"]
    entries = []
    for n in range(1, 100):
        kind, message = ros.imu(20 * n * MS, 0.5)
        message.angular_velocity = ros.make("geometry_msgs/msg/Vector3", math.nan, math.nan, 0.5)
        entries.append(("/imu", 20 * n * MS, (kind, message)))
        joints = ros.joints(20 * n * MS, names, [0.1 * n, 0.1 * n])
        entries.append(("/joint_states", 20 * n * MS, joints))
    run = read_run(ros.write(tmp_path / "bag", entries), robot(), reference_topic="/imu")
    assert run.reference is not None
    assert run.reference.yaw[-1] == pytest.approx(0.5 * 0.02 * 98)


def test_in_a_bag_it_is_read_so_and_said(tmp_path: Path, ros: Any, robot: MakeRobot) -> None:
    rate, rates, forces = mounted(np.array([0.0, 1.0, 0.0]))
    entries = []
    for n, (turning, force) in enumerate(zip(rates, forces, strict=True), start=1):
        kind, message = ros.imu(20 * n * MS, 0.0)
        message.angular_velocity = ros.make("geometry_msgs/msg/Vector3", *turning)
        message.linear_acceleration = ros.make("geometry_msgs/msg/Vector3", *force)
        entries.append(("/imu", 20 * n * MS, (kind, message)))
        names = ["left_wheel_joint", "right_wheel_joint"]
        entries.append(
            ("/joint_states", 20 * n * MS, ros.joints(20 * n * MS, names, [0.1 * n, 0.1 * n]))
        )
    bag = ros.write(tmp_path / "bag", entries)
    run = read_run(bag, robot(), reference_topic="/imu")
    assert run.reference is not None
    assert np.abs(run.reference.yaw - 0.02 * np.cumsum(rate)).max() < 0.05
    said = " ".join(wo.info(bag).summary().split())
    assert "mounted on its side: by its accelerometer upwards is its y axis" in said


def test_the_vertical_is_that_of_its_own_accelerometer(
    tmp_path: Path, ros: Any, robot: MakeRobot
) -> None:
    """A camera's IMU on its side comes twice as often in the same topic: no turn was left."""
    entries = []
    for n in range(1, 200):
        at, camera = 20 * n * MS, n % 3 != 0
        kind, message = ros.imu(at, 0.0 if camera else 0.5)
        message.header.frame_id = "camera" if camera else "imu_link"
        up = (0.0, 9.81, 0.0) if camera else (0.0, 0.0, 9.81)
        message.linear_acceleration = ros.make("geometry_msgs/msg/Vector3", *up)
        names = ["left_wheel_joint", "right_wheel_joint"]
        entries.append(("/imu", at, (kind, message)))
        entries.append(("/joint_states", at, ros.joints(at, names, [0.1 * n, 0.1 * n])))
    bag = ros.write(tmp_path / "bag", entries)
    run = read_run(bag, robot(), reference_topic="/imu:imu_link")
    assert run.reference is not None
    assert run.reference.yaw[-1] == pytest.approx(0.5 * 0.02 * 195)
