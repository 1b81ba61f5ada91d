# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What the page shows while the drives are still being compared."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from test.axe import RUN, axe_script
from test.command_line import WERRIMBI, started
from test.evidence import in_evidence
from test.workbench.conftest import PATIENCE
from test.workbench.session import written


def workers(of: int) -> list[int]:
    """Processes that a process has begun."""
    try:
        words = Path(f"/proc/{of}/task/{of}/children").read_text()
    except FileNotFoundError:
        return []
    return [int(word) for word in words.split()]


def spawned(process: int) -> bool:
    return b"spawn_main" in Path(f"/proc/{process}/cmdline").read_bytes()


@pytest.fixture
def held(tmp_path: Path) -> Iterator[tuple[str, int]]:
    """Address of a workbench, and the process that compares for it, held before it begins."""
    pytest.importorskip("nicegui", reason="the workbench needs NiceGUI")
    robot, train, holdout = written(tmp_path)
    words = ["workbench", "--robot", robot, *train, "--holdout", *holdout]
    process = started([*WERRIMBI, *words], tmp_path)
    try:
        worker = None
        while worker is None:
            assert process.poll() is None
            worker = next((one for one in workers(process.pid) if spawned(one)), None)
            time.sleep(0.001)
        os.kill(worker, signal.SIGSTOP)
        assert process.stdout is not None
        yield process.stdout.readline().split()[0], worker
        process.send_signal(signal.SIGINT)  # Ctrl-C
        assert process.communicate(timeout=60)[1] == "", "nothing went wrong unseen"
    finally:
        process.kill()
        process.communicate()


@pytest.mark.parametrize("scheme", ["light", in_evidence("dark")])
def test_paths_and_progress_are_there_before_anything_is_compared(
    held: tuple[str, int], browser: Any, scheme: str
) -> None:
    address, worker = held
    page = browser.new_page(color_scheme=scheme)
    complaints: list[str] = []
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.goto(address)
    page.locator("svg.measured path").first.wait_for()
    assert page.get_by_role("progressbar").is_visible()
    assert scheme == "dark" if page.locator("body.body--dark").count() else scheme == "light"
    page.evaluate(axe_script())
    for width in (1440, 390):
        page.set_viewport_size({"width": width, "height": 900})
        page.wait_for_timeout(300)
        assert page.evaluate(RUN) == []
        assert page.evaluate("document.documentElement.scrollWidth <= window.innerWidth")
    leaves = browser.new_page()
    leaves.goto(address)
    leaves.get_by_text("Comparing: starting").wait_for()  # so it is connected
    leaves.close()
    os.kill(worker, signal.SIGCONT)
    page.locator('[data-key="go-compare"]').wait_for(timeout=PATIENCE)
    page.locator(".plot .main-svg .js-line").first.wait_for(timeout=PATIENCE)
    assert page.locator("svg.measured").count() == 0
    assert complaints == []
    page.close()
