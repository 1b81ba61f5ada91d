# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The site of docs/ is built without a warning, and holds every page and the Python reference."""

from __future__ import annotations

import re
import runpy
import sys
from pathlib import Path

import pytest

import werrimbi_odom as wo
from test.command_line import ROOT, ran


def test_the_python_reference_names_all_that_is_public() -> None:
    page = (ROOT / "docs" / "api.md").read_text(encoding="utf-8")
    named = {line.split("::")[1].strip() for line in page.splitlines() if "::" in line}
    assert set(wo.__all__) - {"EFFECTS"} <= named
    assert "`werrimbi_odom.EFFECTS`" in page
    library = (ROOT / "werrimbi_odom" / "effects" / "library.py").read_text(encoding="utf-8")
    laws = re.findall(r"^from werrimbi_odom\.effects\.(\w+) import", library, re.M)
    assert laws
    assert {f"werrimbi_odom.effects.{name}" for name in laws} <= named


@pytest.mark.parametrize("above", [True, False], ids=["make docs", "rosdoc2"])
def test_the_site_knows_the_package_wherever_its_settings_are_copied_to(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, above: bool
) -> None:
    """rosdoc2 runs a copy of docs/, in a folder of its own: without the package no reference."""
    (tmp_path / "conf.py").write_bytes((ROOT / "docs" / "conf.py").read_bytes())
    place = ROOT / "docs" if above else tmp_path
    monkeypatch.setenv("PWD", str(ROOT.parent))
    monkeypatch.setattr(sys, "argv", ["rosdoc2", "build", "--package-path", ROOT.name])
    monkeypatch.setattr(sys, "path", [part for part in sys.path if Path(part) != ROOT])
    assert runpy.run_path(str(place / "conf.py"))["ROOT"] == ROOT
    assert sys.path[0] == str(ROOT)
    if not above:
        monkeypatch.setattr(sys, "argv", ["sphinx-build"])
        with pytest.raises(FileNotFoundError, match="--package-path"):
            runpy.run_path(str(place / "conf.py"))


@pytest.mark.evidence
def test_the_site_is_built_without_a_warning(tmp_path: Path) -> None:
    pytest.importorskip("myst_parser", reason="needs werrimbi_odom[docs]")
    pytest.importorskip("sphinx_rtd_theme", reason="needs werrimbi_odom[docs]")
    sphinx = [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-q", "-b", "html"]
    run = ran([*sphinx, "-d", tmp_path / "trees", "docs", tmp_path / "site"])
    assert run.returncode == 0, run.stdout + run.stderr
    for page in (ROOT / "docs").glob("*.md"):
        assert (tmp_path / "site" / f"{page.stem}.html").exists(), page
    reference = (tmp_path / "site" / "api.html").read_text(encoding="utf-8")
    for name in set(wo.__all__) - {"EFFECTS"}:
        assert f'id="werrimbi_odom.{name}"' in reference, name
