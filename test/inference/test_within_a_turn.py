# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What happens within a turn of a wheel is told by legs that are shorter than a turn."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

import werrimbi_odom as wo
from test.inference.driven import common
from test.inference.positions import positions_of_a_point
from test.model.drives import ROBOT
from test.robot_file import BARE
from werrimbi_odom.api.result import Result
from werrimbi_odom.effects import find
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis, shorter_leg
from werrimbi_odom.report.terminal import as_text

BUMPED = replace(ROBOT, effects=(find("right_tread_bump").using(height=2.0e-3, place=0.7),))
FILE = f"{BARE}    left_wheel_noise: 0.0004\n    right_wheel_noise: 0.0004\n"


def on_a_circle() -> Run:
    """To the left, on a circle of one metre."""
    speeds = [0.3] * 4
    return positions_of_a_point("circle", speeds, speeds, truth=BUMPED, seed=1)


EFFECTS = common(
    *("left_tread_bump", "right_tread_bump", "eccentric_left_wheel", "eccentric_right_wheel"),
    *("oval_left_wheel", "oval_right_wheel"),
)
"""Among them all that goes with the angle of a wheel."""


@pytest.fixture(scope="module", autouse=True)
def library() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("werrimbi_odom.effects.lookup.LIBRARY", EFFECTS)
        yield


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> wo.RobotFile:
    path = tmp_path_factory.mktemp("within") / "robot.yaml"
    path.write_text(FILE, encoding="utf-8")
    return wo.read_robot(path)


@pytest.fixture(scope="module")
def found(robot: wo.RobotFile) -> Result[AdvisedDiagnosis]:
    return wo.diagnose(robot, on_a_circle())


@pytest.mark.evidence
def test_a_bump_is_a_larger_wheel_until_legs_are_shorter_than_a_turn(
    found: Result[AdvisedDiagnosis],
) -> None:
    said = found.to_dict()
    assert (said["verdict"], said["effect"]) == ("named", "right_tread_bump")
    assert found.found.open_at == 1.0
    assert said["leg_m"] == pytest.approx(2.0 * math.pi * ROBOT.wheel_radius / 3.0, abs=0.005)
    (size,) = (each["parameters"]["height"] for each in said["found"])
    assert size["value"] == pytest.approx(2.0e-3, abs=3.0 * size["std"])


@pytest.mark.evidence
def test_the_printed_command_keeps_those_legs_and_what_is_left_is_noise(
    found: Result[AdvisedDiagnosis], robot: wo.RobotFile, tmp_path: Path
) -> None:
    words = " ".join(as_text(found.document().words).split())
    assert "Legs of 1 m leave it open" in words
    assert "add right_tread_bump" in words
    assert "--leg 0.1" in words
    drive, better = on_a_circle(), tmp_path / "better.yaml"
    wo.add("right_tread_bump", robot, drive, leg=0.1).write_robot(better)
    assert wo.diagnose(wo.read_robot(better), drive).to_dict()["verdict"] == "none"


@pytest.mark.evidence
def test_legs_that_are_short_enough_already_are_left_alone(found: Result[AdvisedDiagnosis]) -> None:
    open_still = replace(found.found.diagnosis, verdict="ambiguous", rivals=("right_tread_bump",))
    assert shorter_leg(open_still, 1.0) == pytest.approx(0.1)
    assert shorter_leg(open_still, 0.15) is None
    assert shorter_leg(found.found.diagnosis, 1.0) is None


@pytest.mark.evidence
def test_few_legs_that_leave_it_open_are_cut_into_shorter_ones(
    found: Result[AdvisedDiagnosis],
) -> None:
    """Of 12 m and two turns: the legs that `info` proposes for so little driving."""
    open_still = replace(found.found.diagnosis, verdict="ambiguous", rivals=("track_width",))
    assert shorter_leg(open_still, 1.0) == 0.25
    assert shorter_leg(open_still, 0.5) is None, "there are thirty of them"
    assert shorter_leg(open_still, 0.25) is None
    assert shorter_leg(replace(open_still, verdict="unknown"), 1.0) is None
