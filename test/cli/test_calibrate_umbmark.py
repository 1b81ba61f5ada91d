# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi calibrate umbmark` from tables and from recorded runs, in files and out of files."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from test.cli.commands import called
from test.command_line import Printed
from test.recorded_robots import ROBOTS, with_recordings
from werrimbi_odom.api import calibrate_umbmark as from_squares
from werrimbi_odom.cli import calibrate
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.inference.calibration.squares import Squares
from werrimbi_odom.report.document import Paragraph
from werrimbi_odom.simulation import TrueRobot, record, square, write_run

ROBOT = """\
# my robot
odom_node:
  ros__parameters:
    wheel_separation: 0.35  # ruler
    wheel_radius: 0.05
    wheel_separation_multiplier: 1.01
    left_ticks_per_revolution: 2000.0
    right_ticks_per_revolution: 2000.0
"""
BEFORE = """\
sense,x_m,y_m
cw,0.030,0.034
cw,0.034,0.028
ccw,0.092,-0.090
ccw,0.102,-0.098
"""
AFTER = """\
sense,x_m,y_m
cw,0.013,0.013
cw,0.017,0.009
ccw,-0.028,0.014
ccw,-0.024,0.018
"""
DATA = ROBOTS / "optitrack_robot"


@pytest.fixture
def desk(tmp_path: Path) -> Path:
    """A folder with a robot file and two tables."""
    (tmp_path / "robot.yaml").write_text(ROBOT, encoding="utf-8")
    (tmp_path / "before.csv").write_text(BEFORE, encoding="utf-8")
    (tmp_path / "after.csv").write_text(AFTER, encoding="utf-8")
    return tmp_path


def umbmark_files(desk: Path) -> tuple[object, ...]:
    return "--robot", desk / "robot.yaml", "--out", desk / "new.yaml", "--side", 4.0


def umbmark(desk: Path, *words: object, table: str = "before.csv") -> int:
    return called(calibrate, "umbmark", desk / table, *umbmark_files(desk), *words)


