# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`make demo`: recorded ticks through the real node in a process of its own."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from test.recorded_robots import ROBOTS, with_recordings

ROOT = Path(__file__).parents[1]
OPTITRACK = ROBOTS / "optitrack_robot"
DRIVES = sorted(path.name for path in OPTITRACK.glob("*") if path.is_dir())


def demo(out: Path, *arguments: str) -> str:
    """What the demo prints; a process of its own, as `make demo` starts it."""
    run = subprocess.run(
        [sys.executable, "-m", "werrimbi_odom.demo", "--out", str(out), *arguments],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )
    assert run.returncode == 0, run.stdout + run.stderr
    return run.stdout


def test_the_shipped_recording_ends_where_its_covariance_promised(tmp_path: Path) -> None:
    said = demo(tmp_path)
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
