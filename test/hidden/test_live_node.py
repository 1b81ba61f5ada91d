# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Held-out ticks through the real node: with the effect that was added it errs less."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

pytest.importorskip("rclpy", reason="the node's tests need ROS 2 (pip install .[ros])")
pytest.importorskip("mujoco", reason="hidden sets need the physics engine (pip install mujoco)")

from ruamel.yaml import YAML

from test.hidden.set_judging import read_set
from test.hidden.sets import HiddenSet
from test.ros.conftest import DEEP, Launched, launcher
from werrimbi_odom.effects import find
from werrimbi_odom.files.robot_files.robot_file import RobotFile
from werrimbi_odom.files.robot_files.robot_file_rewrite import write_robot_file
from werrimbi_odom.files.run import Reference, Run
from werrimbi_odom.inference.adding.adding import add_effects

Floats = NDArray[np.float64]
STEP = 2.0
"""Of the stretches over which live odometry is compared with the reference [s]."""


@pytest.fixture
def launch(tmp_path: Path) -> Iterator[Callable[..., Launched]]:
    yield from launcher(tmp_path)


@pytest.mark.evidence
def test_the_node_with_the_added_effect_errs_less(
    launch: Callable[..., Launched], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("WERRIMBI_HIDDEN", str(tmp_path / "hidden"))
    hidden = HiddenSet("effect", ("left_missed_ticks=0.05",), 31, "short")
    file, train, holdout = read_set(hidden)
    found = add_effects([find("left_missed_ticks")], train, file.robot, holdout=holdout)
    assert found.objection is None
    robot = found.robot
    multipliers = {
        name: getattr(robot, name)
        for name in (
            "wheel_separation_multiplier",
            "left_wheel_radius_multiplier",
            "right_wheel_radius_multiplier",
        )
    }
    better = write_robot_file(file, multipliers, tmp_path / "better.yaml", effects=robot.effects)
    before, after = (live_error(launch, robot_file, holdout[0]) for robot_file in (file, better))
    assert after < 0.8 * before


def live_error(launch: Callable[..., Launched], file: RobotFile, run: Run) -> float:
    """Root mean square position error of stretches, by what the node publishes [m]."""
    parameters = next(iter(YAML(typ="safe").load(file.text).values()))["ros__parameters"]
    topics = {
        "/joint_states": {"subscription": DEEP},
        "/odom": {"publisher": DEEP},
    }
    node = launch(parameters | {"position_unit": "ticks", "qos_overrides": topics})
    from sensor_msgs.msg import JointState

    node.publisher(JointState, "joint_states")
    node.until(lambda: node.node.count_publishers("odom") > 0, "publisher of odom")
    node.rest(0.5)
    ticks = run.ticks
    columns = (ticks.time.round(6).tolist(), ticks.left.tolist(), ticks.right.tolist())
    for number, (time, left, right) in enumerate(zip(*columns, strict=True)):
        node.now = 100.0 + time
        node.ticks(left, right, node.now)
        if number % 100 == 0:
            node.rest(0.01)
    node.last()
    assert run.reference is not None
    return stretches(poses(node.odometry), run.reference)


def poses(messages: list[Any]) -> Floats:
    """Time since the ticks' own zero, x, y, yaw of odometry; shape (n, 4)."""
    table = []
    for message in messages:
        pose, stamp = message.pose.pose, message.header.stamp
        yaw = 2.0 * math.atan2(pose.orientation.z, pose.orientation.w)
        time = stamp.sec + 1e-9 * stamp.nanosec - 100.0
        table.append((time, pose.position.x, pose.position.y, yaw))
    return np.array(table)


def stretches(live: Floats, reference: Reference) -> float:
    """Relative positions over stretches of STEP, live against measured."""
    inside = (reference.time > live[0, 0]) & (reference.time < live[-1, 0])
    when = reference.time[inside]
    yaw = np.interp(when, live[:, 0], np.unwrap(live[:, 3]))
    place = np.interp(when, live[:, 0], live[:, 1]) + 1j * np.interp(when, live[:, 0], live[:, 2])
    measured = reference.x[inside] + 1j * reference.y[inside]
    heading = reference.yaw[inside]
    starts = np.searchsorted(when, np.arange(when[0], when[-1], STEP))
    begin, end = starts[:-1], starts[1:]
    moved = (place[end] - place[begin]) * np.exp(-1j * yaw[begin])
    true = (measured[end] - measured[begin]) * np.exp(-1j * heading[begin])
    return float(np.sqrt(np.mean(np.abs(moved - true) ** 2)))
