# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Paths that are no text, and terminals that know few signs: every verb works all the same."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

from test.cli.commands import RECORDING
from test.command_line import ROOT, WERRIMBI


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A fleet of one robot, whose name is no UTF-8, nor are its run's and its file's."""
    folder = tmp_path_factory.mktemp("names") / os.fsdecode(b"robot_\xff")
    for number in (b"\xfe1", b"\xfe2"):
        run = folder / "train" / os.fsdecode(b"run_" + number)
        run.mkdir(parents=True)
        for name in ("ticks.csv", "reference.csv"):
            shutil.copy(RECORDING / name, run / name)
    shutil.copy(RECORDING / "robot.yaml", folder / "robot.yaml")
    return folder


@pytest.mark.parametrize(
    ("verb", "encoding"),
    [
        ("compare", "ascii"),
        ("odom", "utf-8"),
        *(
            pytest.param(verb, encoding, marks=pytest.mark.evidence)
            for verb, encoding in [
                *((verb, "ascii") for verb in ("diagnose", "odom", "calibrate fit", "fleet")),
                ("compare", "utf-8"),
            ]
        ),
    ],
)
def test_names_that_are_no_text_are_spelt(
    place: Path, tmp_path: Path, verb: str, encoding: str
) -> None:
    runs = sorted(map(str, (place / "train").iterdir()))
    words = [*verb.split(), "--robot", str(place / "robot.yaml"), *runs]
    report = tmp_path / os.fsdecode(b"r\xfd.html")
    if verb == "odom":
        words = [*words[:-1], "--out", str(tmp_path / os.fsdecode(b"\xff.csv"))]
    elif verb == "fleet":
        words = ["diagnose", "--fleet", str(place.parent), "--report", str(report), "--jobs", "1"]
    else:
        words += ["--report", str(report), "--json", str(tmp_path / "f.json")]
    if verb == "calibrate fit":
        words += ["--out", str(tmp_path / os.fsdecode(b"\xff.yaml"))]
    done = subprocess.run(
        [*WERRIMBI, *words],
        env={**os.environ, "PYTHONPATH": str(ROOT), "PYTHONIOENCODING": encoding},
        capture_output=True,
    )
    assert (done.returncode, done.stderr) == (0, b""), done.stderr[-600:]
    assert verb == "odom" or "udcff" in report.read_text()
