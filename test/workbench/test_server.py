# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The server hears its own page on its own address, and nobody else."""

from __future__ import annotations

from typing import Any

import pytest

from test.loops import awaited
from werrimbi_odom.workbench.server import guarded

PORT = 4711
HERE = f"127.0.0.1:{PORT}"


def heard(kind: str, *headers: tuple[str, str], method: str = "GET") -> bool:
    """Whether a request reaches the application."""
    reached: list[str] = []
    sent: list[Any] = []

    async def application(scope: Any, receive: Any, send: Any) -> None:
        reached.append(scope["type"])

    async def send(message: Any) -> None:
        sent.append(message)

    async def receive() -> Any:
        raise AssertionError("nothing is to be read of a request that is refused")

    raw = [(name.encode(), value.encode()) for name, value in headers]
    scope = {"type": kind, "headers": raw, "method": method, "path": "/"}
    awaited(guarded(application, PORT)(scope, receive, send))
    if not reached:
        refusal = sent[0]
        assert refusal.get("status", 403) == 403
        assert refusal["type"] in ("http.response.start", "websocket.close")
    return bool(reached)


@pytest.mark.parametrize("kind", ["http", "websocket"])
@pytest.mark.parametrize("name", ["127.0.0.1", "localhost"])
def test_its_own_page_is_heard(kind: str, name: str) -> None:
    host = f"{name}:{PORT}"
    assert heard(kind, ("host", host))
    assert heard(kind, ("host", host), ("origin", f"http://{host}"))


@pytest.mark.parametrize("kind", ["http", "websocket"])
@pytest.mark.parametrize(
    "headers",
    [
        [],
        [("host", f"evil.example:{PORT}")],
        [("host", "127.0.0.1")],
        [("host", f"127.0.0.1:{PORT + 1}")],
        [("host", f"127.0.0.1.evil.example:{PORT}")],
        [("host", HERE), ("host", f"evil.example:{PORT}")],
        [("host", HERE), ("origin", "http://evil.example")],
        [("host", HERE), ("origin", f"https://{HERE}")],
        [("host", HERE), ("origin", f"http://127.0.0.1:{PORT + 1}")],
        [("host", HERE), ("origin", "null")],
        [("host", HERE), ("origin", f"http://{HERE}"), ("origin", "http://evil.example")],
    ],
)
def test_others_are_not(kind: str, headers: list[tuple[str, str]]) -> None:
    assert not heard(kind, *headers)


LINK = [("sec-fetch-mode", "navigate"), ("sec-fetch-dest", "document")]


@pytest.mark.parametrize("site", ["cross-site", "same-site"])
def test_another_site_may_link_to_the_page_and_nothing_else(site: str) -> None:
    """Another port of this machine is of the same site."""
    other = [("host", HERE), ("sec-fetch-site", site)]
    assert heard("http", *other, *LINK)
    assert not heard("http", *other, *LINK, method="POST")
    assert not heard("websocket", *other, *LINK)
    script = [("sec-fetch-mode", "no-cors"), ("sec-fetch-dest", "script")]
    frame = [("sec-fetch-mode", "navigate"), ("sec-fetch-dest", "iframe")]
    for more in (script, frame, []):
        assert not heard("http", *other, *more)
    assert heard("http", ("host", HERE), ("sec-fetch-site", "same-origin"), *script)
    assert heard("http", ("host", HERE), ("sec-fetch-site", "none"), *LINK)


def test_what_asks_for_a_socket_and_is_none_does_not_reach_it() -> None:
    asked = [("host", HERE), ("connection", "close"), ("upgrade", "websocket")]
    assert not heard("http", *asked)
    assert heard("websocket", *asked)


def test_no_page_may_hold_it_in_a_frame() -> None:
    sent: list[Any] = []

    async def application(scope: Any, receive: Any, send: Any) -> None:
        await send({"type": "http.response.start", "status": 200, "headers": [(b"a", b"b")]})

    async def send(message: Any) -> None:
        sent.append(message)

    scope = {"type": "http", "headers": [(b"host", HERE.encode())], "method": "GET", "path": "/"}
    awaited(guarded(application, PORT)(scope, send, send))
    told = dict(sent[0]["headers"])
    assert told[b"x-frame-options"] == b"DENY"
    assert told[b"content-security-policy"] == b"frame-ancestors 'none'"
    assert told[b"a"] == b"b"
