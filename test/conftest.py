# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What all tests share: what they skip for, no test is timed, CI draws the same examples."""

from __future__ import annotations

import fcntl
import gc
import os
import re
import signal
from collections.abc import Callable, Generator
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from hypothesis import settings

from test.command_line import complaint, printed, werrimbi  # noqa: F401 (fixtures of all tests)
from test.recorded_robots import RECORDINGS

# A shell has what it runs in the background ignore Ctrl-C, and so would all that tests interrupt.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

os.environ.setdefault("WERRIMBI_DATA", str(RECORDINGS))  # for the scripts of docs/ that tests run

settings.register_profile("here", deadline=None)
settings.register_profile("ci", deadline=None, derandomize=True)
settings.load_profile("ci" if os.environ.get("CI") else "here")

NO_DEPENDENCY_OF_PACKAGE_XML = {"distributed", "mujoco", "nicegui", "plotly", "rosbags"}
"""What `pip install werrimbi_odom[all]` brings, and rosdep does not: `colcon test` does without."""

DRIVES = ("train/square_ccw", "train/free_brisk", "train/eights_and_spins", "holdout/free_brisk")
"""Those of `werrimbi simulate` that suffice to name what is hidden."""


@pytest.hookimpl(hookwrapper=True)
def pytest_make_collect_report(collector: pytest.Collector) -> Generator[None, Any, None]:
    """Skip a file whose imports want what is not installed here, saying so, instead of ending."""
    report = (yield).get_result()
    absent = re.search(r"ModuleNotFoundError: No module named '(\w+)", str(report.longrepr))
    if report.failed and absent is not None and absent[1] in NO_DEPENDENCY_OF_PACKAGE_XML:
        report.outcome, report.result = "skipped", []
        reason = f"Skipped: needs {absent[1]} (pip install werrimbi_odom[all])"
        report.longrepr = (str(getattr(collector, "path", "")), 0, reason)


LONGEST = (
    *("test_diagnostics", "test_bad_input", "test_compare_node", "test_live_diagnosis"),
    *("test_compare_faults", "test_simulated_robot", "test_demo", "test_compare_legs"),
)
"""Files with nodes that take longest by the clock, the longest first."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """What talks to running nodes comes last: they answer in time where no other test computes.

    Of these files the longest begin first: else all workers but one wait for it at the end.
    """

    def place(path: Path) -> tuple[bool, int]:
        long = LONGEST.index(path.stem) if path.stem in LONGEST else len(LONGEST)
        return "rclpy" in path.read_text("utf-8"), long

    places = {path: place(path) for path in {item.path for item in items}}
    items.sort(key=lambda item: places[item.path])


def pytest_collection_finish() -> None:
    """What was imported stays: no collection of garbage looks through it again."""
    gc.freeze()


@pytest.fixture(autouse=True)
def no_line_by_the_clock(monkeypatch: pytest.MonkeyPatch) -> None:
    """What stderr holds does not depend on how busy the machine is."""
    monkeypatch.setattr("werrimbi_odom.cli.progress.EVERY", float("inf"))


@pytest.fixture
def few_effects(monkeypatch: pytest.MonkeyPatch) -> None:
    """Commands of this process look for a part of the library: for what asks something else."""
    from test.inference.driven import COMMON

    monkeypatch.setattr("werrimbi_odom.effects.lookup.LIBRARY", COMMON)


@pytest.fixture(scope="session")
def simulated(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Path]:
    """Some drives of what `werrimbi simulate` writes, made once for all tests: to be read alone."""
    place = tmp_path_factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        place = place.parent  # which all workers share

    def made(*words: str) -> Path:
        from werrimbi_odom import simulation
        from werrimbi_odom.cli.main import main

        folder = place / "_".join(("simulated", *words)).replace("--", "")
        with open(f"{folder}.lock", "w", encoding="utf-8") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not folder.exists():
                with pytest.MonkeyPatch.context() as patch:
                    patch.setattr(simulation, "session", partial(simulation.session, only=DRIVES))
                    assert main(["simulate", "--out", str(folder), *words]) == 0
        return folder

    return made
