# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The Python API says what the command line says, to the last digit, and shows itself."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import werrimbi_odom as wo
from werrimbi_odom.cli.main import main

EFFECT = "castor_kick"


@pytest.fixture(scope="module")
def drives(simulated: Callable[..., Path]) -> Path:
    """Drives of a robot whose castor kicks, made by the physics engine."""
    return simulated("--hide", "random", "--seed", "6")


def runs(drives: Path) -> list[Path]:
    return sorted((drives / "train").iterdir())[:4]


def by_command(drives: Path, out: Path, *words: str) -> dict[str, Any]:
    """What `--json` says."""
    assert main([*words, "--json", str(out)]) == 0
    found = json.loads(out.read_text(encoding="utf-8"))
    assert isinstance(found, dict)
    return found


def plain(figures: dict[str, Any]) -> dict[str, Any]:
    """As JSON has it."""
    found = json.loads(json.dumps(figures))
    assert isinstance(found, dict)
    return found


def test_importing_it_imports_nothing_heavy() -> None:
    code = (
        "import sys, werrimbi_odom as wo; print(sorted(set(sys.modules) & "
        "{'numpy', 'scipy', 'plotly', 'rclpy', 'mujoco', 'rosbags'})); print(len(dir(wo)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    heavy, names = done.stdout.splitlines()
    assert heavy == "[]"
    assert int(names) == len(wo.__all__)


def test_every_name_is_there() -> None:
    for name in wo.__all__:
        assert getattr(wo, name) is not None
    with pytest.raises(AttributeError, match="no attribute 'odometrie'"):
        wo.odometrie  # noqa: B018


def test_odometry_of_lists_has_a_covariance(drives: Path) -> None:
    robot = wo.read_robot(drives / "robot.yaml")
    found = wo.odometry(robot, [0.0, 0.1, 0.2], [0, 100, 200], [0, 100, 200])
    assert found.covariance.shape == (3, 3, 3)
    assert found.x[-1] > 0.0
    assert np.linalg.eigvalsh(found.covariance[-1]).min() >= -1e-15
    with pytest.raises(ValueError, match="as long as each other"):
        wo.odometry(robot, [0.0, 0.1], [0], [0])


def test_odometry_is_that_of_the_command(drives: Path, tmp_path: Path) -> None:
    path = runs(drives)[0]
    out = tmp_path / "odom.csv"
    assert main(["odom", "--robot", str(drives / "robot.yaml"), str(path), "--out", str(out)]) == 0
    table = np.genfromtxt(out, delimiter=",", names=True)
    robot = wo.read_robot(drives / "robot.yaml")
    run = wo.read_run(path, robot)
    start = (table["x_m"][0], table["y_m"][0], table["yaw_rad"][0])
    ticks = run.ticks
    found = wo.odometry(robot, ticks.time, ticks.left, ticks.right, start=start)
    np.testing.assert_array_equal(found.x, table["x_m"])
    np.testing.assert_array_equal(found.covariance[:, 0, 0], table["xx"])


def test_verbs_say_what_the_commands_say(drives: Path, tmp_path: Path) -> None:
    file, paths = drives / "robot.yaml", runs(drives)
    given = ["--robot", str(file), *map(str, paths[:3]), "--holdout", str(paths[3])]
    robot = wo.read_robot(file)
    fitted, held = [wo.read_run(path, robot) for path in paths[:3]], paths[3]
    compared = wo.compare(robot, fitted)
    words = by_command(drives, tmp_path / "c.json", "compare", *given[:5])
    assert plain(compared.to_dict()) == words
    diagnosed = wo.diagnose(robot, fitted, holdout=held)
    assert plain(diagnosed.to_dict()) == by_command(drives, tmp_path / "d.json", "diagnose", *given)
    out = tmp_path / "new.yaml"
    added = wo.add(EFFECT, robot, fitted, holdout=held, force=True)
    words = by_command(
        drives, tmp_path / "a.json", "add", EFFECT, *given, "--out", str(out), "--force"
    )
    assert plain(added.to_dict()) == words
    by_python = tmp_path / "python.yaml"
    added.write_robot(by_python)
    assert by_python.read_text(encoding="utf-8") == out.read_text(encoding="utf-8")
    out = tmp_path / "fit.yaml"
    fit = wo.calibrate_fit(robot, fitted, holdout=held)
    words = by_command(drives, tmp_path / "f.json", "calibrate", "fit", *given, "--out", str(out))
    assert plain(fit.to_dict()) == words


def test_a_result_shows_itself(drives: Path, tmp_path: Path) -> None:
    robot = wo.read_robot(drives / "robot.yaml")
    found = wo.compare(robot, runs(drives)[:2])
    assert len(repr(found)) < 200
    assert "\n" not in repr(found)
    assert repr(found)[1:-1].partition(": ")[2] in found.summary()
    assert "iframe" in found._repr_html_()
    assert {"motion", "nees"} <= set(found.figures())
    (page,) = found.write_report(tmp_path / "compare.html")
    assert page.stat().st_size > 10_000
    with pytest.raises(wo.InputError, match="changes no robot file"):
        found.write_robot(tmp_path / "none.yaml")


def test_what_is_given_in_the_wrong_order_is_told(drives: Path) -> None:
    robot = wo.read_robot(drives / "robot.yaml")
    with pytest.raises(TypeError, match="the robot comes first"):
        wo.compare(runs(drives), robot)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="unknown option legs; there are reference_kind, leg"):
        wo.compare(robot, runs(drives), legs=2.0)  # type: ignore[call-arg]
