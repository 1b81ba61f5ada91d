# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi odom` on every recorded robot; the recordings are not ours, so they lie elsewhere."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from test.command_line import Werrimbi
from test.recorded_robots import MISSING, ROBOTS, TURTLEBOT3_BAGS, with_recordings
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.model.covariance import path_noise

RUNS = sorted(path.parent for path in ROBOTS.glob("*/*/ticks.csv"))


def columns(path: Path) -> dict[str, np.ndarray]:
    with path.open() as file:
        header, *rows = csv.reader(file)
    table = np.array([[float(cell or "nan") for cell in row] for row in rows])
    return dict(zip(header, table.T, strict=True))


def of_each_robot_one() -> list[Any]:
    """All of them in `make evidence`."""
    firsts = {run.parent: run for run in reversed(RUNS)}
    return [
        pytest.param(
            run,
            id=f"{run.parent.name}/{run.name}",
            marks=[pytest.mark.evidence] * (run is not firsts[run.parent]),
        )
        for run in RUNS
    ]


@with_recordings
@pytest.mark.parametrize("run", of_each_robot_one())
def test_every_recorded_drive(run: Path, tmp_path: Path, werrimbi: Werrimbi) -> None:
    out, figures = tmp_path / "odom.csv", tmp_path / "figures.json"
    words = ["odom", "--robot", run.parent / "robot.yaml", run, "--out", out, "--json", figures]
    said = werrimbi(*words)
    remarks = said.err.splitlines()
    assert all("they are stamped late" in each for each in remarks)  # the skid steer's gyro

    ticks, reference, rows = (
        columns(run / "ticks.csv"),
        columns(run / "reference.csv"),
        columns(out),
    )
    np.testing.assert_array_equal(rows["t_s"], ticks["t_s"])
    for name in ("x_m", "y_m"):
        begins = reference[name][0]  # of a gyro there is none: dead reckoning begins at zero
        assert rows[name][0] == (begins if np.isfinite(begins) else 0.0)
    if np.isfinite(reference["yaw_rad"]).any():
        apart = rows["yaw_rad"][0] - reference["yaw_rad"][0]
        assert np.cos(apart) == pytest.approx(1.0)
    else:
        assert "least squares" in " ".join(said.out.replace("│", " ").split())
    assert np.abs(rows["yaw_rad"]).max() <= np.pi

    covariance = np.array(
        [
            [rows["xx"], rows["xy"], rows["xyaw"]],
            [rows["xy"], rows["yy"], rows["yyaw"]],
            [rows["xyaw"], rows["yyaw"], rows["yawyaw"]],
        ]
    ).transpose(2, 0, 1)
    spread = np.linalg.eigvalsh(covariance)
    assert (spread[:, 0] >= -1e-12 * spread[:, -1]).all(), "positive semi-definite at every row"
    robot = read_robot_file(run.parent / "robot.yaml").robot
    noise = path_noise(robot, robot.left_tick, robot.right_tick)
    # An encoder that flickers back by a count within a piece takes that count's noise back.
    assert (np.diff(rows["yawyaw"]) >= -1.001 * noise.b).all(), "dead reckoning never learns"

    found = json.loads(figures.read_text())
    assert found["rows"]["messages"] == ticks["t_s"].size
    assert (found["end_error_m"] is not None) == np.isfinite(reference["x_m"]).any()
    assert found["distance_m"] > 0.0


@pytest.mark.skipif(not TURTLEBOT3_BAGS.is_dir(), reason=MISSING)
@pytest.mark.parametrize("at", ["16_53_28", "17_00_32"])
def test_of_a_turtlebots_bag_is_told_what_it_is_good_for(at: str, werrimbi: Werrimbi) -> None:
    """What docs/turtlebot3.md says of `info`, and of the order of its lidar's beams."""
    said = werrimbi("info", TURTLEBOT3_BAGS / f"rosbag2_2025_11_06-{at}").words
    assert "Reference /imu: headings alone" in said
    assert "No reference: /odom, odom -> base_footprint is the robot's own odometry" in said
    assert "its driver states them the other way round" in said


@with_recordings
def test_there_are_four_robots() -> None:
    """So that a glob that finds nothing does not pass for a test of all."""
    assert len({run.parent.name for run in RUNS}) >= 4
