# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Drives whose headings begin anew, beside one tracker's positions, are told as that."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import werrimbi_odom as wo
from test.cli.commands import ROBOT_FILE, write_run
from test.inference.driven import run_of
from test.model.drives import ROBOT


def test_drives_that_no_mount_fits_are_not_said_to_be_lost(tmp_path: Path) -> None:
    """A mower's compass beside its UWB: the reference "is lost, it slides, or sits far away"."""
    (tmp_path / "robot.yaml").write_text(ROBOT_FILE)
    places = []
    for number, angle in enumerate((1.57, 1.57, -1.57, -1.57)):
        run = run_of(ROBOT, number, 60)
        assert run.reference is not None
        turned = replace(run.reference, yaw=run.reference.yaw + angle)
        places.append(tmp_path / f"run_{number}")
        write_run(places[-1], replace(run, reference=turned))
    told = wo.diagnose(wo.read_robot(tmp_path / "robot.yaml"), places).summary()
    words = " ".join(told.split())
    assert "Between run_1 and run_2 the reference came to be mounted otherwise" in words
    assert "No mount of the reference fits all of these drives" in words
    assert "It is lost" not in words
