# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The package builds and tests with colcon as on a robot, with the ROS of the wheels alone."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from test.command_line import ROOT, ran

WHAT_ROS_SEES = (
    "lib/werrimbi_odom/compare_node",
    "lib/werrimbi_odom/drive_node",
    "lib/werrimbi_odom/odom_node",
    "lib/werrimbi_odom/simulated_robot",
    "lib/werrimbi_odom/werrimbi",
    "share/werrimbi_odom/package.xml",
    "share/werrimbi_odom/config/robot.yaml",
    "share/werrimbi_odom/config/ekf.yaml",
    "share/werrimbi_odom/launch/compare.launch.xml",
    "share/werrimbi_odom/launch/drive.launch.xml",
    "share/werrimbi_odom/launch/odom.launch.xml",
    "share/werrimbi_odom/launch/odom_ekf.launch.xml",
    "share/werrimbi_odom/launch/simulated.launch.xml",
    "share/werrimbi_odom/launch/view.launch.xml",
    "share/werrimbi_odom/rviz/odom.rviz",
    "share/werrimbi_odom/rviz/simulated.rviz",
    "share/ament_index/resource_index/packages/werrimbi_odom",
)

pytestmark = pytest.mark.skipif(
    not (Path(sys.prefix) / "bin" / "colcon").exists(), reason="colcon is not in this environment"
)


def colcon(workspace: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run colcon as a user of this environment would, whatever this test process was given."""
    hidden = ("LD_LIBRARY_PATH", "_ROS_WHEELS_BOOTSTRAP_COMPLETE", "PYTHONPATH")
    environment = {name: value for name, value in os.environ.items() if name not in hidden}
    environment["AMENT_PREFIX_PATH"] = sys.prefix
    environment["PATH"] = f"{sys.prefix}/bin:{environment['PATH']}"
    return subprocess.run(
        [f"{sys.prefix}/bin/colcon", *arguments, "--packages-select", "werrimbi_odom"],
        cwd=workspace,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.fixture(scope="module")
def workspace(tmp_path_factory: pytest.TempPathFactory) -> Path:
    workspace = tmp_path_factory.mktemp("ws")
    source = workspace / "src" / "werrimbi_odom"
    listed = ran(["git", "ls-files", "-co", "--exclude-standard"]).stdout.split("\n")
    for name in filter(None, listed):
        if (ROOT / name).is_file():
            (source / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, source / name)
    built = colcon(workspace, "build")
    assert built.returncode == 0, built.stdout + built.stderr
    return workspace


def test_colcon_build_installs_what_ros2_run_and_launch_look_for(workspace: Path) -> None:
    prefix = workspace / "install" / "werrimbi_odom"
    assert [name for name in WHAT_ROS_SEES if not (prefix / name).exists()] == []
    recording = list(prefix.glob("lib/python*/site-packages/werrimbi_odom/recordings/square/*.csv"))
    assert len(recording) == 2


def test_the_built_executables_start(workspace: Path) -> None:
    prefix = workspace / "install" / "werrimbi_odom"
    (packages,) = prefix.glob("lib/python*/site-packages")
    werrimbi = prefix / "lib" / "werrimbi_odom" / "werrimbi"
    shown = ran([werrimbi, "--help"], PYTHONPATH=str(packages))
    assert shown.returncode == 0, shown.stderr
    assert "odom" in shown.stdout


@pytest.mark.evidence
def test_colcon_test_runs_the_packages_tests(workspace: Path) -> None:
    run = colcon(workspace, "test", "--pytest-args", "test/model/test_moments.py")
    assert run.returncode == 0, run.stdout + run.stderr
    result = (workspace / "build" / "werrimbi_odom" / "pytest.xml").read_text()
    assert 'errors="0" failures="0"' in result
    counts = {name: int(number) for name, number in re.findall(r'(skipped|tests)="(\d+)"', result)}
    assert counts["tests"] - counts["skipped"] == 7, "a module that is left out counts as one"
