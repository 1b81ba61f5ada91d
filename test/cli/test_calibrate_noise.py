# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi calibrate noise`: a table of end errors to k_L and k_R in the robot file."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

from test.cli.commands import called
from test.command_line import Printed
from werrimbi_odom.cli import calibrate
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.inference.calibration.noise_likelihood import design
from werrimbi_odom.inference.calibration.out_and_back import out_and_back

TRACK, K_LEFT, K_RIGHT = 0.35, 4.0e-4, 5.8e-4
ROBOT = """\
/**:
  ros__parameters:
    wheel_separation: 0.35
    wheel_radius: 0.05
    left_wheel_noise: 1.0e-3  # a guess
    left_ticks_per_revolution: 2000.0
    right_ticks_per_revolution: 2000.0
"""


def table(sigma_xy: float = 0.0, sigma_yaw: float = 0.0) -> str:
    """End errors drawn from the model, as a table; the reference's noise in them."""
    model = design(out_and_back(10.0, TRACK), TRACK, sigma_xy=sigma_xy, sigma_yaw=sigma_yaw)
    covariance = model.covariance(K_LEFT**2, K_RIGHT**2)
    rows = np.random.default_rng(1).multivariate_normal(np.zeros(3), covariance, 60)
    lines = [",".join(f"{value:.7f}" for value in row) for row in rows]
    return "\n".join(["ex_m,ey_m,eyaw_rad", *lines, ""])


@pytest.fixture
def desk(tmp_path: Path) -> Path:
    (tmp_path / "robot.yaml").write_text(ROBOT, encoding="utf-8")
    (tmp_path / "results.csv").write_text(table(), encoding="utf-8")
    return tmp_path


def noise(desk: Path, *words: object, distance: float = 10.0) -> int:
    files = ("--robot", desk / "robot.yaml", "--out", desk / "new.yaml")
    results = desk / "results.csv"
    return called(calibrate, "noise", results, "--distance", distance, *files, *words)


def figures(desk: Path) -> dict[str, object]:
    return json.loads((desk / "f.json").read_text(encoding="utf-8"))  # type: ignore[no-any-return]


def test_a_table_to_a_robot_file(desk: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert noise(desk, "--json", desk / "f.json", "--report", desk / "f.html") == 0
    new = read_robot_file(desk / "new.yaml").robot
    parameters = figures(desk)["parameters"]
    for name, true in (("left_wheel_noise", K_LEFT), ("right_wheel_noise", K_RIGHT)):
        found = parameters[name]  # type: ignore[index]
        assert getattr(new, name) == pytest.approx(found["value"], rel=1e-5)
        assert abs(found["value"] - true) < 3 * found["std"]
        assert found["low_95"] < found["value"] < found["high_95"]
    assert "# a guess" in (desk / "new.yaml").read_text(encoding="utf-8")
    assert "ellipse of the model" in (desk / "f.html").read_text(encoding="utf-8")
    said = capsys.readouterr().out
    assert "the model explains the scatter" in " ".join(said.split())
    assert "ellipses matched" in said


def test_wheels_that_cannot_be_told_apart(desk: Path, printed: Printed) -> None:
    (desk / "results.csv").write_text(table(10e-3, 5e-3), encoding="utf-8")
    words = ["--reference-sigma-xy", 0.01, "--reference-sigma-yaw", 0.005]
    assert noise(desk, *words, "--json", desk / "f.json") == 0
    assert figures(desk)["wheels_told_apart"] is False
    new = read_robot_file(desk / "new.yaml").robot
    assert new.left_wheel_noise == new.right_wheel_noise
    assert new.left_wheel_noise == pytest.approx(
        math.hypot(K_LEFT, K_RIGHT) / math.sqrt(2), rel=0.3
    )
    said = printed()
    assert "not which wheel has how much of it" in said
    assert "turns about the standing left wheel" in said


def test_turning_round_hides_the_difference(desk: Path, printed: Printed) -> None:
    assert noise(desk, "--turn-round", "--json", desk / "f.json") == 0
    assert figures(desk)["wheels_told_apart"] is False
    assert "backing to the mark would show it" in printed()


def test_a_noisy_reference_that_was_not_told_is_named(desk: Path, printed: Printed) -> None:
    (desk / "results.csv").write_text(table(8e-3, 6e-3), encoding="utf-8")
    assert noise(desk, "--json", desk / "f.json") == 0
    said = printed()
    assert "Careful" in said
    missing = figures(desk)["missing_reference"]
    assert missing["sigma_xy_m"] == pytest.approx(8e-3, rel=0.4)  # type: ignore[index]
    assert missing["sigma_yaw_rad"] == pytest.approx(6e-3, rel=0.4)  # type: ignore[index]
    assert "--reference-sigma-xy" in said


def test_disturbed_runs_are_not_blamed_on_the_reference(desk: Path, printed: Printed) -> None:
    rows = table().split("\n")
    rows[5], rows[9], rows[20] = "0.05,0.9,0.05", "-0.05,0.9,0.06", "0.04,1.1,0.05"
    (desk / "results.csv").write_text("\n".join(rows), encoding="utf-8")
    assert noise(desk, "--json", desk / "f.json") == 0
    said = printed()
    assert "Careful" in said
    assert figures(desk)["missing_reference"] is None
    assert "were some runs disturbed?" in said


def test_what_is_systematic_is_said(desk: Path, printed: Printed) -> None:
    rows = table().strip().split("\n")
    moved = [rows[0]]
    for row in rows[1:]:
        x, y, yaw = (float(cell) for cell in row.split(","))
        moved.append(f"{x + 0.01},{y + 0.2},{yaw - 0.03}")
    (desk / "results.csv").write_text("\n".join(moved), encoding="utf-8")
    assert noise(desk) == 0
    assert "calibrate base and radii first" in printed()


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda text: "\n".join(text.split("\n")[:5]), "results.csv: too few runs: 4 given"),
        (lambda text: text.replace("eyaw_rad", "eyaw_deg"), "eyaw_rad is missing"),
        (lambda text: text + "0.001,0.02,5.7\n", "run 61, column eyaw_rad: 5.7 .*radians"),
        (lambda text: text + "1.6,52,0.009\n", "run 61, column ey_m: 52 .*metres"),
        (lambda text: text + "1.6,,0.009\n", "line 62, column ey_m: '' is not a number"),
        (lambda text: "ex_m,ey_m,eyaw_rad\n" + "0,0,0\n" * 9, "same error"),
    ],
)
def test_bad_tables_are_refused(desk: Path, change: object, says: str) -> None:
    text = change(table())  # type: ignore[operator]
    (desk / "results.csv").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=says):
        noise(desk)
    assert not (desk / "new.yaml").exists()


def test_bad_options_are_refused(desk: Path) -> None:
    with pytest.raises(InputError, match="--distance must be a number above zero"):
        noise(desk, distance=0.0)
    with pytest.raises(InputError, match="--reference-sigma-yaw must be a number from zero"):
        noise(desk, "--reference-sigma-yaw", -1.0)
    with pytest.raises(InputError, match="no more than the reference"):
        noise(desk, "--reference-sigma-xy", 0.5, "--reference-sigma-yaw", 0.5)
