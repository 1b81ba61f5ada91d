# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi compare` on the command line: words, tables, JSON, and one line for a mistake."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import werrimbi_odom as wo
from test.cli.commands import PLAIN, RECORDING, ROBOT, ROBOT_FILE, write_run, written_by
from test.command_line import WERRIMBI, Complaint, ran
from test.inference.driven import run_of
from test.recorded_robots import ROBOTS, with_recordings
from werrimbi_odom.cli.main import main

OPTIONS = {
    "optitrack_robot": ("--leg", "0.5"),
    "khepera_laser_to_the_side": ("--leg", "0.1", "--reference-kind", "incremental"),
    "khepera_laser_moved": ("--leg", "0.1", "--reference-kind", "incremental"),
    "labyrinth": (),
}
LEGS = {
    "count",
    "outliers",
    "rmse_position_m",
    "median_position_m",
    "rmse_all_position_m",
    "rmse_yaw_rad",
    "nees",
    "coverage_95",
}


def compared(tmp_path: Path, *words: object) -> dict[str, Any]:
    return written_by(tmp_path / "figures.json", "compare", *words)


@pytest.mark.parametrize("verb", ["compare", "diagnose", "calibrate fit"])
@pytest.mark.parametrize(("unit", "size"), [("millimetres", 1000.0), ("inches", 39.3701)])
def test_a_reference_in_another_unit_is_refused_alike(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], verb: str, unit: str, size: float
) -> None:
    """`compare` said that the robot goes 940 times as far, and `calibrate fit` wrote a file."""
    run = run_of(PLAIN, 1, 60)
    seen = run.reference
    assert seen is not None
    write_run(
        tmp_path / "run", replace(run, reference=replace(seen, x=size * seen.x, y=size * seen.y))
    )
    file, new = tmp_path / "robot.yaml", tmp_path / "new.yaml"
    file.write_text(ROBOT_FILE)
    out = ["--out", str(new)] if "fit" in verb else []
    assert main([*verb.split(), "--robot", str(file), *out, str(tmp_path / "run")]) == 2
    words = f"the reference's positions are in {unit}, and x_m and y_m mean metres: convert these"
    assert words in capsys.readouterr().err
    assert not new.exists()


def wrong_base(tmp_path: Path) -> Path:
    path = tmp_path / "wrong.yaml"
    text = ROBOT.read_text().replace("wheel_separation: 0.35 ", "wheel_separation: 0.36 ")
    assert text != ROBOT.read_text()
    path.write_text(text)
    return path


def test_without_a_leg_the_page_shows_the_paths(tmp_path: Path) -> None:
    """A robot whose wheels did not turn: it was carried."""
    page, time = tmp_path / "page.html", 0.05 * np.arange(600)
    left = np.cumsum(np.round(100.0 + 40.0 * np.sin(time)))
    right = np.cumsum(np.round(100.0 - 40.0 * np.cos(1.4 * time)))
    path = wo.odometry(wo.read_robot(ROBOT), time, left, right)
    poses = np.column_stack((time, path.x, path.y, path.yaw))[::5]
    poses[:, 1:] += np.random.default_rng(1).normal(0.0, 0.002, (120, 3))
    run = wo.write_run(tmp_path / "run", time, 0.0 * time, 0.0 * time, poses)
    found = compared(tmp_path, "--robot", ROBOT, run, "--report", page)
    assert found["legs"]["count"] == 0
    assert "Where the model fails" in (told := page.read_text())
    assert "Errors by type of motion" not in told