def test_a_table_to_a_robot_file(desk: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert umbmark(desk, "--json", desk / "f.json", "--report", desk / "f.html") == 0
    figures = json.loads((desk / "f.json").read_text(encoding="utf-8"))
    assert figures["e_max_syst_m"]["before"] == pytest.approx(0.1351, abs=5e-5)
    assert figures["e_max_syst_m"]["after"] is None
    assert figures["centre_of_gravity"]["cw"] == pytest.approx([0.032, 0.031])
    assert figures["centre_of_gravity"]["ccw"] == pytest.approx([0.097, -0.094])
    new, text = read_robot_file(desk / "new.yaml"), (desk / "new.yaml").read_text(encoding="utf-8")
    for name, estimate in figures["parameters"].items():
        assert new.values[name] == pytest.approx(estimate["value"], abs=1e-9)
        assert 0.0 < estimate["std"] < 0.01
    assert new.values["wheel_separation_multiplier"] == pytest.approx(1.01 * 0.99495, abs=2e-5)
    assert "# my robot" in text
    assert "# ruler" in text
    assert "plotly" in (desk / "f.html").read_text(encoding="utf-8")
    said = capsys.readouterr().out
    for words in ("135.1 mm", "CLAPPER", "5 squares in each sense are usual", "--after"):
        assert words in said


def said_of(rows: str, desk: Path, printed: Printed) -> str:
    """What is printed of a table of squares."""
    (desk / "squares.csv").write_text(f"sense,x_m,y_m\n{rows}", encoding="utf-8")
    assert umbmark(desk, table="squares.csv") == 0
    return printed()


def test_squares_that_do_not_scatter_are_told_without_a_spread(
    desk: Path, printed: Printed
) -> None:
    rows = "cw,0.032,0.031\n" * 2 + "ccw,0.097,-0.094\n" * 2
    assert "closer together than the robot file says" in said_of(rows, desk, printed)


def test_a_second_table_says_what_was_gained(
    desk: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert umbmark(desk, "--after", desk / "after.csv", "--json", desk / "f.json") == 0
    figures = json.loads((desk / "f.json").read_text(encoding="utf-8"))
    assert figures["e_max_syst_m"]["after"] == pytest.approx(0.0305, abs=5e-5)
    assert figures["centre_of_gravity_after"]["ccw"] == pytest.approx([-0.026, 0.016])
    said = capsys.readouterr().out
    assert "after the calibration: 30.5 mm, before: 135.1 mm (4.4 times smaller)" in said
    assert "this robot, after, 4 m" in said


def test_a_calibration_that_did_not_help_is_called_so(
    desk: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert umbmark(desk, "--after", desk / "before.csv", table="after.csv") == 0
    assert "no better than before" in capsys.readouterr().out


def test_exchanged_senses_of_few_squares_are_no_proof_that_all_was_right(
    desk: Path, printed: Printed
) -> None:
    """They are too few to be refused, but 134 mm beside 4 mm of scatter are no scatter."""
    rows = "ccw,0.032,0.031\nccw,0.036,0.029\ncw,0.097,-0.094\ncw,0.091,-0.098\n"
    said = said_of(rows, desk, printed)
    assert "do not explain where these squares ended: E_max,syst is 134.4 mm" in said
    assert "were right" not in said


def test_exchanged_senses_of_two_squares_that_scatter_are_not_put_down_to_scatter(
    desk: Path, printed: Printed
) -> None:
    """290 mm beside 30 mm of scatter: no test of two squares a sense can prove it."""
    rows = "ccw,-0.22,-0.18\nccw,-0.19,-0.23\ncw,-0.10,0.13\ncw,-0.14,0.11\n"
    said = said_of(rows, desk, printed)
    assert "do not explain where these squares ended" in said
    assert "no more than the scatter" not in said
    assert "Or so few squares scatter more" in said


def test_corrections_within_their_error_bars_are_not_determined(
    desk: Path, printed: Printed
) -> None:
    """Half a metre of scatter: what is worked out is chance, and no proof that all was right."""
    rows = "cw,0.30,-0.42\ncw,-0.51,0.33\nccw,0.20,0.45\nccw,-0.40,-0.31\n"
    said = said_of(rows, desk, printed)
    assert "These squares determine no correction" in said
    assert "They tell the base to 2.5 % and the ratio of the radii to 0.36 %" in said
    assert "were right" not in said


def test_squares_that_end_where_they_should_are_told_as_that(desk: Path, printed: Printed) -> None:
    rows = "cw,0,0\n" * 2 + "ccw,0,0\n" * 2
    (desk / "nothing.csv").write_text(f"sense,x_m,y_m\n{rows}", encoding="utf-8")
    assert umbmark(desk, "--after", desk / "nothing.csv") == 0
    assert "after the calibration: 0.0 mm, before: 135.1 mm." in printed()


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "is empty; its first line must be sense,x_m,y_m"),
        ("sense,x,y_m\ncw,1,2\n", "line 1: the header must hold sense,x_m,y_m; x_m is missing"),
        (
            BEFORE.replace("0.102", "0,102"),
            "line 5: 4 cells where the header has 3; .* decimals by points",
        ),
        (BEFORE.replace("0.102", "wide"), "line 5, column x_m: 'wide' is not a number"),
        (BEFORE.replace("0.102", "nan"), "line 5, column x_m: 'nan' is no measurement"),
        (BEFORE.replace("ccw,0.1", "left,0.1"), "line 5, column sense: 'left' must be cw or ccw"),
        (BEFORE.replace("ccw", "cw"), r"before.csv: too few squares: .* 2 more ccw \(0 given\)"),
        (BEFORE.replace("0.102", "102"), "ccw square number 2: .* metres"),
        ("sense,x_m,x_m,y_m\ncw,1,1,1\n", "the column x_m is there twice"),
        ('sense,x_m,y_m\ncw,"1,2\n', "line 2"),
    ],
)
def test_a_bad_table_is_refused_with_its_place(desk: Path, text: str, says: str) -> None:
    (desk / "before.csv").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=says):
        umbmark(desk)
    assert not (desk / "new.yaml").exists()


def test_all_that_is_wrong_in_a_table_is_told_at_once(desk: Path) -> None:
    (desk / "before.csv").write_text("sense,x_m,y_m\nup,a,1\nccw,1\ncw,nan,2\n")
    with pytest.raises(InputError) as refused:
        umbmark(desk)
    assert str(refused.value).endswith(
        "line 2, column sense: 'up' must be cw or ccw; line 2, column x_m: 'a' is not a number "
        "such as -0.094; line 3: 2 cells where the header has 3; separate by commas, and decimals "
        "by points; line 4, column x_m: 'nan' is no measurement; leave the whole row out"
    )


def test_comments_spaces_case_and_more_columns_are_fine(desk: Path) -> None:
    text = "\ufeff# floor 2\n" + BEFORE.replace("cw,", "CW, ").replace("\n", ",note\n") + "\n"
    (desk / "before.csv").write_text(text.replace("cCW", "CCW"), encoding="utf-8")
    assert umbmark(desk) == 0


