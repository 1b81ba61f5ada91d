# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A bag whose transform has the lidar elsewhere than it sits: what it should be is told."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import werrimbi_odom as wo
from test.inference.driven import COMMON
from test.scans.turtlebot import LIDAR, ROBOT, recorded
from werrimbi_odom import simulation as sim
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.report.diagnosis.as_json import json_of
from werrimbi_odom.report.diagnosis.reference_remarks import transform_to_mend


@pytest.mark.evidence
def test_of_a_wrong_transform_it_is_said_what_it_should_be(tmp_path: Path) -> None:
    """The lidar of `LIDAR`, by a transform that is off by 20 mm and 30 mrad."""
    true = LIDAR.mount
    entered = sim.AxlePose(true.x + 0.012, true.y - 0.016, true.yaw - 0.03)
    file = wo.read_robot(sim.write_robot_file(ROBOT, tmp_path / "robot.yaml"))
    runs = []
    for seed in (3, 4):
        drive = sim.free(25.0, seed=seed, speed=0.25, yaw_rate=0.8)
        made = recorded(drive, seed, tmp_path / f"drive_{seed}", entered=entered)
        run = read_run(made.bag, file, ticks_topic="/joint_states", reference_topic="/scan")
        runs.append(run)
    found = diagnose(runs, file.robot, COMMON)
    assert {"reference_lever_arm", "reference_yaw_offset"} <= set(found.found)
    (said,) = transform_to_mend(found)
    assert said.startswith("Unless it is sideways_drift, the transform")
    number = r"(-?[\d.]+) ± ([\d.]+)"
    told = re.search(
        rf"transform base_link -> base_scan \(URDF, /tf_static\) should be x = {number} m, "
        rf"y = {number} m and yaw = {number} rad, where it is x = -0.02, y = -0.016 and yaw = 0\.",
        said,
    )
    assert told is not None, said
    parts = json_of(found, None)["transform_to_mend"]
    for place, (name, truth) in enumerate(zip(("x", "y", "yaw"), true, strict=True)):
        value, std = map(float, told.group(2 * place + 1, 2 * place + 2))
        assert std < 1e-3
        assert value == pytest.approx(truth, abs=3.0 * std)
        assert parts[name]["value"] == pytest.approx(value, abs=std)
