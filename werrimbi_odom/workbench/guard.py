# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Who may ask: pages of this server on this machine; a page of another site may not."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, MutableMapping
from typing import Any

Message = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Message]]
Send = Callable[[Message], Awaitable[None]]
App = Callable[[Message, Receive, Send], Awaitable[None]]

NAMES = ("127.0.0.1", "localhost")
CLOSED = (
    (b"x-frame-options", b"DENY"),
    (b"content-security-policy", b"frame-ancestors 'none'"),
    (b"cross-origin-resource-policy", b"same-origin"),
)
"""With every answer: no page holds ours in a frame, to have its buttons pressed unseen, or reads a
script of ours."""


def guarded(app: App, port: int) -> App:
    """The application, deaf to requests and sockets that come by another name or page.

    A page of another site, or of another server on this machine, can make a browser ask us: then
    Origin or Sec-Fetch-Site tells. A name of the attacker's that leads to 127.0.0.1 (DNS rebinding)
    makes it our own page: then Host names him. Another page may link to ours, and nothing else.
    """
    hosts = {f"{name}:{port}".encode() for name in NAMES}
    origins = {b"http://" + host for host in hosts}

    async def ask(scope: Message, receive: Receive, send: Send) -> None:
        if scope["type"] in ("http", "websocket"):
            given: dict[bytes, list[bytes]] = {}
            for name, value in scope["headers"]:
                given.setdefault(name, []).append(value)
            host = given.get(b"host", [])
            fine = (
                len(host) == 1
                and host[0] in hosts
                and all(value in origins for value in given.get(b"origin", []))
                and (_from_here(given) or _is_link(scope, given))
                # To ask for a socket and to close at once is none, and nothing of ours asks so.
                and not (scope["type"] == "http" and b"upgrade" in given)
            )
            if not fine:
                await _refused(scope, send)
                return
        await app(scope, receive, closed(send))

    def closed(send: Send) -> Send:
        async def answer(message: Message) -> None:
            if message["type"] == "http.response.start":
                message = {**message, "headers": [*message.get("headers", ()), *CLOSED]}
            await send(message)

        return answer

    return ask


def _from_here(given: dict[bytes, list[bytes]]) -> bool:
    """Whether a page of ours asks, or the user himself; what is no browser does not say."""
    return set(given.get(b"sec-fetch-site", ())) <= {b"same-origin", b"none"}


def _is_link(scope: Message, given: dict[bytes, list[bytes]]) -> bool:
    """Whether a browser is to open our page as its own."""
    return (
        scope["type"] == "http"
        and scope["method"] == "GET"
        and given.get(b"sec-fetch-mode") == [b"navigate"]
        and given.get(b"sec-fetch-dest") == [b"document"]
    )


async def _refused(scope: Message, send: Send) -> None:
    if scope["type"] == "websocket":
        await send({"type": "websocket.close", "code": 1008})  # before accept: HTTP 403
        return
    text = b"This page is for the machine it runs on, by its own address only.\n"
    headers = [(b"content-type", b"text/plain"), (b"content-length", str(len(text)).encode())]
    await send({"type": "http.response.start", "status": 403, "headers": headers})
    await send({"type": "http.response.body", "body": text})
