# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Which folders are robots, and which of their files are runs."""

from __future__ import annotations

from pathlib import Path

import pytest

from werrimbi_odom.fleet.members import members_of, natural


def touch(*paths: Path) -> None:
    for path in paths:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("")


def test_numbers_in_names_count_as_numbers() -> None:
    names = ["b", "robot_10", "robot_2_spare", "robot_2", "10", "9", "robot_b", "Robot_1"]
    assert sorted(names, key=natural) == [
        "9", "10", "Robot_1", "b", "robot_2", "robot_2_spare", "robot_10", "robot_b",
    ]  # fmt: skip


def test_runs_lie_in_train_in_runs_or_beside_the_robot_file(tmp_path: Path) -> None:
    robot = tmp_path / "a"
    touch(
        robot / "robot.yaml",
        robot / "truth.json",
        robot / "photos" / "front.png",
        robot / "morning" / "ticks.csv",
        robot / "bag" / "metadata.yaml",
        robot / "cut_off" / "drive_0.mcap",
        robot / "evening.mcap",
        robot / "runs" / "r" / "ticks.csv",
        robot / "train" / "lost_its_ticks" / "reference.csv",
        robot / "train" / ".hidden" / "ticks.csv",
        robot / "train" / "notes.txt",
        robot / "holdout" / "h" / "ticks.csv",
    )
    (member,) = members_of(tmp_path)
    assert [str(path.relative_to(robot)) for path in member.runs] == [
        "bag",
        "cut_off",
        "evening.mcap",
        "morning",
        "runs/r",
        "train/lost_its_ticks",
    ]
    assert [path.name for path in member.holdout] == ["h"]
    assert member.problem == ""


def test_a_robot_that_lacks_something_is_told_beside_the_others(tmp_path: Path) -> None:
    touch(
        tmp_path / "good" / "robot.yaml",
        tmp_path / "good" / "train" / "r" / "ticks.csv",
        tmp_path / "no_file" / "train" / "r" / "ticks.csv",
        tmp_path / "no_runs" / "robot.yaml",
        tmp_path / "tests_alone" / "robot.yaml",
        tmp_path / "tests_alone" / "holdout" / "r" / "ticks.csv",
        tmp_path / "twice" / "robot.yaml",
        tmp_path / "twice" / "train" / "r" / "ticks.csv",
        tmp_path / "of_no_robot" / "report.pdf",
    )
    (tmp_path / "twice" / "train" / "again").symlink_to(tmp_path / "twice" / "train" / "r")
    problems = {member.name: member.problem for member in members_of(tmp_path)}
    assert problems.keys() == {"good", "no_file", "no_runs", "tests_alone", "twice"}
    assert problems["good"] == ""
    assert "holds runs but no robot.yaml" in problems["no_file"]
    assert "holds no runs" in problems["no_runs"]
    assert "needs some in train/" in problems["tests_alone"]
    assert "given twice" in problems["twice"]


@pytest.mark.parametrize("name", ["nul\0byte", "x" * 300])
def test_a_name_that_no_folder_has(name: str) -> None:
    with pytest.raises(ValueError, match="--fleet"):
        members_of(Path(name))
