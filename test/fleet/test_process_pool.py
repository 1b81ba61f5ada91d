# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Processes that die, bugs of ours, and Ctrl-C: what is known is told all the same."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import time
from pathlib import Path

import pytest

from test.command_line import WERRIMBI, started
from test.fleet.conftest import broken
from werrimbi_odom.cli.main import INTERRUPTED
from werrimbi_odom.files.recordings import Asked, DriveOptions
from werrimbi_odom.fleet import process_pool, robot_task
from werrimbi_odom.fleet.robot_task import Task, failed, row_of

KILLS = "import os, signal\nos.kill(os.getpid(), signal.SIGKILL)\n"
SLOW = """
import os, time
from pathlib import Path
from werrimbi_odom.effects.library import LIBRARY
from dataclasses import replace

mine = replace(LIBRARY[0], name="mine")
place = Path(__file__).parent
times = len(list(place.glob("read_*")))
(place / f"read_{times}").write_text(str(os.getpid()))
if times == 2:  # the command itself has read it, and the first robot
    time.sleep(600.0)
"""


def nowhere(name: str, how: DriveOptions | None = None) -> Task:
    """A robot of which nothing is there."""
    return Task(
        name, Asked(Path(name) / "robot.yaml", (Path(name) / "run",), (), how or DriveOptions())
    )


def test_who_kills_its_process_is_a_row_and_the_others_are_done(tmp_path: Path) -> None:
    (tmp_path / "kills.py").write_text(KILLS)
    tasks = [nowhere(f"robot_{number}") for number in range(3)]
    tasks.insert(1, nowhere("killer", DriveOptions(effects=(tmp_path / "kills.py",))))
    rows = {row.robot: row.error for row in process_pool.spread(tasks, 2, row_of, failed)}
    assert rows.keys() == {"robot_0", "robot_1", "robot_2", "killer"}
    assert rows.pop("killer") == process_pool.DIED
    assert all("robot.yaml" in error and "died" not in error for error in rows.values())


def test_a_bug_of_ours_is_a_row_that_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    def falls(*anything: object) -> None:
        raise KeyError("left\nwheel")

    monkeypatch.setattr(robot_task, "read", falls)
    row = row_of(nowhere("robot_1"))
    assert row.error.startswith("this is a bug of werrimbi_odom, not of your files")
    assert "KeyError: 'left\\nwheel' (test_process_pool.py, line " in row.error
    assert row.verdict == "error"


def test_memory_that_is_too_small_is_no_bug(monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*anything: object) -> None:
        raise MemoryError

    monkeypatch.setattr(robot_task, "read", full)
    assert "more memory than there is" in row_of(nowhere("robot_1")).error


def begun(tmp_path: Path) -> subprocess.Popen[str]:
    """A fleet of two whose second robot takes ten minutes; waits until that is under way."""
    for name in ("robot_1", "robot_2"):
        broken(tmp_path / "fleet" / name)
    (tmp_path / "slow.py").write_text(SLOW)
    words = ["--fleet", "fleet", "--jobs", "1", "--effects", "slow.py", "--json", "figures.json"]
    process = started([*WERRIMBI, "diagnose", *words], tmp_path, start_new_session=True)
    patience = time.monotonic() + 120.0
    while not (tmp_path / "read_2").exists() or not (tmp_path / "read_2").read_text():
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < patience
        time.sleep(0.05)
    return process


def gone(pid: int) -> bool:
    """Whether a process ends within some seconds."""
    for _ in range(200):
        try:
            os.kill(pid, 0)
        except ProcessLookupError:
            return True
        time.sleep(0.05)
    return False


def test_after_ctrl_c_it_is_told_what_was_done_and_what_is_left(tmp_path: Path) -> None:
    process = begun(tmp_path)
    os.killpg(process.pid, signal.SIGINT)  # as a terminal does: to all of its processes
    out, err = process.communicate(timeout=60.0)
    assert (process.returncode, err) == (INTERRUPTED, "")
    assert out.startswith("1 robot: 1 could not be diagnosed.")
    assert "Not done: 1 of 2 are left, robot_2." in out
    figures = json.loads((tmp_path / "figures.json").read_text())
    assert [row["robot"] for row in figures["robots"]] == ["robot_1"]
    assert figures["left"] == ["robot_2"]
    assert gone(int((tmp_path / "read_2").read_text()))


def test_no_process_outlives_the_command_that_began_it(tmp_path: Path) -> None:
    process = begun(tmp_path)
    process.kill()
    process.communicate(timeout=60.0)
    assert gone(int((tmp_path / "read_2").read_text()))
