# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`make demo`: recorded ticks through the real node in a process of its own; then the loop."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

import werrimbi_odom as wo
from test.cli.written_runs import PLAIN, ROBOT_FILE, write_run
from test.inference.driven import run_of
from test.recorded_robots import ROBOTS, with_recordings
from werrimbi_odom.demo.second_act import found_in
from werrimbi_odom.effects import find

ROOT = Path(__file__).parents[1]
OPTITRACK = ROBOTS / "optitrack_robot"
DRIVES = sorted(path.name for path in OPTITRACK.glob("*") if path.is_dir())


def demo(out: Path, *arguments: str, seconds: float = 120) -> str:
    """What the demo prints; a process of its own, as `make demo` starts it."""
    run = subprocess.run(
        [sys.executable, "-m", "werrimbi_odom.demo", "--out", str(out), *arguments],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
        timeout=seconds,
    )
    assert run.returncode == 0, run.stdout + run.stderr
    return run.stdout


def test_the_shipped_recording_ends_where_its_covariance_promised(tmp_path: Path) -> None:
    said = demo(tmp_path, "--first-act")
    assert "2895 messages" in said
    assert "4 lines, 2 arcs, 4 spins" in said
    assert "all: 0.000 µm from offline" in said
    assert "the covariance promised just" in " ".join(said.split())
    assert (tmp_path / "path.html").stat().st_size > 1_000_000


def test_the_same_drive_from_its_bag(tmp_path: Path) -> None:
    bag = ROOT / "werrimbi_odom" / "recordings" / "square_bag"
    assert "all: 0.000 µm from offline" in demo(tmp_path, "--run", str(bag))


def test_a_run_that_is_not_there_is_one_clear_line(tmp_path: Path) -> None:
    run = subprocess.run(
        [sys.executable, "-m", "werrimbi_odom.demo", "--run", str(tmp_path / "nowhere")],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 2
    assert len(run.stderr.strip().splitlines()) == 1
    assert "nowhere" in run.stderr


def test_the_second_act_tells_what_the_verbs_find(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The error told is that of the robot file that is written; a picture needs no browser."""
    place = tmp_path / "drives"
    truth = replace(PLAIN, effects=(find("castor_kick").using(angle=-0.02),))
    for seed, name in enumerate(("train", "train", "holdout")):
        (place / name).mkdir(parents=True, exist_ok=True)
        write_run(place / name / f"run_{seed}", run_of(truth, seed, 60))
    (place / "robot.yaml").write_text(ROBOT_FILE)
    hidden = {"effect": "castor_kick", "strength": -0.02, "unit": "rad", "says": "heading gained"}
    (place / "truth.json").write_text(json.dumps({"hidden": [hidden]}))
    monkeypatch.setenv("PATH", "")
    found_in(place, tmp_path)
    said = " ".join(capsys.readouterr().out.split())
    assert "One thing is missing: castor_kick." in said
    assert "hidden castor_kick, -0.02 rad: heading gained" in said
    errors = re.search(r"error ([\d.]+) mm before, ([\d.]+) mm after", said)
    assert errors is not None
    for robot, error in ((place / "robot.yaml", 1), (tmp_path / "better.yaml", 2)):
        again = wo.compare(wo.read_robot(robot), list((place / "holdout").iterdir())).to_dict()
        assert f"{1e3 * again['legs']['rmse_position_m']:.2f}" == errors.group(error)
    assert float(errors.group(2)) < 0.7 * float(errors.group(1))
    assert (tmp_path / "error.png").stat().st_size > 10_000
    assert (tmp_path / "error.html").stat().st_size > 1_000_000


@pytest.mark.evidence
def test_the_whole_demo(tmp_path: Path) -> None:
    said = " ".join(demo(tmp_path, seconds=600).split())
    assert "One thing is missing: castor_kick." in said
    assert "5.37 mm before, 2.40 mm after" in said, "as the README tells the story"


def of_optitrack(tmp_path: Path, name: str) -> None:
    robot, run = OPTITRACK / "robot.yaml", OPTITRACK / name
    said = " ".join(demo(tmp_path, "--robot", str(robot), "--run", str(run)).split())
    assert "all: 0.000 µm from offline" in said
    sigmas = re.search(r"The end lies ([\d.]+) σ from what was measured", said)
    assert sigmas is not None
    # Uncalibrated values: the demo must say so in words where the end is not explained by noise.
    assert ("not calibrated" in said) == (float(sigmas.group(1)) >= 3.4)


@with_recordings
@pytest.mark.parametrize("name", DRIVES[:1])
def test_real_drives_play_through_the_live_node(tmp_path: Path, name: str) -> None:
    of_optitrack(tmp_path, name)


@pytest.mark.evidence
@with_recordings
@pytest.mark.parametrize("name", DRIVES)
def test_every_real_drive_plays_through_the_live_node(tmp_path: Path, name: str) -> None:
    of_optitrack(tmp_path, name)
