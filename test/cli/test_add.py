# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi add` on the command line: a new robot file, JSON, or one line and nothing written."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import pytest

from test.cli.commands import PLAIN, written
from test.command_line import Werrimbi
from werrimbi_odom.cli.main import main
from werrimbi_odom.effects import find
from werrimbi_odom.files.robot_files.robot_file import read_robot_file


@pytest.fixture(scope="module")
def creeping(tmp_path_factory: pytest.TempPathFactory) -> Path:
    truth = replace(PLAIN, effects=(find("lateral_slip").using(creep=0.02),))
    return written(tmp_path_factory.mktemp("creeping"), [truth] * 4)


def words(folder: Path, effect: str, out: Path, *more: object) -> list[str]:
    runs = sorted(str(path) for path in folder.glob("run_*"))
    robot = str(folder / "robot.yaml")
    given = ["add", effect, "--robot", robot, *runs[:3], "--holdout", runs[3], "--out", str(out)]
    return [*given, *map(str, more)]


def test_it_writes_what_the_node_reads(
    creeping: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out, figures = tmp_path / "new.yaml", tmp_path / "f.json"
    assert main(words(creeping, "lateral_slip", out, "--json", figures)) == 0
    robot = read_robot_file(out).robot
    assert robot.effects[0].values["creep"] == pytest.approx(0.02, abs=2e-3)
    found = json.loads(figures.read_text())
    assert found["effect"] == "lateral_slip"
    assert found["parameters"]["creep"]["value"] == pytest.approx(robot.effects[0].values["creep"])
    assert found["holdout"]["after"] < found["holdout"]["before"]
    said = capsys.readouterr().out
    assert re.search(r"creep = (19|20)\.\d+ ± \S+ ms", said)
    assert "werrimbi diagnose --robot" in said


def test_what_does_not_help_is_refused_in_one_line(
    creeping: Path, tmp_path: Path, werrimbi: Werrimbi
) -> None:
    out, figures = tmp_path / "new.yaml", tmp_path / "f.json"
    said = werrimbi(*words(creeping, "wheels_swapped", out, "--json", figures), code=2).err
    assert said.count("\n") == 1
    assert "wheels_swapped does not lower the error" in said
    assert not out.exists()
    assert not figures.exists()


@pytest.mark.parametrize(
    ("effect", "told"), [("lateral_slipp", "nearest known one is lateral_slip"), ("", "unknown")]
)
def test_an_unknown_name_is_one_line(
    creeping: Path, tmp_path: Path, effect: str, told: str, werrimbi: Werrimbi
) -> None:
    assert told in werrimbi(*words(creeping, effect, tmp_path / "new.yaml"), code=2).err


def test_an_existing_file_is_kept(
    creeping: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "new.yaml"
    out.write_text("mine")
    assert main(words(creeping, "lateral_slip", out)) == 2
    assert out.read_text() == "mine"
    assert "--force overwrites it" in capsys.readouterr().err


@pytest.mark.evidence
def test_several_effects_are_added_at_once(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    effects = (find("wheels_swapped").using(), find("lateral_slip").using(creep=0.02))
    folder = written(tmp_path, [replace(PLAIN, effects=effects)] * 4)
    out, figures = tmp_path / "new.yaml", tmp_path / "f.json"
    both = "wheels_swapped,lateral_slip"
    assert main(words(folder, both, out, "--json", figures)) == 0
    found = json.loads(figures.read_text())
    assert found["effect"] == both
    assert found["effects"] == both.split(",")
    assert found["parameters"].keys() == {"lateral_slip.creep"}
    assert found["p_values"]["wheels_swapped"] is None
    robot = read_robot_file(out).robot
    assert [item.name for item in robot.effects] == both.split(",")
    said = capsys.readouterr().out
    command = said.split("Is more missing?")[1].replace("\\\n", " ").split()
    assert main(command[1:]) == 0
    assert capsys.readouterr().out.startswith("Nothing is missing")

    assert main(words(folder, f"{both},left_backlash", tmp_path / "other.yaml")) == 2
    refused = capsys.readouterr().err
    assert refused.count("\n") == 1
    assert "the drives do not show left_backlash" in refused or "left_backlash does not" in refused
    assert f"without left_backlash: werrimbi add {both} ..." in refused
    assert main(words(folder, "lateral_slip,lateral_slip", tmp_path / "other.yaml")) == 2
    assert "names lateral_slip twice" in capsys.readouterr().err
