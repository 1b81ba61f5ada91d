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


def guarded(app: App, port: int) -> App:
    """The application, deaf to requests and sockets that come by another name or page.

    A page of another site can make a browser ask us: then Origin names that site. A name of the
    attacker's that leads to 127.0.0.1 (DNS rebinding) makes it our own page: then Host names him.
    """
    hosts = {f"{name}:{port}".encode() for name in NAMES}
    origins = {b"http://" + host for host in hosts}

    async def ask(scope: Message, receive: Receive, send: Send) -> None:
        if scope["type"] in ("http", "websocket"):
            host = [value for name, value in scope["headers"] if name == b"host"]
            origin = [value for name, value in scope["headers"] if name == b"origin"]
            site = [value for name, value in scope["headers"] if name == b"sec-fetch-site"]
            foreign = scope["type"] == "websocket" or scope["method"] != "GET"
            fine = (
                len(host) == 1
                and host[0] in hosts
                and all(value in origins for value in origin)
                and not (foreign and any(value == b"cross-site" for value in site))
            )
            if not fine:
                await _refused(scope, send)
                return
        await app(scope, receive, send)

    return ask


async def _refused(scope: Message, send: Send) -> None:
    if scope["type"] == "websocket":
        await send({"type": "websocket.close", "code": 1008})  # before accept: HTTP 403
        return
    text = b"This page is for the machine it runs on, by its own address only.\n"
    headers = [(b"content-type", b"text/plain"), (b"content-length", str(len(text)).encode())]
    await send({"type": "http.response.start", "status": 403, "headers": headers})
    await send({"type": "http.response.body", "body": text})
