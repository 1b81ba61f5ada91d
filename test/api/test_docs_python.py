# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""docs/python.md and example/notebook.ipynb run, and the notebook says what it shows."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

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


@pytest.mark.usefixtures("few_effects")
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
