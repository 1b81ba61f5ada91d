# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The whole loop in a real browser: by clicks, by keys, two at once, cancelled, refused."""

from __future__ import annotations

import http.client
import re
import time
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import pytest

from test.command_line import WERRIMBI, ran
from test.evidence import in_evidence
from test.workbench.conftest import PATIENCE, Looked, Served
from test.workbench.session import HIDDEN, RATIO, ROBOT
from werrimbi_odom.files.robot_files.robot_file import read_robot_file

GIVEN_UP = 10.0
"""From when on a tab that was closed is taken for closed (`workbench.server`) [s]."""


def files(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


def tab_to(looked: Looked, key: str) -> None:
    """With the Tab key alone; who works with keys must see where he is."""
    page = looked.page
    for _ in range(80):
        if page.evaluate("document.activeElement?.dataset?.key") == key:
            break
        page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement?.dataset?.key") == key
    outline = page.evaluate("getComputedStyle(document.activeElement).outlineStyle")
    assert outline == "solid"


CANCELS = """() => new MutationObserver((_, seen) => {
    const button = document.querySelector("[data-key=cancel]")
    if (button) { seen.disconnect(); button.click() }
}).observe(document, { childList: true, subtree: true })"""
"""Presses a button when it comes: a diagnosis may be done before another browser's click is."""


def press(looked: Looked, key: str, how: str) -> None:
    """A button, once it is there and can be pressed."""
    looked.at(key).and_(looked.page.locator(":enabled")).wait_for(timeout=PATIENCE)
    if how == "clicks":
        looked.at(key).click()
        return
    tab_to(looked, key)
    looked.page.keyboard.press("Enter")


@pytest.mark.parametrize(
    ("how", "file"),
    [
        ("clicks", "robot_new.yaml"),
        in_evidence("keys", "robot_new_2.yaml"),
    ],
)
def test_the_hidden_effect_is_found_added_and_saved(
    looked: Looked, another: Looked, served: Served, how: str, file: str
) -> None:
    """By clicks alone, and by keys alone, while a second browser does something else."""
    before = looked.error
    press(looked, "motion-line", how)
    looked.page.locator('[data-key="told"]', has_text="Straight driving:").wait_for()
    assert looked.at("motion-line").get_attribute("aria-pressed") == "true"
    press(looked, "to-diagnose", how)
    press(looked, "diagnose", how)
    looked.at("cancel").wait_for()

    press(another, "go-diagnose", "clicks")
    another.page.evaluate(CANCELS)
    press(another, "diagnose", "clicks")
    another.page.get_by_role("status").filter(has_text="was cancelled").wait_for()

    looked.at("verdict").wait_for(timeout=PATIENCE)
    assert HIDDEN in looked.at("verdict").inner_text()
    looked.page.get_by_text("how to check it on the robot").wait_for()
    looked.page.get_by_text(f"{HIDDEN}: its error before and after").wait_for()
    press(looked, f"add-{HIDDEN}", how)
    looked.at("undo").and_(looked.page.locator(":enabled")).wait_for(timeout=PATIENCE)
    after = looked.error
    assert after < 0.8 * before
    assert "fell" in looked.page.locator("main .headline").inner_text()

    press(looked, "undo", how)
    looked.at("undo").and_(looked.page.locator(":disabled")).wait_for()
    assert looked.error == before
    press(looked, "redo", how)
    looked.at("redo").and_(looked.page.locator(":disabled")).wait_for()
    assert looked.error == after

    press(looked, "go-save", how)
    press(looked, "save", how)
    looked.page.get_by_text("✓ Saved").wait_for()
    saved = read_robot_file(served.folder / file).robot
    found = saved.right_wheel_radius_multiplier / saved.left_wheel_radius_multiplier
    assert found == pytest.approx(RATIO, abs=5e-4)
    assert (served.folder / "robot.yaml").read_text() == ROBOT
    new = {name for name in files(served.folder) if name.startswith("robot_new")}
    assert files(served.folder) - new == {"robot.yaml", "train", "holdout"}
    assert looked.complaints == []
    hosts = {urlsplit(url).hostname for url in looked.asked if url.startswith("http")}
    assert hosts == {"127.0.0.1"}

    looked.page.reload()
    looked.page.wait_for_function("document.querySelector('[data-key=undo]')?.disabled === false")
    assert looked.error == after, "a reloaded page goes on where it was"

    assert another.error == before
    assert another.at("undo").is_disabled()
    assert another.at("verdict").count() == 0
    assert another.complaints == []


def test_the_focus_is_never_lost_when_the_page_changes(looked: Looked) -> None:
    page = looked.page

    tab_to(looked, "motion-arc")
    page.keyboard.press("Enter")
    page.locator('[data-key="motion-arc"][aria-pressed="true"]').wait_for()
    looked.focused("motion-arc")
    tab_to(looked, "variable-1")
    page.keyboard.press("Space")
    page.locator('[data-key="variable-1"][aria-pressed="true"]').wait_for()
    looked.focused("variable-1")
    page.keyboard.press("Shift+Tab")
    looked.focused("variable-0")
    page.evaluate("document.activeElement.blur(); window.scrollTo(0, 0)")
    page.locator("h1").click()
    tab_to(looked, "go-diagnose")
    page.keyboard.press("Enter")
    looked.focused("title-diagnose")
    tab_to(looked, "diagnose")
    page.keyboard.press("Enter")
    looked.focused("cancel")
    assert page.get_by_role("progressbar").count() == 1
    page.keyboard.press("Enter")
    page.get_by_role("status").filter(has_text="was cancelled").wait_for()
    looked.focused("title-diagnose")
    assert looked.at("diagnose").is_enabled()
    assert looked.complaints == []


def test_everything_that_can_be_pressed_has_a_name(looked: Looked) -> None:
    for view in ("compare", "diagnose", "add", "save"):
        looked.at(f"go-{view}").click()
        looked.at(f"title-{view}").wait_for()
        nameless = looked.page.evaluate(
            """() => [...document.querySelectorAll('button, a, summary, input, [tabindex="0"]')]
            .filter(item => item.offsetParent !== null)
            .filter(item => !(item.getAttribute('aria-label') || item.textContent).trim())
            .map(item => item.outerHTML)"""
        )
        assert nameless == []
        levels = looked.page.locator("h1, h2, h3").evaluate_all("all => all.map(x => x.tagName)")
        assert levels[:2] == ["H1", "H2"]
    figures = looked.page.locator("[role=img]:not([aria-label])")
    assert figures.count() == 0


def test_the_page_follows_the_systems_dark_theme_and_can_be_turned(another: Looked) -> None:
    def brightness() -> int:
        colour = another.page.evaluate("getComputedStyle(document.body).backgroundColor")
        return sum(int(part) for part in re.findall(r"\d+", colour)[:3])

    another.page.locator("body.body--dark").wait_for()
    assert brightness() < 150
    another.at("theme").click()
    another.page.locator("body:not(.body--dark)").wait_for()
    assert brightness() == 3 * 255
    another.focused("theme")


def test_no_figure_offers_to_be_uploaded(looked: Looked) -> None:
    looked.page.wait_for_selector(".plot .main-svg")
    buttons = looked.page.locator(".modebar-btn").evaluate_all(
        "all => all.map(item => item.dataset.title)"
    )
    assert "Zoom" in buttons
    assert not [title for title in buttons if re.search("share|upload|cloud|edit", title, re.I)]


@pytest.mark.evidence
def test_work_of_a_tab_that_is_closed_ends_in_silence(served: Served, browser: Any) -> None:
    """The server's own complaints are looked at once it has ended."""
    left = Looked(browser, served.address)
    press(left, "go-diagnose", "clicks")
    press(left, "diagnose", "clicks")
    left.at("cancel").wait_for()
    left.close()
    time.sleep(GIVEN_UP + 4.0)


def test_another_name_or_another_site_is_refused(served: Served) -> None:
    place = urlsplit(served.address)
    assert place.hostname == "127.0.0.1"

    def asked(path: str, **headers: str) -> int:
        connection = http.client.HTTPConnection(place.hostname or "", place.port or 0, timeout=30)
        try:
            connection.putrequest("GET", path, skip_host=True)
            for name, value in headers.items():
                connection.putheader(name.replace("_", "-"), value)
            connection.endheaders()
            answer = connection.getresponse()
            assert answer.status != 200 or answer.headers["X-Frame-Options"] == "DENY"
            return answer.status
        finally:
            connection.close()

    upgrade = {
        "Connection": "Upgrade",
        "Upgrade": "websocket",
        "Sec_WebSocket_Version": "13",
        "Sec_WebSocket_Key": "dGhlIHNhbXBsZSBub25jZQ==",
    }
    socket = "/_nicegui_ws/socket.io/?EIO=4&transport=websocket"
    own = f"127.0.0.1:{place.port}"
    assert asked("/", Host=own) == 200
    assert asked("/", Host="evil.example") == 403
    assert asked("/", Host=own, Origin="http://evil.example") == 403
    assert asked(socket, Host=own, Origin=f"http://{own}", **upgrade) == 101
    assert asked(socket, Host=own, Origin="http://evil.example", **upgrade) == 403
    assert asked(socket, Host="evil.example", **upgrade) == 403
    assert asked(socket, Host=own, **{**upgrade, "Connection": "close"}) == 403
    assert asked("/", Host=own, Sec_Fetch_Site="same-site", Sec_Fetch_Dest="iframe") == 403


def test_a_port_that_is_taken_and_an_out_that_exists_are_one_line(served: Served) -> None:
    port = urlsplit(served.address).port
    robot, run = served.folder / "robot.yaml", served.folder / "train" / "drive_1"
    for words, said in (
        (["--port", str(port)], "--port 0 takes a free one"),
        (["--port", "x"], "is no port"),
        (["--out", str(run / "ticks.csv"), "--force"], "would overwrite"),
    ):
        end = ran([*WERRIMBI, "workbench", "--robot", robot, run, *words])
        assert end.returncode == 2
        assert len(end.stderr.splitlines()) == 1
        assert said in end.stderr
