# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Drives that a tape measured at both ends: how many more are needed, and what tells meanwhile."""

from __future__ import annotations

import json
import shlex
from dataclasses import replace
from pathlib import Path

import pytest

from test.cli.commands import PLAIN, ROBOT_FILE, write_run
from test.command_line import Werrimbi
from test.inference.driven import run_of
from werrimbi_odom.cli.main import main
from werrimbi_odom.inference.diagnosis.splitting import held_of_few

WIDE = 1.03
"""Its base, over that of its file."""


def drives(folder: Path, count: int) -> list[Path]:
    """Drives of half a minute, by the poses at their ends."""
    (folder / "robot.yaml").write_text(ROBOT_FILE)
    for number in range(count):
        run = run_of(replace(PLAIN, wheel_separation_multiplier=WIDE), number, 30)
        assert run.reference is not None
        ends = run.reference.chosen([0, run.reference.time.size - 1])
        write_run(folder / run.name, replace(run, reference=ends))
    return sorted(folder.glob("run_*"))


@pytest.fixture(scope="module")
def six(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    return drives(tmp_path_factory.mktemp("tape"), 6)


def fit_command(words: str) -> list[str]:
    """The words after `werrimbi` of the printed calibration, as a shell takes them."""
    _, found, command = words.replace("\\", "").partition("werrimbi calibrate fit ")
    assert found, words
    return ["calibrate", "fit", *shlex.split(command.partition(".yaml Errors")[0])]


@pytest.mark.evidence
def test_by_tape_the_printed_calibration_finds_the_base(
    six: list[Path],
    werrimbi: Werrimbi,
    capsys: pytest.CaptureFixture[str],
) -> None:
    robot = six[0].parent / "robot.yaml"
    told = werrimbi("info", *six, "--robot", robot).words
    assert "4 more drives like these" in told
    assert main([*fit_command(told)]) == 0
    new = (robot.parent / "robot_fitted.yaml").read_text()
    line = next(line for line in new.splitlines() if "separation_multiplier" in line)
    assert float(line.split()[1]) == pytest.approx(WIDE, abs=0.01)
    capsys.readouterr()
    told = werrimbi("compare", *six, "--robot", robot).words
    assert "Too little to judge: 6 legs" in told
    assert "4 more drives like these" in told
    assert str(robot.parent) in fit_command(told)[3]
    assert main(["diagnose", *map(str, six), "--robot", str(robot)]) == 2
    told = " ".join(capsys.readouterr().err.split())
    assert "2 more drives like these, a quarter of all being put aside" in told
    assert fit_command(told)[-2:] == ["--out", str(robot.parent / "robot_fitted.yaml")]


def test_two_more_are_enough_to_diagnose() -> None:
    assert [drives - held_of_few(drives) for drives in (6, 7, 8)] == [4, 5, 6]


def test_one_drive_by_tape_is_no_proof_of_base_and_radii(
    six: list[Path], werrimbi: Werrimbi, tmp_path: Path
) -> None:
    """Its three numbers are those of base and radii, whatever is wrong."""
    robot = six[0].parent / "robot.yaml"
    out = werrimbi("info", six[0], "--robot", robot, "--json", tmp_path / "info.json").words
    assert "Together with other drives it can show" in out
    assert "9 more drives like these" in out
    assert "calibrate fit" not in out
    [drive] = json.loads((tmp_path / "info.json").read_text())["runs"]
    assert not any("sideways" in what or "reversals" in what for what in drive["can_show"])
    assert "calibrate fit" not in werrimbi("compare", six[0], "--robot", robot).words
