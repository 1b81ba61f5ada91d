# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`make demo`: recorded ticks through the real node in a process of its own; then the loop."""

from __future__ import annotations

import json
import math
import re
import sys
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("rclpy")

from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Odometry
from rclpy.time import Time

import werrimbi_odom as wo
from test.command_line import ROOT, ran
from test.recorded_robots import ROBOTS, with_recordings
from test.ros.messages import read_by_ros
from werrimbi_odom.demo.node_processes import save_and_tell
from werrimbi_odom.demo.simulated_procedure import drive_of, error_figure
from werrimbi_odom.demo.through_node import ros_arguments
from werrimbi_odom.ros.odom_parameters import settings_of

DEMO = (sys.executable, "-m", "werrimbi_odom.demo")
OPTITRACK = ROBOTS / "optitrack_robot"
DRIVES = sorted(path.name for path in OPTITRACK.glob("*") if path.is_dir())


def demo(out: Path, *arguments: str, seconds: float = 120) -> str:
    """What the demo prints; a process of its own, as `make demo` starts it."""
    run = ran([*DEMO, "--out", out, *arguments], timeout=seconds)
    assert run.returncode == 0, run.stdout + run.stderr
    return run.stdout


def test_the_shipped_recording_ends_where_its_covariance_promised(tmp_path: Path) -> None:
    said = demo(tmp_path, "--first-act")
    assert "2895 messages" in said
    assert "4 lines, 2 arcs, 4 spins" in said
    assert "all: 0.000 µm from offline" in said
    assert "the covariance promised just" in " ".join(said.split())
    assert (tmp_path / "path.html").stat().st_size > 1_000_000


@pytest.mark.parametrize(
    ("key", "where"), [("odom_node", "/"), ("/robot1/base", "/robot1"), ("/**", "/")]
)
def test_the_node_takes_any_robot_file_that_the_commands_take(
    tmp_path: Path, key: str, where: str
) -> None:
    """Below a namespace, and of wheel angles without the resolution of their encoders."""
    file = tmp_path / "robot.yaml"
    own = {"wheel_separation": 0.35, "wheel_radius": 0.05}
    file.write_text(json.dumps({key: {"ros__parameters": own}}), encoding="utf-8")
    read = wo.read_robot(file)
    namespace, given = read_by_ros("odom_node", ros_arguments(read, "/demo"))
    assert namespace == where
    assert settings_of(given).robot == read.robot


@pytest.mark.evidence
def test_the_same_drive_from_its_bag(tmp_path: Path) -> None:
    bag = ROOT / "werrimbi_odom" / "recordings" / "square_bag"
    assert "all: 0.000 µm from offline" in demo(tmp_path, "--run", str(bag))


def test_a_run_that_is_not_there_is_one_clear_line(tmp_path: Path) -> None:
    run = ran([*DEMO, "--run", tmp_path / "nowhere"])
    assert run.returncode == 2
    assert len(run.stderr.strip().splitlines()) == 1
    assert "nowhere" in run.stderr


def test_the_picture_is_of_what_the_messages_say_and_needs_no_browser(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Wheels that are taken for a hundredth too large, on a line, in a reference turned by 90°."""
    odometry, measured = [], []
    for step in range(101):
        x = max(0.0, 0.1 * (step - 20))
        message, seen = Odometry(), PoseStamped()
        message.header.stamp = seen.header.stamp = Time(seconds=0.1 * step).to_msg()
        message.pose.pose.position.x, message.pose.pose.orientation.w = x, 1.0
        message.pose.covariance[0] = message.pose.covariance[7] = (0.01 * x) ** 2
        seen.pose.position.x, seen.pose.position.y = 3.0, 0.99 * x
        seen.pose.orientation.z = seen.pose.orientation.w = math.sqrt(0.5)
        odometry.append(message)
        measured.append(seen)
    drive = drive_of(odometry, measured)
    np.testing.assert_allclose(drive.error, 0.01 * drive.way, atol=1e-9)
    np.testing.assert_allclose(drive.promised[-1], 0.08 * math.sqrt(5.991), rtol=1e-3)
    monkeypatch.setenv("PATH", "")
    save_and_tell(error_figure({"before": drive, "after": drive}), tmp_path / "error")
    assert (tmp_path / "error.png").stat().st_size > 10_000
    assert (tmp_path / "error.html").stat().st_size > 1_000_000


@pytest.mark.evidence
def test_the_whole_demo(tmp_path: Path) -> None:
    """The round over DDS: hidden, no longer honest, named, added, honest again."""
    said = " ".join(demo(tmp_path, seconds=900).split()).rpartition("It drives with")
    first, second = said[0].rpartition("It drives with")[2], said[2]
    assert "the covariance is too small" in first
    assert "One thing is missing: unequal_wheel_radii." in first
    assert "the covariance is honest" in second
    assert "Nothing is missing that these drives could show" in second
    assert "What was hidden: unequal_wheel_radii = 1.01597" in second
    better = wo.read_robot(tmp_path / "better.yaml").robot
    assert better.right_tick / better.left_tick == pytest.approx(1.01597, abs=0.001)
    assert (tmp_path / "error.png").stat().st_size > 10_000


def of_optitrack(tmp_path: Path, name: str) -> None:
    robot, run = OPTITRACK / "robot.yaml", OPTITRACK / name
    said = " ".join(demo(tmp_path, "--robot", str(robot), "--run", str(run)).split())
    assert "all: 0.000 µm from offline" in said
    sigmas = re.search(r"The end lies ([\d.]+) σ from what was measured", said)
    assert sigmas is not None
    # Uncalibrated values: the demo must say so in words where the end is not explained by noise.
    assert ("not calibrated" in said) == (float(sigmas.group(1)) >= 3.4)


@pytest.mark.evidence
@with_recordings
@pytest.mark.parametrize("name", DRIVES)
def test_every_real_drive_plays_through_the_live_node(tmp_path: Path, name: str) -> None:
    of_optitrack(tmp_path, name)
