# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi calibrate` as a command, and `fit`: a new robot file, or the reason why not."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import werrimbi_odom as wo
from test.cli.commands import RECORDING, written_by
from test.command_line import Werrimbi
from test.recorded_robots import ROBOTS, with_recordings
from werrimbi_odom.cli.calibrate import KINDS
from werrimbi_odom.effects import find
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.inference.fitting.noise import NoiseEstimate
from werrimbi_odom.report.calibration.fit_words import fit_in_words
from werrimbi_odom.report.terminal import as_text


@pytest.mark.parametrize("kind", ["umbmark", "noise"])
def test_help(kind: str, werrimbi: Werrimbi) -> None:
    assert "--robot" in werrimbi("calibrate", kind, "--help").out


def test_the_kinds_are_listed(werrimbi: Werrimbi) -> None:
    said = werrimbi("calibrate", "--help").out
    assert "umbmark" in said
    assert "noise" in said


@pytest.mark.parametrize(
    "words",
    [
        ["calibrate"],
        ["calibrate", "guess"],
        ["calibrate", "umbmark", "none.csv", "--side", "4", "--robot", "r", "--out", "n"],
        ["calibrate", "umbmark", "none.csv", "--side", "wide", "--robot", "r", "--out", "n"],
        ["calibrate", "noise", "none.csv", "--distance", "10", "--robot", "r", "--out", "n"],
    ],
)
def test_bad_use_is_one_line_and_exit_2(
    words: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, werrimbi: Werrimbi
) -> None:
    monkeypatch.chdir(tmp_path)
    said = werrimbi(*words, code=2).err
    assert said.count("\n") == 1
    assert "Traceback" not in said


def test_a_package_that_is_not_installed_is_named(
    monkeypatch: pytest.MonkeyPatch, werrimbi: Werrimbi
) -> None:
    def without_scipy(arguments: object) -> int:
        raise ModuleNotFoundError("No module named 'scipy'", name="scipy")

    monkeypatch.setitem(KINDS, "noise", (*KINDS["noise"][:2], without_scipy))
    words = ["calibrate", "noise", "r.csv", "--distance", "1", "--robot", "r", "--out", "n"]
    assert "needs the Python package scipy" in werrimbi(*words, code=2).err


def fit(tmp_path: Path, *arguments: str) -> dict[str, object]:
    words = ("calibrate", "fit", *arguments, "--out", tmp_path / "new.yaml")
    return written_by(tmp_path / "figures.json", *words)


def wrong_robot(tmp_path: Path) -> Path:
    """The shipped robot's file with base and left radius entered wrongly."""
    text = (RECORDING / "robot.yaml").read_text()
    text = text.replace("wheel_separation: 0.35 ", "wheel_separation: 0.36 ")
    text = text.replace("left_wheel_radius_multiplier: 1.0 ", "left_wheel_radius_multiplier: 1.01 ")
    assert "0.36" in text
    assert "1.01" in text
    path = tmp_path / "wrong.yaml"
    path.write_text(text)
    return path


def test_a_wrong_base_and_radius_are_found_in_one_drive_of_the_engine(tmp_path: Path) -> None:
    robot = wrong_robot(tmp_path)
    page = tmp_path / "page.html"
    found = fit(tmp_path, "--robot", str(robot), str(RECORDING), "--report", str(page))
    assert found["trusted"] is True
    parameters = found["parameters"]
    assert isinstance(parameters, dict)
    truth = {
        "wheel_separation_multiplier": 0.35 / 0.36,
        "left_wheel_radius_multiplier": 1.0,
        "right_wheel_radius_multiplier": 1.0,
    }
    for name, value in truth.items():
        assert parameters[name]["value"] == pytest.approx(value, abs=4.0 * parameters[name]["std"])
    written = read_robot_file(tmp_path / "new.yaml")
    assert written.robot.wheel_separation_multiplier == pytest.approx(0.9722, abs=2e-3)
    assert "# m, between the wheels' contact points" in (tmp_path / "new.yaml").read_text()
    assert page.stat().st_size > 1_000_000


def test_one_leg_on_which_the_reference_jumped_is_told_as_one() -> None:
    robot = wo.read_robot(RECORDING / "robot.yaml")
    found = wo.calibrate_fit(robot, RECORDING).found
    assert [int(legs.sum()) for legs in found.excluded] == [0]
    one = np.arange(found.excluded[0].size) == 3
    said = [getattr(part, "text", "") for part in fit_in_words(replace(found, excluded=(one,)))]
    assert "1 leg on which the reference jumped was left out." in said
    # A sound reference that is 60 ms late was said to have jumped where the robot drove hard.
    late = replace(found, excluded=(one,), strange=("no wheel is so noisy",))
    said = " ".join(as_text(fit_in_words(late)).split())
    assert "on which the reference jumped" not in said
    assert "1 leg was left out: either the reference jumped there, or what is missing" in said
    assert "(give --reference-kind local_map here too)." in said
    play = replace(found.robot, effects=(find("left_backlash").using(travel=0.002),))
    said = " ".join(as_text(fit_in_words(replace(late, robot=play))).split())
    # Where `diagnose` finds nothing more, and sent here, it is this.
    assert "here too), or the law of left_backlash does not quite fit." in said


def test_a_noise_that_is_not_determined_is_below_the_end_of_its_interval() -> None:
    """A true 4e-4 was "below 2e-04": twice a deviation that is one of the logarithm."""
    found = wo.calibrate_fit(wo.read_robot(RECORDING / "robot.yaml"), RECORDING).found
    noise = NoiseEstimate(1.4e-4, 0.58, determined=False)
    said = as_text(fit_in_words(replace(found, noises={"left_wheel_noise": noise})))
    assert "not determined (below 4.4e-04 m^0.5)" in said


@with_recordings
@pytest.mark.parametrize(
    ("robot", "runs", "kind"),
    [
        ("khepera_laser_to_the_side", ["part_0", "part_1"], "incremental"),
        ("khepera_laser_moved", ["part_0", "part_1"], "incremental"),
        ("labyrinth", ["drive"], "absolute"),
    ],
)
def test_where_calibration_is_not_what_is_missing_it_gives_no_error_bars(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], robot: str, runs: list[str], kind: str
) -> None:
    folder = ROBOTS / robot
    found = fit(
        tmp_path,
        *("--robot", str(folder / "robot.yaml"), "--leg", "0.1", "--reference-kind", kind),
        *(str(folder / run) for run in runs),
    )
    assert found["trusted"] is False
    assert found["something_else_is_missing"]
    parameters = found["parameters"]
    assert isinstance(parameters, dict)
    assert all(item["std"] is None for item in parameters.values())
    assert "Something else is missing" in capsys.readouterr().out