def test_the_shipped_drive_is_explained_and_the_json_is_the_contracts(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    found = compared(tmp_path, "--robot", ROBOT, RECORDING)
    assert found["legs"].keys() >= LEGS
    assert set(found["by_motion"]) == {"line", "arc", "spin"}
    for figures in found["by_motion"].values():
        assert figures.keys() >= LEGS
    (run,) = found["runs"]
    assert run["run"] == str(RECORDING)
    assert run.keys() >= {"distance_m", "duration_s", "end_error_m", "end_error_rad", "legs"}
    assert run["legs"]["count"] == found["legs"]["count"]
    by_motion = sum(figures["count"] for figures in found["by_motion"].values())
    assert by_motion == found["legs"]["count"]
    assert found["each_leg"]["error_along_m"][0] == pytest.approx(0.0, abs=0.05)
    said = capsys.readouterr()
    assert said.err == ""
    assert max(map(len, said.out.splitlines()[:-1])) <= 80
    assert "Smaller effects may hide in such errors: `werrimbi diagnose` looks" in said.out


def test_end_errors_are_those_of_werrimbi_odom(tmp_path: Path) -> None:
    recording = tmp_path / "square"
    recording.mkdir()
    (recording / "ticks.csv").write_text((RECORDING / "ticks.csv").read_text())
    # Both begin at the first pose; let that be one that is not before the first ticks.
    head, _, *poses = (RECORDING / "reference.csv").read_text().splitlines()
    (recording / "reference.csv").write_text("\n".join([head, *poses]) + "\n")
    found = compared(tmp_path, "--robot", ROBOT, recording)
    out, figures = tmp_path / "odom.csv", tmp_path / "odom.json"
    words = ["odom", "--robot", ROBOT, recording, "--out", out, "--json", figures]
    assert main([str(word) for word in words]) == 0
    theirs = json.loads(figures.read_text())
    (run,) = found["runs"]
    assert run["end_error_m"] == pytest.approx(theirs["end_error_m"], abs=1e-3)
    assert run["end_error_rad"] == pytest.approx(theirs["end_error_rad"], abs=1e-3)
    assert run["distance_m"] == pytest.approx(theirs["distance_m"], rel=1e-3)


def test_a_wrong_base_makes_it_worse_and_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    right = compared(tmp_path, "--robot", ROBOT, RECORDING, "--leg", "0.25")
    capsys.readouterr()
    page = tmp_path / "page.html"
    wrong = compared(
        tmp_path, "--robot", wrong_base(tmp_path), RECORDING, "--leg", "0.25", "--report", page
    )
    assert wrong["by_motion"]["spin"]["nees"] > 3.0 * right["by_motion"]["spin"]["nees"]
    said = capsys.readouterr().out
    told = " ".join(said.split())
    (share,) = re.findall(r"Curves: the robot turns ([\d.]+) ± [\d.]+ % more than", told)
    assert float(share) == pytest.approx(100.0 * (0.36 / 0.35 - 1.0), abs=0.3)
    assert "Spins (4 legs only): errors of a leg" in told
    assert "werrimbi diagnose --robot" in said
    assert page.stat().st_size > 1_000_000


@with_recordings
@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=[pytest.mark.evidence] * (name == "optitrack_robot"))
        for name in OPTIONS
    ],
)
def test_every_recorded_robot(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = ROBOTS / name
    runs = sorted(path.parent for path in folder.glob("*/ticks.csv"))
    found = compared(tmp_path, "--robot", folder / "robot.yaml", *runs, *OPTIONS[name])
    assert len(found["runs"]) == len(runs)
    assert found["legs"]["count"] > 10
    assert found["legs"]["nees"] > 3.0  # each of these robot files is wrong
    assert "explains these drives" not in capsys.readouterr().out


def test_mistakes_are_told_in_one_line(tmp_path: Path, complaint: Complaint) -> None:
    robot = ("--robot", ROBOT)
    told = complaint("compare", *robot, RECORDING, "--leg", "0")
    assert "--leg" in told
    assert "greater than zero" in told
    assert "given twice" in complaint("compare", *robot, RECORDING, f"{RECORDING}/.")
    assert "there is no such run" in complaint("compare", *robot, tmp_path / "nowhere")


def test_a_folder_of_runs_names_them(tmp_path: Path, complaint: Complaint) -> None:
    for name in ("first", "second"):
        (tmp_path / "runs" / name).mkdir(parents=True)
        for file in ("ticks.csv", "reference.csv"):
            (tmp_path / "runs" / name / file).write_text((RECORDING / file).read_text())
    told = complaint("compare", "--robot", ROBOT, tmp_path / "runs")
    assert "is no run but a folder of 2 (first, second)" in told


def test_in_a_process_of_its_own_without_a_terminal() -> None:
    done = ran([*WERRIMBI, "compare", "--robot", ROBOT, RECORDING])
    assert done.returncode == 0
    assert done.stderr == ""
    assert "Errors of legs of 1 m (rms)" in done.stdout


def test_who_stops_reading_has_the_files_all_the_same(tmp_path: Path) -> None:
    """As of `werrimbi compare ... --json F | head -1`."""
    figures = tmp_path / "compare.json"
    words = ["compare", "--robot", str(ROBOT), str(RECORDING), "--json", str(figures)]
    quiet = {"stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL}
    with subprocess.Popen([*WERRIMBI, *words], **quiet) as process:
        assert process.stdout is not None
        process.stdout.close()
        process.wait(120)
    assert json.loads(figures.read_text())["legs"]["count"] > 0


@pytest.mark.parametrize(
    ("option", "name", "said"),
    [
        ("--report", "page.txt", "ends in .html, .pdf or .png"),
        ("--report", "page.pdf", "a report that ends in .html needs none"),
    ],
)
def test_what_could_not_be_written_is_said_before_the_work(
    tmp_path: Path,
    complaint: Complaint,
    monkeypatch: pytest.MonkeyPatch,
    option: str,
    name: str,
    said: str,
) -> None:
    monkeypatch.setenv("PATH", "")  # no browser
    not_there = tmp_path / "a_drive_that_would_be_read_next"
    words = ("--robot", wrong_base(tmp_path), not_there, option, tmp_path / name)
    assert said in complaint("compare", *words)


def test_held_poses_are_left_out_and_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The shipped drive, by a tracker that says its old pose for a second now and then."""
    figures = []
    for name in ("held", "left_out"):
        run = tmp_path / name
        shutil.copytree(RECORDING, run)
        head, *rows = (run / "reference.csv").read_text().splitlines()
        for begin in range(40, len(rows) - 30, 60):
            pose = rows[begin].split(",", 1)[1]
            for row in range(begin + 1, begin + 20):
                rows[row] = f"{rows[row].split(',')[0]},{pose}" if name == "held" else ""
        (run / "reference.csv").write_text("\n".join([head, *filter(None, rows)]) + "\n")
        figures.append(compared(tmp_path, "--robot", ROBOT, run))
        said = capsys.readouterr().err
        assert said.startswith(f"warning: {run}: ") == (name == "held")
        assert said.count("\n") == (name == "held")
    held, left_out = (found["legs"] for found in figures)
    assert held["count"] == left_out["count"]
    assert held["rmse_position_m"] == pytest.approx(left_out["rmse_position_m"], rel=0.02)
