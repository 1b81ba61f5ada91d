# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Looks at a page in a real headless Chromium, over its own debugging protocol (kaleido has it)."""

from __future__ import annotations

import asyncio
import base64
import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from test.loops import awaited

PATIENCE = 120.0
"""Seconds after which a page that has not drawn itself is given up: this machine may be busy."""


@dataclass
class Visit:
    """What happened on a page."""

    complaints: list[str] = field(default_factory=list)
    """Errors on the console, exceptions, and what the page's own policy refused."""
    requests: list[str] = field(default_factory=list)
    """Addresses that were asked for, the page's own file left out."""
    answers: list[Any] = field(default_factory=list)
    """Of the scripts, in their order."""


def visit(
    path: Path,
    scripts: Sequence[str] = (),
    *,
    browser: str,
    dark: bool = False,
    width: int = 1280,
    picture: Path | None = None,
    tallest: int | None = None,
) -> Visit:
    """Open a page, wait until all of it is drawn, run scripts, take a picture of the whole page.

    Scripts are JavaScript expressions; promises are waited for. `dark` is what the browser's user
    prefers; what lies below `tallest` is left out of the picture [pixels].
    """
    found: Visit = awaited(
        asyncio.wait_for(_visit(path, scripts, browser, dark, width, picture, tallest), PATIENCE)
    )
    return found


async def _visit(
    path: Path,
    scripts: Sequence[str],
    browser: str,
    dark: bool,
    width: int,
    picture: Path | None,
    tallest: int | None,
) -> Visit:
    import choreographer

    found = Visit()
    address = path.resolve().as_uri()

    async def asked(event: Any) -> None:
        url = event["params"]["request"]["url"]
        if url != address and not url.startswith(("data:", "blob:")):
            found.requests.append(url)

    async def logged(event: Any) -> None:
        entry = event["params"]["entry"]
        if entry["level"] == "error":
            found.complaints.append(entry["text"])

    async def said(event: Any) -> None:
        if event["params"]["type"] == "error":
            found.complaints.append(json.dumps(event["params"]["args"]))

    async def thrown(event: Any) -> None:
        found.complaints.append(json.dumps(event["params"]["exceptionDetails"]))

    async with choreographer.Browser(path=browser, headless=True) as opened:
        tab = await opened.create_tab("about:blank")
        session = await tab.create_session()
        for event, listener in (
            ("Network.requestWillBeSent", asked),
            ("Log.entryAdded", logged),
            ("Runtime.consoleAPICalled", said),
            ("Runtime.exceptionThrown", thrown),
        ):
            session.subscribe(event, listener, repeating=True)
        send = session.send_command
        for part in ("Network", "Log", "Runtime", "Page"):
            await send(f"{part}.enable")
        await send(
            "Emulation.setEmulatedMedia",
            {"features": [{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}]},
        )
        await send(
            "Emulation.setDeviceMetricsOverride",
            {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False},
        )
        await send("Page.navigate", {"url": address})
        while not await _asked(session, "document.readyState === 'complete'"):
            await asyncio.sleep(0.1)
        await _asked(session, "window.werrimbi && window.werrimbi.drawn.then(() => true)")
        for script in scripts:
            found.answers.append(await _asked(session, script))
        if picture is not None:
            height = await _asked(session, "document.documentElement.scrollHeight")
            height = min(height, tallest or height)
            shot = await send(
                "Page.captureScreenshot",
                {
                    "captureBeyondViewport": True,
                    "clip": {"x": 0, "y": 0, "width": width, "height": height, "scale": 1},
                },
            )
            picture.write_bytes(base64.b64decode(shot["result"]["data"]))
    return found


async def _asked(session: Any, expression: str) -> Any:
    answer = await session.send_command(
        "Runtime.evaluate", {"expression": expression, "awaitPromise": True, "returnByValue": True}
    )
    result = answer["result"]
    if "exceptionDetails" in result:
        raise AssertionError(f"{expression}: {result['exceptionDetails']}")
    return result["result"].get("value")
