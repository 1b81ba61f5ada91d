# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the pictures of docs/workbench.md anew, from a robot simulated on the spot."""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from werrimbi_odom.cli.main import main as werrimbi
from werrimbi_odom.report.save import find_browser

PICTURES = Path(__file__).parent / "pictures"
TRAIN = ("arcs", "free_brisk", "square_ccw", "eights_and_spins")
HOLDOUT = ("free_calm", "slalom")
SIZE = {"width": 1440, "height": 900}
PHONE = {"width": 390, "height": 1500}
LONG = 300_000  # for the diagnosis [ms]


def main() -> None:
    """Simulate, serve, look."""
    browser = find_browser()
    if browser is None:
        sys.exit("no Chrome or Chromium found; e.g. apt install chromium")
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        hidden = ["--hide", "eccentric_left_wheel=0.002", "--seed", "7"]
        if werrimbi(["simulate", "--out", str(folder), *hidden]) != 0:
            sys.exit("simulate failed")
        told = folder / "address.json"
        process = subprocess.Popen(
            [sys.executable, "-m", "werrimbi_odom.cli.main", "workbench",
             "--robot", "robot.yaml", *(f"train/{name}" for name in TRAIN),
             "--holdout", *(f"holdout/{name}" for name in HOLDOUT), "--json", str(told)],
            cwd=folder, stdout=subprocess.PIPE, text=True,
        )  # fmt: skip
        try:
            opening(browser, process)
            while not told.exists():
                if process.poll() is not None:
                    sys.exit("the workbench did not start")
                time.sleep(0.1)
            look(browser, json.loads(told.read_text())["address"])
        finally:
            process.kill()
            process.wait()


def opening(browser: str, process: subprocess.Popen[str]) -> None:
    """The page while the drives are compared: who compares is held meanwhile."""
    from playwright.sync_api import sync_playwright

    assert process.stdout is not None
    held = ["pkill", "-STOP", "-P", str(process.pid), "-f", "spawn_main"]
    while subprocess.run(held, check=False).returncode != 0:
        if process.poll() is not None:
            sys.exit("the workbench did not start")
        time.sleep(0.01)
    address = process.stdout.readline().split()[0]
    with sync_playwright() as playwright:
        running = playwright.chromium.launch(executable_path=browser, args=["--no-sandbox"])
        page = running.new_page(viewport=SIZE, color_scheme="light")
        page.goto(address)
        page.wait_for_selector("svg.measured")
        taken(page, "opening")
        running.close()
    subprocess.run(["pkill", "-CONT", "-P", str(process.pid)], check=True)


def look(browser: str, address: str) -> None:
    """Go through the loop, with a picture of every step."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        running = playwright.chromium.launch(executable_path=browser, args=["--no-sandbox"])
        page = running.new_page(viewport=SIZE, color_scheme="light")
        page.set_default_timeout(LONG)
        page.goto(address)
        page.wait_for_selector('[data-key="go-compare"]')
        page.wait_for_selector(".plot .main-svg")
        taken(page, "compare")
        page.click('[data-key="motion-arc"]')
        page.wait_for_selector('[data-key="motion-arc"][aria-pressed="true"]')
        taken(page, "part")
        page.click('[data-key="go-diagnose"]')
        page.click('[data-key="diagnose"]')
        page.wait_for_selector('progress:not([value^="0.0"])')
        taken(page, "progress")
        page.wait_for_selector('[data-key="verdict"]')
        taken(page, "diagnose")
        page.locator(".map .level3").first.click()
        page.wait_for_selector('.cell[aria-pressed="true"]')
        page.locator('[data-key="map"]').evaluate(
            "map => window.scrollTo(0, map.getBoundingClientRect().top + scrollY - 110)"
        )
        taken(page, "evidence")
        page.click('[data-key="add-eccentric_left_wheel"]')
        page.wait_for_selector('[data-key="undo"]:enabled')
        taken(page, "add")
        page.click('[data-key="theme"]')
        page.wait_for_selector("body.body--dark")
        taken(page, "dark")
        page.click('[data-key="theme"]')
        page.wait_for_selector("body:not(.body--dark)")
        page.click('[data-key="go-save"]')
        page.click('[data-key="save"]')
        page.wait_for_selector(".saved")
        taken(page, "save")
        page.set_viewport_size(PHONE)
        page.click('[data-key="go-compare"]')
        page.wait_for_selector(".plot .main-svg")
        taken(page, "phone")
        running.close()


def taken(page: Any, name: str) -> None:
    """A picture of what is seen, once the figures stand still."""
    page.wait_for_timeout(1500)
    path = PICTURES / f"workbench_{name}.png"
    page.screenshot(path=path)
    print(path)


if __name__ == "__main__":
    main()
