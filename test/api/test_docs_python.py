# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The blocks of docs/python.md run, one after the other."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from test.command_line import ROOT, ran

PAGE = ROOT / "docs" / "python.md"


def test_the_five_lines_run_in_a_shell() -> None:
    """Odometry with its covariance from arrays."""
    (shown,) = re.findall(r"```bash\n(python -c '.*?')\n```", PAGE.read_text(), re.DOTALL)
    assert len(shown.splitlines()) == 7, "five lines of Python between the two of the shell"
    command = shown.replace("python", sys.executable, 1)
    run = ran(["sh", "-c", command])
    assert run.returncode == 0, run.stderr
    lines = run.stdout.splitlines()
    assert len(lines) == 4
    sigmas = [float(line.strip("[] ").split()[row]) for row, line in enumerate(lines[1:])]
    assert min(sigmas) > 0.0, "variances on the diagonal"


def test_the_blocks_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, simulated: Callable[..., Path]
) -> None:
    monkeypatch.chdir(tmp_path)
    day = simulated("--hide", "random", "--seed", "6")
    Path("drives").symlink_to(day)
    blocks = re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    assert len(blocks) == 4
    names: dict[str, object] = {}
    for block in blocks:
        exec(compile(block, str(PAGE), "exec"), names)
    assert (tmp_path / "better.yaml").exists()
    assert (tmp_path / "diagnosis.html").stat().st_size > 10_000
    assert names["names"] == ("castor_kick",)
