# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Commands as tests give them: to their end, and what they wrote, or the one line of a mistake."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from werrimbi_odom.cli.main import main

RECORDING = Path(__file__).parents[2] / "werrimbi_odom" / "recordings" / "square"
"""The drive that the package ships, and its robot file."""
ROBOT = RECORDING / "robot.yaml"


def refuse(constant: str) -> None:
    raise AssertionError(f"{constant} is no JSON")


def written_by(file: Path, *words: object) -> dict[str, Any]:
    """What a command writes with --json, which must be JSON to any reader."""
    assert main([*map(str, words), "--json", str(file)]) == 0
    found = json.loads(file.read_text(), parse_constant=refuse)
    assert isinstance(found, dict)
    return found


def complaint(capsys: pytest.CaptureFixture[str], *words: object) -> str:
    """The one line that a command says of a mistake, and nothing else."""
    assert main([*map(str, words)]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert len(said.err.splitlines()) == 1
    assert said.err.startswith(f"werrimbi {words[0]}: ")
    return said.err
