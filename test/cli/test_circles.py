# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Odometry judged by itself is refused on the command line and from Python, unless it is forced."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import werrimbi_odom as wo
from test.command_line import Werrimbi
from werrimbi_odom.errors import InputError
from werrimbi_odom.model.trajectory import trajectory

ROBOT = """\
odom_node:
  ros__parameters:
    wheel_separation: 0.3
    wheel_radius: 0.05
    left_ticks_per_revolution: 1000.0
    right_ticks_per_revolution: 1000.0
"""


@pytest.fixture
def drive(tmp_path: Path) -> tuple[Path, Path]:
    """A robot file, and a run whose reference was integrated from its counts."""
    robot, run = tmp_path / "robot.yaml", tmp_path / "run"
    robot.write_text(ROBOT)
    run.mkdir()
    rng = np.random.default_rng(2)
    time = 0.05 * np.arange(1200)
    speeds = np.repeat(rng.uniform(200.0, 1500.0, (30, 2)), 40, axis=0)
    counts = np.rint(np.cumsum(0.05 * speeds, axis=0))
    path = trajectory(wo.read_robot(robot).robot, time, counts[:, 0], counts[:, 1])
    ticks = np.column_stack([time, counts])
    poses = np.column_stack([time, path.x, path.y, path.yaw])
    for name, header, table in (
        ("ticks.csv", "t_s,left_ticks,right_ticks", ticks),
        ("reference.csv", "t_s,x_m,y_m,yaw_rad", poses),
    ):
        np.savetxt(run / name, table, "%.12g", delimiter=",", header=header, comments="")
    return robot, run


def test_the_command_line(drive: tuple[Path, Path], werrimbi: Werrimbi) -> None:
    robot, run = drive
    command = ["compare", "--robot", str(robot), str(run)]
    said = werrimbi(*command, code=2).err
    assert said.count("\n") == 1
    assert "it was made from the same counts, and cannot judge them (--force takes it" in said
    said = werrimbi(*command, "--force").err
    assert "warning: " in said
    assert "taken all the same" in said


def test_from_python(drive: tuple[Path, Path]) -> None:
    robot = wo.read_robot(drive[0])
    with pytest.raises(InputError, match="made from the same counts"):
        wo.compare(robot, drive[1])
    with pytest.warns(UserWarning, match="taken all the same"):
        wo.compare(robot, drive[1], force_reference=True)
