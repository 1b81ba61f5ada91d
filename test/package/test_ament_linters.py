# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""ROS's own linters, as far as PyPI has them, find nothing; nor does what reads package.xml."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

# As in pyproject.toml for ruff: what is not asked of docstrings.
NOT_ASKED = ("D105", "D107", "D401", "D402", "D417")

LINTERS = {
    "ament_flake8": ["--config", "setup.cfg"],
    "ament_pep257": ["--convention", "numpy", "--add-ignore", *NOT_ASKED, "--"],
}


def lint(name: str, *paths: str) -> subprocess.CompletedProcess[str]:
    """Run a linter of ROS on files or folders."""
    command = [sys.executable, "-m", f"{name}.main", *LINTERS[name], *paths]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)


@pytest.fixture(params=LINTERS)
def linter(request: pytest.FixtureRequest) -> str:
    name: str = request.param
    pytest.importorskip(f"{name}.main", reason=f"{name} is not in this environment")
    return name


@pytest.mark.evidence
def test_the_package_is_clean(linter: str) -> None:
    found = lint(linter, "werrimbi_odom", "example", "setup.py")
    assert found.returncode == 0, found.stdout[-3000:] + found.stderr[-1000:]


def test_what_is_wrong_would_be_found(linter: str, tmp_path: Path) -> None:
    wrong = tmp_path / "wrong.py"
    wrong.write_text('"""No full stop"""\nimport os\n', encoding="utf-8")
    assert lint(linter, str(wrong)).returncode != 0


def test_package_xml_is_valid() -> None:
    package_format = pytest.importorskip("catkin_pkg.package")
    package = package_format.parse_package(str(ROOT / "package.xml"))
    package.validate()
    assert package.get_build_type() == "ament_python"
