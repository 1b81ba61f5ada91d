# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A simulated TurtleBot3 with nothing but its lidar: what is wrong with it is found by /scan."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import werrimbi_odom as wo
from werrimbi_odom.simulation import (
    FieldDrive,
    Manoeuvre,
    Nominal,
    Pose,
    TrueRobot,
    free,
    record,
    write_field_bag,
    write_robot_file,
)
from werrimbi_odom.simulation.lidar import Lidar, scanned
from werrimbi_odom.simulation.rooms import around

SCALE, RATIO = 0.9955, 1.0215
LEFT = 2.0 * 0.033 * SCALE / (1.0 + RATIO)
ROBOT = TrueRobot(
    wheel_separation=1.05 * 0.16,
    left_wheel_radius=LEFT,
    right_wheel_radius=RATIO * LEFT,
    left_ticks_per_revolution=4096.0,
    right_ticks_per_revolution=4096.0,
    left_wheel_noise=2e-4,
    right_wheel_noise=2e-4,
    mass=1.0,
    nominal=Nominal(0.16, 0.033),
)
LIDAR = Lidar(mount=Pose(-0.032, 0.0, 0.03))
WRONG = (
    "unequal_wheel_radii",
    "reference_lever_arm",
    "track_width",
    "reference_yaw_offset",
    "wheel_radius_scale",
)
TRUE = {
    "unequal_wheel_radii.ratio": RATIO,
    "track_width.multiplier": 1.05,
    "wheel_radius_scale.multiplier": SCALE,
    "reference_lever_arm.x": -0.032,
    "reference_lever_arm.y": 0.0,
    "reference_yaw_offset.angle": 0.03,
}
WITHIN = dict(zip(TRUE, (0.001, 0.002, 0.001, 0.001, 0.001, 0.001), strict=True))
"""What twenty metres should give, and ten do."""


def recorded(manoeuvre: Manoeuvre, seed: int, folder: Path) -> Path:
    """A drive of nobody's hands, in a room of its own; no transform tells where the lidar sits."""
    path = record(ROBOT, manoeuvre, seed=seed, start=Pose(0.0, 0.0, 0.0)).true_path
    at = np.arange(0.01, path.t_s[-1], 0.05)
    step = 2.0 * math.pi / 4096.0
    left, right = (
        step * np.floor(np.interp(at, path.t_s, angle) / step)
        for angle in (path.left_angle_rad, path.right_angle_rad)
    )
    nothing = np.column_stack([at, at, np.zeros(at.size)])
    drive = FieldDrive(
        folder.name,
        np.column_stack([at, at, left, right]),
        nothing,
        np.column_stack([at, at, np.zeros((at.size, 3))]),
        np.zeros((at.size, 3)),
        LIDAR,
        scanned(path, around(path.x_m, path.y_m, seed), LIDAR, seed),
    )
    return write_field_bag(drive, ROBOT, folder, mounting=False)


@pytest.mark.evidence
def test_what_is_wrong_with_a_turtlebot_is_found_by_its_lidar(tmp_path: Path) -> None:
    robot = wo.read_robot(write_robot_file(ROBOT, tmp_path / "robot.yaml"))
    drives = [
        recorded(free(80.0, seed=3 + n, speed=0.25, yaw_rate=0.8), 10 + n, tmp_path / f"drive_{n}")
        for n in range(2)
    ]
    found = wo.add(
        ",".join(WRONG),
        robot,
        drives[:1],
        holdout=drives[1:],
        force=True,
        ticks_topic="/joint_states",
        reference_topic="/scan",
    ).to_dict()
    parameters = found["parameters"]
    for name, true in TRUE.items():
        value, std = parameters[name]["value"], parameters[name]["std"]
        assert abs(value - true) < WITHIN[name], name
        if name != "reference_lever_arm.y":  # nothing there, and nothing put there
            assert abs(value - true) < 2.0 * std, name
    assert found["holdout"]["nees"] == pytest.approx(1.0, abs=0.3)
    assert found["holdout"]["after"] < 3.5e-3
    assert found["holdout"]["before"] > 0.025
