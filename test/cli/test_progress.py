# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Long work says how far it is where there is no terminal, too; short work says nothing."""

from __future__ import annotations

import pytest

from test.cli.commands import RECORDING
from werrimbi_odom.cli import progress
from werrimbi_odom.cli.main import main


def test_a_line_now_and_then_on_stderr(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["compare", "--robot", str(RECORDING / "robot.yaml"), str(RECORDING)]
    assert main(words) == 0
    assert capsys.readouterr().err == ""
    monkeypatch.setattr(progress, "EVERY", 1e-4)
    assert main(words) == 0
    lines = capsys.readouterr().err.splitlines()
    assert any(line.startswith("comparing: ") and " %, " in line for line in lines)
