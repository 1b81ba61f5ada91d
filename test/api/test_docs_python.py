# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The blocks of docs/python.md run, one after the other."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from werrimbi_odom.cli.main import main

PAGE = Path(__file__).parents[2] / "docs" / "python.md"


def test_the_blocks_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["simulate", "--out", "drives", "--hide", "castor_kick", "--seed", "6"]) == 0
    blocks = re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    assert len(blocks) == 3
    names: dict[str, object] = {}
    for block in blocks:
        exec(compile(block, str(PAGE), "exec"), names)
    assert (tmp_path / "better.yaml").exists()
    assert (tmp_path / "diagnosis.html").stat().st_size > 10_000
    assert names["names"] == ("castor_kick",)