def test_files_that_cannot_be_read_or_written(desk: Path) -> None:
    with pytest.raises(InputError, match="no such file"):
        umbmark(desk, table="none.csv")
    (desk / "before.csv").write_bytes(BEFORE.encode() + b"cw,\xff,1\n")
    with pytest.raises(InputError, match="line 6: byte 0xff is not UTF-8"):
        umbmark(desk)
    (desk / "before.csv").write_text(BEFORE, encoding="utf-8")
    (desk / "new.yaml").write_text("mine", encoding="utf-8")
    with pytest.raises(InputError, match="--force"):
        umbmark(desk)
    assert (desk / "new.yaml").read_text(encoding="utf-8") == "mine"
    assert umbmark(desk, "--force") == 0
    with pytest.raises(InputError, match="cannot be written"):
        umbmark(desk, "--force", "--json", desk / "no" / "f.json")


def test_tables_and_runs_are_not_mixed(desk: Path) -> None:
    with pytest.raises(InputError, match="not both and not several"):
        called(calibrate, "umbmark", desk / "before.csv", desk, *umbmark_files(desk))


def test_recorded_runs_before_and_after(desk: Path) -> None:
    (desk / "robot.yaml").write_text(
        ROBOT.replace("wheel_separation_multiplier: 1.01", "encoder_bits: 0"), encoding="utf-8"
    )
    true = TrueRobot(wheel_separation=0.357)
    runs = []
    for seed, sense in enumerate(("cw", "ccw", "cw", "ccw")):
        drive = record(true, square(1.0, sense), seed=seed)
        runs.append(write_run(drive, desk / "runs" / f"{sense}_{seed}"))
    arguments = [*runs, "--side", 1.0, "--robot", desk / "robot.yaml", "--out", desk / "new.yaml"]
    assert (
        called(calibrate, "umbmark", *arguments, "--after", *runs, "--json", desk / "f.json") == 0
    )
    figures = json.loads((desk / "f.json").read_text(encoding="utf-8"))
    found = figures["parameters"]["wheel_separation_multiplier"]
    assert abs(found["value"] - 1.02) < 1.96 * found["std"] < 0.005
    size = figures["e_max_syst_m"]
    assert size["after"] < size["before"] / 20
    # The same runs given as --after are the same offsets as the arithmetic of the correction gives.
    assert size["after"] == pytest.approx(size["same_runs_corrected"], abs=1e-4)
    (runs[0] / "reference.csv").unlink()
    with pytest.raises(InputError, match="there is no reference"):
        called(calibrate, "umbmark", *arguments, "--force")


def test_the_verdict_comes_before_what_the_drives_were_read_from(
    desk: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is the headline of the page, and what a notebook shows."""

    def read(paths: list[Path], source: object, robot: object, how: Any) -> Squares:
        how.notes.append("bag: ticks from /joint_states")
        x, y = np.array([0.030, 0.034]), np.array([0.034, 0.028])
        return Squares(4.0, np.stack([x, y], axis=1), np.stack([3.0 * x, -3.0 * y], axis=1))

    monkeypatch.setattr(from_squares, "_recorded", read)
    robot = read_robot_file(desk / "robot.yaml")
    parts = from_squares.calibrate_umbmark(robot, desk / "bag", 4.0).document().words
    texts = [part.text for part in parts if isinstance(part, Paragraph)]
    assert "off: E_max,syst is" in texts[0]
    assert texts[-1] == "bag: ticks from /joint_states"


@with_recordings
def test_a_real_robots_squares(tmp_path: Path, printed: Printed) -> None:
    runs = sorted(DATA.glob("square_*"))
    words = ["--side", 1.7, "--robot", DATA / "robot.yaml", "--out", tmp_path / "new.yaml"]
    assert called(calibrate, "umbmark", *runs, *words, "--report", tmp_path / "f.html") == 0
    new = read_robot_file(tmp_path / "new.yaml").robot
    assert new.wheel_separation_multiplier == pytest.approx(1.0085, abs=3e-4)
    said = printed()
    assert "Base and radii are off: E_max,syst is 104.4 mm on squares of 1.7 m." in said
    assert "clockwise 3 -15.3 -16.9" in said
    assert "anticlockwise 3 -67.1 79.9" in said
    ccw = [run for run in runs if run.name[-1] in "456"]
    with pytest.raises(InputError, match="2 more cw"):
        called(calibrate, "umbmark", *ccw, *words, "--force")
    with pytest.raises(InputError, match="not a square of side 2 m"):
        called(calibrate, "umbmark", *runs, *words, "--force", "--side", 2.0)
