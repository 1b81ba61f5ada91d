# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The blocks of docs/python.md run, one after the other."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest

PAGE = Path(__file__).parents[2] / "docs" / "python.md"


def test_the_blocks_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, simulated: Callable[..., Path]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("drives").symlink_to(simulated("--hide", "random", "--seed", "6"))
    blocks = re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    assert len(blocks) == 3
    names: dict[str, object] = {}
    for block in blocks:
        exec(compile(block, str(PAGE), "exec"), names)
    assert (tmp_path / "better.yaml").exists()
    assert (tmp_path / "diagnosis.html").stat().st_size > 10_000
    assert names["names"] == ("castor_kick",)
