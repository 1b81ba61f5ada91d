# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""example/notebook.ipynb runs, and says what it shows.

After a change: `.venv/bin/jupyter execute --inplace example/notebook.ipynb`.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

from test.command_line import ROOT

NOTEBOOK = ROOT / "example" / "notebook.ipynb"
NUMBER = re.compile(r"\d+(?:\.\d+)?")


def texts(notebook: Any) -> list[str]:
    """The text that each code cell shows."""
    return [
        "".join(
            output.get("text") or output.get("data", {}).get("text/plain", "")
            for output in cell.outputs
        )
        for cell in notebook.cells
        if cell.cell_type == "code"
    ]


def test_the_notebook_runs_and_what_it_shows_is_true(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    nbformat = pytest.importorskip("nbformat")
    nbclient = pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    pytest.importorskip("mujoco")
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setenv("PYTHONPATH", str(ROOT), prepend=":")
    kept = nbformat.read(NOTEBOOK, as_version=4)
    run = nbformat.read(NOTEBOOK, as_version=4)
    nbclient.NotebookClient(run, timeout=300, kernel_name="python3").execute()
    assert len(run.cells) < 25
    for shown, now in zip(texts(kept), texts(run), strict=True):
        # The figures of a first line, and of what is short, are the story; tables have many more.
        told, here = (
            text if text.count("\n") < 4 else text.split("\n")[0] for text in (shown, now)
        )
        assert NUMBER.sub("#", told) == NUMBER.sub("#", here)
        for before, after in zip(NUMBER.findall(told), NUMBER.findall(here), strict=True):
            assert float(after) == pytest.approx(float(before), rel=0.1, abs=2e-3)
    (figure,) = (
        output
        for cell in run.cells
        for output in cell.get("outputs", ())
        if "application/vnd.plotly.v1+json" in output.get("data", {})
    )
    assert figure["data"]["application/vnd.plotly.v1+json"]["data"]


def test_the_error_of_the_kept_notebook_falls_by_half() -> None:
    nbformat = pytest.importorskip("nbformat")
    (line,) = (
        line
        for text in texts(nbformat.read(NOTEBOOK, as_version=4))
        for line in text.splitlines()
        if line.startswith("held-out drives:")
    )
    before, after = (float(number) for number in NUMBER.findall(line))
    assert after < 0.5 * before
