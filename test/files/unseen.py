# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What bags hold that nobody has prepared: joints, gyro and poses of a drive, and a URDF."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from test.files.conftest import Messages
from test.model.drives import ROBOT
from werrimbi_odom.files.run import Run

DAY = 1_700_000_000
JOINTS = ("drive_left_joint", "drive_right_joint")

WHEEL = """
  <joint name="{name}" type="continuous">
    <parent link="chassis"/><child link="{name}_link"/>
    <origin xyz="0.05 {y} 0.01" rpy="-1.5707963 0 0"/><axis xyz="0 0 1"/>
  </joint>
  <link name="{name}_link"><collision><geometry>
    <cylinder radius="{radius}" length="0.02"/>
  </geometry></collision></link>
"""
URDF = """<robot name="a_robot"><link name="base_footprint"/><link name="chassis"/>
  <joint name="up" type="fixed"><parent link="base_footprint"/><child link="chassis"/>
    <origin xyz="0 0 0.04" rpy="0 0 {yaw}"/></joint>
  <joint name="castor_joint" type="continuous"><parent link="chassis"/><child link="castor"/>
    <origin xyz="-0.2 0.01 0"/><axis xyz="0 1 0"/></joint><link name="castor"/>{wheels}</robot>"""


def urdf(yaw: float = 0.0) -> str:
    """Of the robot that is driven."""
    half, radius = 0.5 * ROBOT.wheel_separation, ROBOT.wheel_radius
    wheels = [
        WHEEL.format(name=name, y=y, radius=radius)
        for name, y in zip(JOINTS, (half, -half), strict=True)
    ]
    return URDF.format(wheels="".join(wheels), yaw=yaw)


Entry = tuple[str, int, Any]
"""Topic, stamp in ns, message."""


def stamp_of(time: float) -> int:
    """In ns, of a time in s since the run began."""
    return DAY * 10**9 + round(1e9 * time)


def joints(ros: Messages, run: Run, share: float = 1.0) -> Iterator[Entry]:
    """Angles of the wheels at each row of ticks, or a share of them."""
    for time, *counts in zip(run.ticks.time, run.ticks.left, run.ticks.right, strict=True):
        stamp = stamp_of(time)
        angles = [
            2.0 * math.pi * round(share * n) / ROBOT.left_ticks_per_revolution for n in counts
        ]
        yield "/joint_states", stamp, ros.joints(stamp, JOINTS, angles)


def gyro(ros: Messages, run: Run, share: float = 1.0) -> Iterator[Entry]:
    """Yaw rates at each pose of the reference."""
    assert run.reference is not None
    rates = np.gradient(np.unwrap(run.reference.yaw), run.reference.time)
    for time, rate in zip(run.reference.time, rates, strict=True):
        yield "/imu", stamp_of(time), ros.imu(stamp_of(time), share * rate)


def poses(ros: Messages, run: Run, share: float = 1.0) -> Iterator[Entry]:
    """What the reference measured."""
    seen = run.reference
    assert seen is not None
    for time, x, y, yaw in zip(seen.time, seen.x, seen.y, seen.yaw, strict=True):
        stamp = stamp_of(time)
        yield "/pose", stamp, ros.pose(stamp, share * x, share * y, share * yaw)
