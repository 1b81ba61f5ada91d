# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A minute of atheris on each reader finds nothing but InputErrors."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("atheris", reason="needs atheris (pip install atheris)")


@pytest.mark.evidence
@pytest.mark.parametrize("reader", ["robot_file", "ticks", "bag"])
def test_no_input_breaks_a_reader(tmp_path: Path, reader: str) -> None:
    fuzz = Path(__file__).with_name("fuzz.py")
    done = subprocess.run(
        [sys.executable, str(fuzz), reader, "60"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        errors="replace",
        check=False,
    )
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    assert "stat::number_of_executed_units" in done.stderr
