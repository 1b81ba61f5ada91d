# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""With what package.xml asks for and nothing else, every test file is collected or skipped."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from test.command_line import ROOT

POOR = """
import sys
from importlib.abc import MetaPathFinder

ABSENT = {absent!r}


class Absent(MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        first = name.partition(".")[0]
        if first in ABSENT:
            raise ModuleNotFoundError(f"No module named {{first!r}}", name=first)


sys.meta_path.insert(0, Absent())
"""
NOT_BY_ROSDEP = {
    *("ament_flake8", "ament_pep257", "atheris", "axe_playwright_python", "catkin_pkg", "dask"),
    *("distributed", "filterpy", "flake8", "kaleido", "mpmath", "mujoco", "nicegui", "playwright"),
    *("ipykernel", "nbclient", "nbformat", "plotly", "pydocstyle", "pyproj", "rosbags"),
    *("sphinx", "threadpoolctl", "xdist"),
}


@pytest.mark.evidence
def test_colcon_test_collects_without_what_rosdep_does_not_bring(tmp_path: Path) -> None:
    (tmp_path / "poor.py").write_text(POOR.format(absent=NOT_BY_ROSDEP))
    run = subprocess.run(
        [sys.executable, "-m", "pytest", "-p", "poor", "--collect-only", "-rs", "test"],
        cwd=ROOT,
        env={
            **os.environ,
            "PYTHONPATH": os.pathsep.join([str(tmp_path), os.environ.get("PYTHONPATH", "")]),
            "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1",
        },
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 0, run.stdout[-3000:] + run.stderr[-3000:]
    assert "test_any_sequence" in run.stdout
    assert "needs mujoco (pip install werrimbi_odom[all])" in run.stdout
