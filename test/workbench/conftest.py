# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The workbench as a process of its own, and a real browser that looks at it."""

from __future__ import annotations

import json
import signal
import subprocess
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from test.command_line import WERRIMBI, started
from test.workbench.session import written
from werrimbi_odom.report.save import find_browser

PATIENCE = 240_000
"""For work that takes seconds, on a machine that has other things to do [ms]."""


@dataclass(frozen=True)
class Served:
    address: str
    folder: Path
    process: subprocess.Popen[str]


@pytest.fixture(scope="session")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    pytest.importorskip(
        "nicegui", reason="the workbench needs NiceGUI: pip install 'nicegui>=3.18'"
    )
    folder = tmp_path_factory.mktemp("day")
    robot, train, holdout = written(folder)
    told = tmp_path_factory.mktemp("told") / "address.json"
    words = ["workbench", "--robot", robot, *train, "--holdout", *holdout, "--json", told]
    process = started([*WERRIMBI, *words], folder)
    try:
        while not told.exists():
            if process.poll() is not None:
                raise AssertionError(process.communicate()[1])
            time.sleep(0.1)
        yield Served(json.loads(told.read_text())["address"], folder, process)
        process.send_signal(signal.SIGINT)  # Ctrl-C
        said, complaints = process.communicate(timeout=60)
        assert complaints == "", "nothing went wrong unseen, and it ends in silence"
        assert said.startswith("http://127.0.0.1:")
    finally:
        process.kill()
        process.communicate()


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    driver = pytest.importorskip(
        "playwright.sync_api", reason="playwright drives the browser: pip install playwright"
    )
    found = find_browser()
    if found is None:
        pytest.skip("no Chromium to look with: apt-get install chromium")
    with driver.sync_playwright() as playwright:
        running = playwright.chromium.launch(executable_path=found, args=["--no-sandbox"])
        yield running
        running.close()


class Looked:
    """A browser of its own at the page; every word on the console and every request is kept."""

    def __init__(self, browser: Any, address: str, **options: Any) -> None:
        self.context = browser.new_context(viewport={"width": 1440, "height": 900}, **options)
        self.context.set_default_timeout(30_000)
        self.page = self.context.new_page()
        self.complaints: list[str] = []
        self.asked: list[str] = []
        self.page.on("console", self._keep)
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.on("request", lambda request: self.asked.append(request.url))
        self.page.goto(address)
        self.page.wait_for_selector('[data-key="go-compare"]')

    def _keep(self, message: Any) -> None:
        if message.type in ("error", "warning") and "GL Driver" not in message.text:
            self.complaints.append(message.text)

    def at(self, key: str) -> Any:
        return self.page.locator(f'[data-key="{key}"]')

    @property
    def error(self) -> float:
        """The held-out error that stands on the page [mm]."""
        value, unit = self.at("error").inner_text().split()
        return float(value) * {"mm": 1.0, "m": 1e3}[unit]

    def focused(self, key: str) -> None:
        """Wait until the element has the focus."""
        self.page.wait_for_function("key => document.activeElement?.dataset?.key === key", arg=key)

    def close(self) -> None:
        self.context.close()


@pytest.fixture
def looked(served: Served, browser: Any) -> Iterator[Looked]:
    found = Looked(browser, served.address)
    yield found
    found.close()


@pytest.fixture
def another(served: Served, browser: Any) -> Iterator[Looked]:
    found = Looked(browser, served.address, color_scheme="dark")
    yield found
    found.close()
