# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The command on a cluster whose scheduler is killed in mid-task: one line, no trace of Dask's."""

from __future__ import annotations

import re
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path

import pytest

from test.command_line import started

pytest.importorskip("distributed", reason="pip install werrimbi_odom[cluster]")

SLEEPS = """
import sys, time
from pathlib import Path
from dataclasses import replace
from werrimbi_odom.effects.library import LIBRARY

mine = replace(LIBRARY[0], name="mine")
if "distributed" in sys.modules:  # in the worker; the command itself has not begun with Dask
    Path({begun!r}).touch()
    time.sleep(600.0)
"""


def begun(words: Sequence[str], folder: Path, name: str) -> subprocess.Popen[str]:
    with (folder / name).open("w") as told:
        command = [sys.executable, "-m", *words]
        return started(command, folder, stdout=subprocess.DEVNULL, stderr=told)


def waited(folder: Path, name: str, wanted: str) -> str:
    limit = time.monotonic() + 120.0
    while time.monotonic() < limit:
        text = (folder / name).read_text() if (folder / name).exists() else ""
        if re.search(wanted, text):
            return text
        time.sleep(0.1)
    raise AssertionError(f"{name} never said {wanted}")


@pytest.mark.evidence
def test_a_scheduler_that_is_killed_is_one_line(home: Path, tmp_path: Path) -> None:
    effects, sleeping = tmp_path / "sleeps.py", tmp_path / "begun"
    effects.write_text(SLEEPS.format(begun=str(sleeping)))
    scheduler = ["distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0"]
    running = [begun([*scheduler, "--no-dashboard"], tmp_path, "scheduler")]
    try:
        told = waited(tmp_path, "scheduler", r"tcp://127\.0\.0\.1:\d+")
        address = re.findall(r"tcp://127\.0\.0\.1:\d+", told)[0]
        worker = ["distributed.cli.dask_worker", address, "--nthreads", "1", "--no-nanny"]
        running.append(begun([*worker, "--no-dashboard"], tmp_path, "worker"))
        words = ["werrimbi_odom.cli.main", "diagnose", "--fleet", str(home / "fleet")]
        words += ["--scheduler", address, "--effects", str(effects)]
        running.append(begun(words, tmp_path, "command"))
        limit = time.monotonic() + 120.0
        while not sleeping.exists():
            assert running[2].poll() is None, (tmp_path / "command").read_text()
            assert time.monotonic() < limit
            time.sleep(0.1)
        running[0].kill()
        assert running[2].wait(120.0) == 2
    finally:
        for process in running:
            process.kill()
            process.wait(60.0)
    said = (tmp_path / "command").read_text()
    assert said.count("\n") == 1, said
    assert "the connection to it is lost" in said
