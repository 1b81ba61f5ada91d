# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi calibrate` as a command: help, exit codes, one line where something is wrong."""

from __future__ import annotations

from pathlib import Path

import pytest

from werrimbi_odom.cli.calibrate import KINDS
from werrimbi_odom.cli.main import main


@pytest.mark.parametrize("kind", ["umbmark", "noise"])
def test_help(kind: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["calibrate", kind, "--help"]) == 0
    assert "--robot" in capsys.readouterr().out


def test_the_kinds_are_listed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["calibrate", "--help"]) == 0
    said = capsys.readouterr().out
    assert "umbmark" in said
    assert "noise" in said


@pytest.mark.parametrize(
    "words",
    [
        ["calibrate"],
        ["calibrate", "guess"],
        ["calibrate", "umbmark", "none.csv", "--side", "4", "--robot", "r", "--out", "n"],
        ["calibrate", "umbmark", "none.csv", "--side", "wide", "--robot", "r", "--out", "n"],
        ["calibrate", "noise", "none.csv", "--distance", "10", "--robot", "r", "--out", "n"],
    ],
)
def test_bad_use_is_one_line_and_exit_2(
    words: list[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(words) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "Traceback" not in said


def test_a_package_that_is_not_installed_is_named(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def without_scipy(arguments: object) -> int:
        raise ModuleNotFoundError("No module named 'scipy'", name="scipy")

    monkeypatch.setitem(KINDS, "noise", (*KINDS["noise"][:2], without_scipy))
    words = ["calibrate", "noise", "r.csv", "--distance", "1", "--robot", "r", "--out", "n"]
    assert main(words) == 2
    assert "needs the Python package scipy" in capsys.readouterr().err
