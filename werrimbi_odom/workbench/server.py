# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The server: this machine alone, one address, nothing kept on disk, and who may ask.

Pages of this server on this machine may; a page of another site may not.
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
    """A socket on loopback; port 0: a free one.

    Raises
    ------
    InputError
        When the port is taken, or not allowed.
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
    """Serve the page until it is interrupted.

    Parameters
    ----------
    ready
        Told the address once it can be opened.
    opened
        Told it again once all is compared, with what came of it.

    Raises
    ------
    InputError
        When the drives could not be opened; the server has ended then.
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
        gzip_middleware_factory=None,  # it never leaves this machine: packing only costs time
    )  # fmt: skip
    config = uvicorn.Config(
        guarded(site, port),
        log_level="warning",
        lifespan="on",
        server_header=False,
        timeout_graceful_shutdown=2,
    )

    class Server(uvicorn.Server):
        async def startup(self, sockets: list[socket.socket] | None = None) -> None:
            await super().startup(sockets=sockets)
            ready(address)
            self.waiting = asyncio.create_task(self.wait())

        async def wait(self) -> None:
            try:
                opened(address, await opening.result())
            except (InputError, CancelledError):
                self.should_exit = True

    address = f"http://{HOST}:{port}/"
    Server(config).run(sockets=[at])
    if isinstance(opening.trouble, InputError):
        raise opening.trouble


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
