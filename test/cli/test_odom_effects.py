# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi odom` of robots with effects: what a reference shows, phases, effects of one's own."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from test.cli.odometry import ROBOT, TICK, command, figures, odom, reference, table, ticks
from test.command_line import Complaint, Printed
from werrimbi_odom.effects import find
from werrimbi_odom.model.effect import view_of
from werrimbi_odom.model.pose import Pose
from werrimbi_odom.model.reference_measurement import shown
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.trajectory import trajectory


def robot_with(place: Path, effects: str, *lines: str) -> None:
    text = ROBOT + f"    effects: [{effects}]\n" + "".join(f"    {line}\n" for line in lines)
    (place / "robot.yaml").write_text(text)


def turning(place: Path) -> np.ndarray:
    """A drive that curves, spins and goes back; returns time, left and right counts."""
    time = 0.05 * np.arange(600)
    speed, yaw_rate = 0.4 * np.cos(0.3 * time), 0.9 * np.sin(0.21 * time)
    left = np.rint(np.cumsum((speed - 0.2 * yaw_rate) * 0.05) / TICK).astype(int)
    right = np.rint(np.cumsum((speed + 0.2 * yaw_rate) * 0.05) / TICK).astype(int)
    rows = list(zip(np.round(time, 6).tolist(), left.tolist(), right.tolist(), strict=True))
    ticks(place, rows)
    return np.array(rows)


def measured(place: Path, effects: tuple[Any, ...], start: Pose = Pose(2.0, -1.0, 0.8)) -> None:  # noqa: B008
    """Let a reference look at the robot, at each row; a view of the model itself, so exact."""
    time, left, right = turning(place).T
    robot = Robot(0.4, 0.1, 1000.0, 1000.0, effects=effects)
    seen = shown(trajectory(robot, time, left, right, start=start), view_of(effects))
    rows = zip(time, seen.x, seen.y, seen.yaw, strict=True)
    reference(place, *(",".join(repr(float(cell)) for cell in row) for row in rows))


VIEWS = {
    "an arm": (("reference_lever_arm", {"x": 0.2, "y": -0.1}),),
    "an axis askew": (("reference_yaw_offset", {"angle": 1.2}),),
    "late": (("reference_delay", {"delay": 0.17}),),
    "early": (("reference_delay", {"delay": -0.17}),),
    "a late heading": (("reference_heading_delay", {"delay": 0.1}),),
    "mirrored": (("reference_mirrored", {}),),
    "all at once": (
        ("reference_mirrored", {}),
        ("reference_delay", {"delay": -0.1}),
        ("reference_yaw_offset", {"angle": -0.4}),
        ("reference_lever_arm", {"x": -0.3, "y": 0.05}),
        ("lateral_slip", {"creep": 0.05}),
        ("floor_slope", {"x": 0.01}),
    ),
}


@pytest.mark.parametrize("view", VIEWS)
def test_as_reference_shows_what_the_reference_shows(place: Path, view: str) -> None:
    """From the first row to the last, with nothing but the first pose taken from it."""
    effects = tuple(find(name).using(**values) for name, values in VIEWS[view])
    measured(place, effects)
    blocks = [f"{name}: {json.dumps(values)}" for name, values in VIEWS[view] if values]
    robot_with(place, ", ".join(name for name, _ in VIEWS[view]), *blocks)
    assert odom(place, "--as-reference") == 0
    rows = table(place / "odom.csv")
    seen = np.genfromtxt(place / "run" / "reference.csv", delimiter=",", skip_header=1)
    assert rows.shape[0] == seen.shape[0], "a row for each row of ticks"
    np.testing.assert_allclose(rows[:, 1:3], seen[:, 1:3], atol=1e-9)
    np.testing.assert_allclose(np.exp(1j * rows[:, 3]), np.exp(1j * seen[:, 3]), atol=1e-9)
    found = figures(place)
    assert found["end_error_m"] < 1e-9, "what is compared is what the reference shows"
    assert abs(found["end_error_rad"]) < 1e-9


def test_without_as_reference_it_is_the_axle_that_starts_where_the_arm_says(place: Path) -> None:
    arm = find("reference_lever_arm").using(x=0.2, y=-0.1)
    measured(place, (arm,), Pose(2.0, -1.0, 0.8))
    robot_with(place, "reference_lever_arm", "reference_lever_arm: {x: 0.2, y: -0.1}")
    found = figures(place)
    rows = table(place / "odom.csv")
    np.testing.assert_allclose(rows[0, 1:4], (2.0, -1.0, 0.8), atol=1e-12)
    assert "measures 200 mm ahead and -100 mm to the left" in found["start"]["says"]


def test_an_eccentric_wheel_is_learnt_from_the_run_s_reference(
    place: Path, printed: Printed
) -> None:
    wheel = find("eccentric_left_wheel")
    measured(place, (wheel.using(amplitude=0.002, phase=2.0),))
    robot_with(place, "eccentric_left_wheel", "eccentric_left_wheel: {amplitude: 0.002}")
    learnt = figures(place)
    assert learnt["end_error_m"] < 1e-5
    told = printed()
    assert "phase 2.000 ± 0.000 rad, learnt from the reference of this run" in told
    odom(place)
    with_it = table(place / "odom.csv")
    (place / "run" / "reference.csv").unlink()
    told = figures(place)["notes"]
    assert any(
        "eccentric_left_wheel is left out: its phase is another in each run" in n for n in told
    )
    (place / "robot.yaml").write_text(ROBOT)
    without = table(place / "odom.csv")
    assert odom(place) == 0
    np.testing.assert_array_equal(table(place / "odom.csv"), without)
    assert np.abs(np.diff(with_it[:, 3]) - np.diff(without[:, 3])).max() > 1e-4


OWN = """\
from werrimbi_odom.model.effect import Parameter, wheel_effect
from werrimbi_odom.model.motion import WheelTravel


@wheel_effect(
    channels=("payload_kg",),
    loss=Parameter("1/kg", 0.0, 2e-3, (0.0, 0.05), "loss of radius per kilogram"),
)
def my_robot_sinks_in(travel, drive, loss):
    \"\"\"Tyres give way under a load.

    Formula    travel *= 1 - loss * payload
    Signature  distances too long by a share that follows the payload
    Ruler      measure the axle's height, empty and loaded
    \"\"\"
    share = 1.0 - loss * drive.channels["payload_kg"].mean
    return WheelTravel(travel.left * share, travel.right * share)
"""


def test_a_file_of_one_s_own_with_a_channel_of_the_record(
    place: Path, complaint: Complaint
) -> None:
    (place / "mine.py").write_text(OWN)
    robot_with(place, "my_robot_sinks_in", "my_robot_sinks_in: {loss: 0.01}")
    mine = place / "mine.py"
    assert "unknown effect my_robot_sinks_in" in complaint(*command(place))
    told = complaint(*command(place, "--effects", mine))
    assert "my_robot_sinks_in needs the measured channel payload_kg" in told
    rows = "".join(f"{0.1 * n!r},{10 * n},{10 * n},10.0\n" for n in range(11))
    (place / "run" / "ticks.csv").write_text("t_s,left_ticks,right_ticks,payload_kg\n" + rows)
    assert odom(place, "--effects", mine) == 0
    np.testing.assert_allclose(table(place / "odom.csv")[-1, 1], 0.9 * 100 * TICK, rtol=1e-12)
    told = complaint(*command(place, "--effects", place / "none.py"))
    assert "none.py: there is no such file" in told
