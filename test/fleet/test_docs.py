# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The commands of docs/fleet.md run as they stand there, on a smaller fleet."""

from __future__ import annotations

import re
import shlex
import socket
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from test.command_line import ROOT, ran, started
from test.fleet.conftest import broken, drive

COMMANDS = [
    shlex.split(line, comments=True)
    for block in re.findall(r"```bash\n(.*?)```", (ROOT / "docs" / "fleet.md").read_text(), re.S)
    for line in block.splitlines()
]
ADDRESS = "192.168.1.10:8786"
MODULES = {"werrimbi": "werrimbi_odom.cli.main", "dask": "dask"}


def python(words: list[str], address: str) -> list[str]:
    """A command of the page, by this interpreter and for a scheduler here, with one worker."""
    words = [word.replace(ADDRESS, address) for word in words]
    if "--nworkers" in words:
        words[words.index("--nworkers") + 1] = "1"
    return [sys.executable, "-m", MODULES[words[0]], *words[1:]]


@contextmanager
def running(words: list[str], place: Path) -> Iterator[None]:
    with (place / f"{words[-1].replace('/', '')}.log").open("w") as log:
        process = started(words, place, stdout=log, stderr=log)
        try:
            yield
        finally:
            process.terminate()
            process.wait(60.0)


@pytest.mark.evidence
def test_the_commands_run(tmp_path: Path) -> None:
    pytest.importorskip("distributed", reason="pip install werrimbi_odom[cluster]")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        address = f"127.0.0.1:{free.getsockname()[1]}"
    host, port = address.split(":")
    shown = {" ".join(words[:2]): words for words in COMMANDS}
    assert shown.keys() == {
        "werrimbi simulate", "werrimbi diagnose", "pip install", "dask scheduler", "dask worker",
    }  # fmt: skip
    broken(tmp_path / "fleet" / "robot_1")
    drive(tmp_path / "fleet" / "robot_2")
    here, there = (words for words in COMMANDS if words[1] == "diagnose")
    scheduler = [*python(shown["dask scheduler"], address), "--host", host, "--port", port]
    with (
        running([*scheduler, "--no-dashboard"], tmp_path),
        running([*python(shown["dask worker"], address), "--no-dashboard"], tmp_path),
    ):
        for number, words in enumerate((here, there)):
            command = [*python(words, address), "--json", tmp_path / f"{number}.json"]
            run = ran(command, tmp_path)
            assert run.returncode == 0, run.stderr
            assert run.stdout.startswith("2 robots: 1 misses nothing, 1 could not be diagnosed.")
    assert (tmp_path / "0.json").read_bytes() == (tmp_path / "1.json").read_bytes()
