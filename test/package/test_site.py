# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The site of docs/ is built without a warning, and holds every page and the Python reference."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

import werrimbi_odom as wo

ROOT = Path(__file__).parents[2]


def test_the_python_reference_names_all_that_is_public() -> None:
    page = (ROOT / "docs" / "api.md").read_text(encoding="utf-8")
    named = {line.split("::")[1].strip() for line in page.splitlines() if "::" in line}
    assert set(wo.__all__) - {"EFFECTS"} <= named
    assert "`werrimbi_odom.EFFECTS`" in page
    library = (ROOT / "werrimbi_odom" / "effects" / "library.py").read_text(encoding="utf-8")
    laws = re.findall(r"^from werrimbi_odom\.effects\.(\w+) import", library, re.M)
    assert laws
    assert {f"werrimbi_odom.effects.{name}" for name in laws} <= named


@pytest.mark.evidence
def test_the_site_is_built_without_a_warning(tmp_path: Path) -> None:
    pytest.importorskip("myst_parser", reason="needs werrimbi_odom[docs]")
    pytest.importorskip("sphinx_rtd_theme", reason="needs werrimbi_odom[docs]")
    sphinx = [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-q", "-b", "html"]
    run = subprocess.run(
        [*sphinx, "-d", str(tmp_path / "trees"), "docs", str(tmp_path / "site")],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 0, run.stdout + run.stderr
    for page in (ROOT / "docs").glob("*.md"):
        assert (tmp_path / "site" / f"{page.stem}.html").exists(), page
    reference = (tmp_path / "site" / "api.html").read_text(encoding="utf-8")
    for name in set(wo.__all__) - {"EFFECTS"}:
        assert f'id="werrimbi_odom.{name}"' in reference, name
