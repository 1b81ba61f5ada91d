# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Nothing but the one file is ever written, and nobody's file is overwritten."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from test.workbench.session import ROBOT
from werrimbi_odom.effects import find
from werrimbi_odom.files.robot_files.robot_file import RobotFile, read_robot_file
from werrimbi_odom.files.text_files import beside
from werrimbi_odom.workbench.saving import Target, file_of, saved, text_of
from werrimbi_odom.workbench.session import Session, begun


@pytest.fixture
def source(tmp_path: Path) -> RobotFile:
    path = tmp_path / "robot.yaml"
    path.write_text(ROBOT)
    return read_robot_file(path)


def session(source: RobotFile) -> Session:
    slip = find("lateral_slip").using(creep=0.003)
    robot = replace(source.robot, wheel_separation_multiplier=1.01, effects=(slip,))
    look: Any = SimpleNamespace(robot=robot)
    return begun(look)


def test_what_is_shown_before_is_what_is_written(source: RobotFile, tmp_path: Path) -> None:
    at = session(source)
    done = saved(source, at, Target(tmp_path / "new.yaml"))
    text = (tmp_path / "new.yaml").read_text()
    assert text == text_of(source, at.now.look.robot)
    assert "# As its maker believes it to be." in text
    assert read_robot_file(tmp_path / "new.yaml").robot == at.now.look.robot
    assert (tmp_path / "robot.yaml").read_text() == ROBOT
    assert file_of(done) == tmp_path / "new.yaml"


def test_a_tab_writes_its_own_file_again_and_another_tab_the_next_number(
    source: RobotFile, tmp_path: Path
) -> None:
    target = Target(Path(beside(source.path, "new")))
    first = saved(source, session(source), target)
    assert target.of(first) == tmp_path / "robot_new.yaml"
    assert saved(source, first, target).saved.keys() == first.saved.keys()
    second = saved(source, session(source), target, taken=set(first.saved))
    assert list(second.saved) == [tmp_path / "robot_new_2.yaml"]
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "robot.yaml",
        "robot_new.yaml",
        "robot_new_2.yaml",
    ]


def test_what_was_edited_since_is_not_overwritten(source: RobotFile, tmp_path: Path) -> None:
    target = Target(tmp_path / "new.yaml", force=True)
    mine = tmp_path / "new.yaml"
    mine.write_text("old")
    done = saved(source, session(source), target)
    edited = mine.read_text() + "    # by hand\n"
    mine.write_text(edited)
    done = saved(source, done, target)
    assert mine.read_text() == edited
    assert target.of(done) == tmp_path / "new_2.yaml", "from now on that is its file"
    done = saved(source, done, target)
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "new.yaml",
        "new_2.yaml",
        "robot.yaml",
    ]
    (tmp_path / "new_2.yaml").unlink()
    assert target.of(done) == tmp_path / "new_2.yaml", "whoever takes it away may have it again"


@pytest.mark.parametrize("force", [False, True])
def test_a_link_that_comes_in_its_place_is_not_followed(
    source: RobotFile, tmp_path: Path, force: bool
) -> None:
    target = Target(tmp_path / "new.yaml", force)
    done = saved(source, session(source), target)
    for at in (done, session(source)):
        (tmp_path / "new.yaml").unlink()
        (tmp_path / "new.yaml").symlink_to(source.path)
        saved(source, at, target)
        assert source.path.read_text() == ROBOT
    (tmp_path / "new.yaml").unlink()
    (tmp_path / "new.yaml").symlink_to(tmp_path / "nowhere")
    saved(source, done, target)
    assert not (tmp_path / "nowhere").exists()


def test_whole_numbers_are_shown_as_they_are_written(source: RobotFile, tmp_path: Path) -> None:
    """The node's parameters are typed: 1 is no double, so 1.0 is written."""
    source.path.write_text(ROBOT.replace("wheel_separation: 0.35 ", "wheel_separation: 1 "))
    whole = read_robot_file(source.path)
    at = session(whole)
    saved(whole, at, Target(tmp_path / "new.yaml"))
    text = (tmp_path / "new.yaml").read_text()
    assert "wheel_separation: 1.0 " in text
    assert text_of(whole, at.now.look.robot) == text


def test_what_is_there_already_stays_but_with_force(source: RobotFile, tmp_path: Path) -> None:
    there = tmp_path / "mine.yaml"
    there.write_text("precious")
    done = saved(source, session(source), Target(there))
    assert list(done.saved) == [tmp_path / "mine_2.yaml"]
    assert there.read_text() == "precious"
    saved(source, session(source), Target(there, force=True))
    assert there.read_text() != "precious"


def test_force_is_for_the_first_tab_alone(source: RobotFile, tmp_path: Path) -> None:
    target = Target(tmp_path / "mine.yaml", force=True)
    first = saved(source, session(source), target)
    second = saved(source, session(source), target, taken=set(first.saved))
    assert list(second.saved) == [tmp_path / "mine_2.yaml"]
