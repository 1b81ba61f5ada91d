# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`info` of a reference that is asked for in other words, and of clocks that are apart."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from test.cli.commands import ROBOT_FILE
from test.files.conftest import Messages
from test.files.unseen import JOINTS, joints, poses
from test.inference.driven import run_of
from test.inference.test_held_or_carried import held
from test.model.drives import ROBOT
from werrimbi_odom.cli.main import main

SIDES = ("left", "right")


def recorded(path: Path, *, behind: float = 0.0, frames: tuple[str, str] = ("", "")) -> Path:
    """A drive with a tracker's poses; `behind`: of the wheels' clock [s]."""
    ros, run = Messages(), held(run_of(ROBOT, 1, 40), 20.0, 26.0)[0]
    entries: list[Any] = []
    for topic, at, (kind, message) in joints(ros, run):
        stamp = message.header.stamp
        stamp.sec -= round(behind)
        entries.append((topic, at, (kind, message)))
    for _, at, (kind, message) in poses(ros, run):
        if frames[0]:
            moved = ros.transform(at, frames, 0.0, 0.0, 0.0)
            moved[1].transform.rotation = message.pose.orientation
            for part in "xyz":
                value = getattr(message.pose.position, part)
                setattr(moved[1].transform.translation, part, value)
            entries.append(("/tf", at, ros.transforms(moved)))
        else:
            entries.append(("/vrpn/robot/pose", at, (kind, message)))
    return ros.write(path, sorted(entries, key=lambda each: each[1]))


def told(bag: Path, folder: Path, capsys: pytest.CaptureFixture[str], *more: str) -> str:
    robot = folder / "robot.yaml"
    names = (
        f"    {side}_wheel_names: [{name}]\n" for side, name in zip(SIDES, JOINTS, strict=True)
    )
    robot.write_text(ROBOT_FILE + "".join(names))
    assert main(["info", str(bag), "--robot", str(robot), *more]) == 0
    return " ".join(capsys.readouterr().out.split())


@pytest.mark.parametrize("wish", ["/tf:robot", "/tf"])
def test_the_next_command_has_the_reference_that_was_asked_for(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], wish: str
) -> None:
    """Without it compare would ask which, or take another."""
    bag = recorded(tmp_path / "bag", frames=("world", "robot"))
    text = told(bag, tmp_path, capsys, "--reference-topic", wish)
    assert "--reference-topic /tf:world:robot" in text
    assert "It is taken" in text
    assert "Nothing that is read in the bag measures the robot" not in text


def test_clocks_that_are_apart_are_said_to_feign_a_carried_robot(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Wheels that are stamped 3 s early stand, and turn, before the robot does."""
    text = told(recorded(tmp_path / "bag", behind=3.0), tmp_path, capsys)
    assert "may look carried or held" in text
    assert "may look" not in told(recorded(tmp_path / "one clock"), tmp_path, capsys)
