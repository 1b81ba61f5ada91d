# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Encoder discs with few slots: a count is centimetres, and a late clock is still a late clock."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest

import werrimbi_odom as wo
from werrimbi_odom.api.result import Result
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis
from werrimbi_odom.simulation import (
    TrueRobot,
    free,
    hide,
    record,
    write_robot_file,
    write_run,
)
from werrimbi_odom.simulation.hidden import Peculiarity

LATE = 0.04


def diagnosed(folder: Path, counts: int, hidden: Sequence[Peculiarity]) -> Result[AdvisedDiagnosis]:
    """Of four drives of a minute with so many counts in a turn."""
    each = float(counts)
    true = TrueRobot(
        left_wheel_noise=4.0e-4,
        right_wheel_noise=5.8e-4,
        left_ticks_per_revolution=each,
        right_ticks_per_revolution=each,
    )
    robot = wo.read_robot(write_robot_file(true, folder / "robot.yaml"))
    drives = []
    for number in range(4):
        speed = 0.25 + 0.05 * (number % 3)
        manoeuvre = free(60.0, seed=number, speed=speed, yaw_rate=2.5 * speed, acceleration=speed)
        recording = record(true, manoeuvre, seed=100 + number, hidden=hidden)
        drives.append(wo.read_run(write_run(recording, folder / str(number)), robot))
    return wo.diagnose(robot, drives[:3], holdout=drives[3:])


@pytest.mark.parametrize("counts", [20, pytest.param(40, marks=pytest.mark.evidence)])
def test_a_late_clock_is_no_backlash(tmp_path: Path, counts: int) -> None:
    """Legs that were cut at the steps of the counters told 9 mm of backlash, for certain."""
    late = hide("reference_delay", LATE, seed=1).peculiarity
    said = diagnosed(tmp_path, counts, [late]).to_dict()
    assert [each["effect"] for each in said["found"]] == ["reference_delay"]
    assert said["found"][0]["parameters"]["delay"]["value"] == pytest.approx(LATE, rel=0.15)


@pytest.mark.parametrize("counts", [100, pytest.param(60, marks=pytest.mark.evidence)])
def test_slip_is_no_late_clock(tmp_path: Path, counts: int) -> None:
    """Accelerations of single messages are of the counters' steps: a late clock explained more."""
    slip = hide("longitudinal_slip", 0.04, seed=1).peculiarity
    first, *_ = diagnosed(tmp_path, counts, [slip]).to_dict()["found"]
    assert first["effect"] == "longitudinal_slip"
    share = first["parameters"]["coefficient"]
    assert abs(share["value"] - 0.04) < 3.0 * share["std"] < 0.02


def test_nothing_is_nothing_and_what_is_not_asked_is_said(tmp_path: Path) -> None:
    found = diagnosed(tmp_path, 40, [])
    assert found.to_dict()["verdict"] == "none"
    words = " ".join(found.summary().split())
    assert "A count of a wheel is 7.9 mm" in words
    assert "(coulomb_slip) are not looked for, and would look like longitudinal_slip" in words
