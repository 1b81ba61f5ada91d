# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A user's own package of effects: installed, named in a robot file, run by the real node."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("rclpy")

from test.model.drives import Ticks, random_drive
from werrimbi_odom.effects import load_file
from werrimbi_odom.effects.contract import check_effect
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.trajectory import trajectory

ROOT = Path(__file__).parents[2]
EXAMPLE = ROOT / "example" / "my_robot"
HOLDING = {"effects": ["tread_lies_down"], "tread_lies_down": {"loss": 0.1}}


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The example as setuptools installs it: its modules, and what its setup.py says of it."""
    folder = tmp_path_factory.mktemp("own")
    source, target = folder / "my_robot", folder / "site"
    shutil.copytree(EXAMPLE, source)
    target.mkdir()
    words = ["egg_info", "--egg-base", str(target), "build_py", "--build-lib", str(target)]
    subprocess.run(
        [sys.executable, "setup.py", "-q", *words], cwd=source, check=True, capture_output=True
    )
    return target


@pytest.fixture
def installed(site: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Child processes find the package, as they do after `pip install`."""
    path = os.pathsep.join([str(site), os.environ.get("PYTHONPATH", "")])
    monkeypatch.setenv("PYTHONPATH", path.rstrip(os.pathsep))


def werrimbi(*words: object) -> subprocess.CompletedProcess[str]:
    path = os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])
    return subprocess.run(
        [sys.executable, "-m", "werrimbi_odom.cli.main", *map(str, words)],
        env=os.environ | {"PYTHONPATH": path, "COLUMNS": "200"},
        capture_output=True,
        text=True,
        check=False,
    )


def drive() -> Ticks:
    ticks = random_drive(6, Robot(0.35, 0.05, 2000.0, 1000.0), rate=20.0, duration=15.0)
    return Ticks(np.round(ticks.time + 100.0, 6), ticks.left, ticks.right)


@pytest.mark.usefixtures("installed")
def test_the_node_runs_it_by_its_name(launch: Any, robot: dict[str, Any]) -> None:
    node = launch(robot | HOLDING)
    node.begin()
    (effect,) = load_file(EXAMPLE / "my_robot_effects.py")
    ticks = drive()
    node.reset()
    node.odometry.clear()
    time, left, right = [node.now], [node.left], [node.right]
    for stamp, a, b in zip(*(column.tolist() for column in ticks), strict=True):
        node.now = stamp + 10.0
        node.ticks(a, b, node.now)
        time, left, right = [*time, node.now], [*left, a], [*right, b]
    last = node.last().pose.pose.position
    counts = np.array(time), np.array(left), np.array(right)
    with_it, plain = (
        trajectory(Robot(0.35, 0.05, 2000.0, 1000.0, effects=effects), *counts)
        for effects in ((effect.using(loss=0.1),), ())
    )
    assert last.x == pytest.approx(with_it.x[-1], abs=1e-9)
    assert last.y == pytest.approx(with_it.y[-1], abs=1e-9)
    assert np.hypot(last.x - plain.x[-1], last.y - plain.y[-1]) > 1e-3
    assert node.report()[2]["effect tread_lies_down"] == "loss 0.1"


@pytest.mark.usefixtures("installed")
def test_the_node_says_that_it_has_no_gauge(run_node: Any, robot: dict[str, Any]) -> None:
    done = run_node(robot | {"effects": ["radii_follow_pressure"]})
    assert done.returncode == 2
    assert "looks at the measured channel tyre_pressure_kpa, which the node does" in done.stderr


@pytest.mark.usefixtures("installed")
def test_the_command_line_knows_both(tmp_path: Path) -> None:
    told = werrimbi("explain", "radii_follow_pressure")
    assert told.returncode == 0, told.stderr
    assert "stretch with their pressure" in told.stdout
    text = (EXAMPLE / "robot.yaml").read_text()
    both = "    effects: [tread_lies_down, radii_follow_pressure]\n"
    text = text.replace(next(line for line in text.splitlines(True) if "effects:" in line), both)
    file = tmp_path / "robot.yaml"
    file.write_text(text + "    radii_follow_pressure: {stretch: 0.001}\n")
    (tmp_path / "run").mkdir()
    rows = "".join(f"{0.1 * n!r},{-100 * n},{-100 * n},190.0\n" for n in range(11))
    header = "t_s,left_ticks,right_ticks,tyre_pressure_kpa\n"
    (tmp_path / "run" / "ticks.csv").write_text(header + rows)
    words = ["odom", "--robot", file, tmp_path / "run", "--out", tmp_path / "odom.csv"]
    done = werrimbi(*words)
    assert done.returncode == 0, done.stderr
    travel = 1000 * 2.0 * np.pi * 0.05 / 2000.0
    x = float((tmp_path / "odom.csv").read_text().splitlines()[-1].split(",")[1])
    assert x == pytest.approx(-travel * (1.0 - 0.03) * 1.01, rel=1e-9)


def test_without_it_a_robot_file_that_names_it_says_what_is_unknown(tmp_path: Path) -> None:
    (tmp_path / "run").mkdir()
    (tmp_path / "run" / "ticks.csv").write_text("t_s,left_ticks,right_ticks\n0,0,0\n1,1,1\n")
    words = ["odom", "--robot", EXAMPLE / "robot.yaml", tmp_path / "run", "--out", tmp_path / "o"]
    done = werrimbi(*words)
    assert done.returncode == 2
    assert "robot.yaml, line 8: unknown effect tread_lies_down" in done.stderr


def test_what_the_docs_show_is_the_file_and_both_effects_keep_the_laws() -> None:
    page = (ROOT / "docs" / "effects.md").read_text(encoding="utf-8")
    whole = (EXAMPLE / "my_robot_effects.py").read_text(encoding="utf-8")
    assert f"```python\n{whole}```" in page
    for name in ("my_robot_effects.py", "my_robot_pressure.py"):
        (effect,) = load_file(EXAMPLE / name)
        check_effect(effect)
