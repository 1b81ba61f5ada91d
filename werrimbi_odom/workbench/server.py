# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The server: on loopback only, at one address, without data on disk, and with access control.

Requests are accepted only from pages of this server, not from pages of other sites.
"""

from __future__ import annotations

import asyncio
import socket
from collections.abc import Awaitable, Callable, MutableMapping
from typing import TYPE_CHECKING, Any

from werrimbi_odom.errors import InputError
from werrimbi_odom.workbench.job import CancelledError

if TYPE_CHECKING:
    from werrimbi_odom.workbench.tab import Opening, Shared


HOST = "127.0.0.1"
ICON = (
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 16 16"><circle cx="8" cy="8" r="6.5" '
    'fill="none" stroke="#0072B2" stroke-width="2.5"/><circle cx="9.6" cy="8" r="1.8" '
    'fill="#D55E00"/></svg>'
)


def listening(port: int) -> socket.socket:
    """A listening socket on loopback; port 0 for a free one.

    InputError if the port is in use or not allowed.
    """
    found = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    found.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        found.bind((HOST, port))
        found.listen()
    except OSError as error:
        found.close()
        why = error.strerror or str(error)
        raise InputError(
            f"port {port} cannot be used ({why}); --port 0 takes a free one"
        ) from error
    return found


def serve(
    opening: Opening,
    at: socket.socket,
    ready: Callable[[str], None],
    opened: Callable[[str, Shared], None],
) -> None:
    """Serve the page on a listening socket until interrupted.

    `ready` is called with the address when it can be opened, `opened` with the address and the
    result when the comparison is done. InputError if the drives could not be opened, or from
    `opened`; the server has ended then.
    """
    import uvicorn
    from fastapi import FastAPI
    from nicegui import app, ui

    from werrimbi_odom.workbench.html import serve_drawing
    from werrimbi_odom.workbench.page import page

    port = int(at.getsockname()[1])
    site = FastAPI(openapi_url=None)

    async def root() -> None:
        await page(opening)

    def stop() -> None:
        opening.job.cancel()
        for job in tuple(opening.shared.jobs if opening.shared else ()):
            job.cancel()

    app.on_shutdown(stop)
    serve_drawing()
    ui.run_with(
        site, root=root, title="werrimbi workbench", favicon=ICON, tailwind=False,
        show_welcome_message=False, language="en-US", reconnect_timeout=10.0,
        gzip_middleware_factory=None,  # traffic on loopback; compression only costs time
    )  # fmt: skip
    config = uvicorn.Config(
        guarded(site, port),
        log_level="warning",
        lifespan="on",
        server_header=False,
        timeout_graceful_shutdown=2,
    )

    trouble: list[Exception] = []

    class Server(uvicorn.Server):
        async def startup(self, sockets: list[socket.socket] | None = None) -> None:
            await super().startup(sockets=sockets)
            ready(address)
            self.waiting = asyncio.create_task(self.wait())

        async def wait(self) -> None:
            try:
                opened(address, await opening.result())
            except (InputError, CancelledError) as error:
                trouble.append(error)
                self.should_exit = True

    address = f"http://{HOST}:{port}/"
    Server(config).run(sockets=[at])
    for error in trouble:
        if isinstance(error, InputError):
            raise error


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
"""Headers of every response: no page may embed ours in a frame (clickjacking) or read our
scripts."""


def guarded(app: App, port: int) -> App:
    """The application behind a filter of requests and sockets with a foreign Host or Origin.

    A page of another site, or of another server on this machine, can make a browser send requests:
    then Origin or Sec-Fetch-Site shows it. A hostname of an attacker that resolves to 127.0.0.1
    (DNS rebinding) makes it same-origin: then Host shows it. Other pages may only link to ours.
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
                # An upgrade to a websocket within plain HTTP is not valid, and never sent by our
                # page.
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
    """Whether the request is from our page or from the user; non-browsers send no such header."""
    return set(given.get(b"sec-fetch-site", ())) <= {b"same-origin", b"none"}


def _is_link(scope: Message, given: dict[bytes, list[bytes]]) -> bool:
    """Whether a browser navigates to our page."""
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
