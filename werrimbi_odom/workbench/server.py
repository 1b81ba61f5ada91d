# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The server: this machine alone, one address, nothing kept on disk."""

from __future__ import annotations

import asyncio
import socket
from collections.abc import Callable
from typing import TYPE_CHECKING

from werrimbi_odom.errors import InputError
from werrimbi_odom.workbench.job import CancelledError

if TYPE_CHECKING:
    from werrimbi_odom.workbench.opening import Opening
    from werrimbi_odom.workbench.tab import Shared

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

    from werrimbi_odom.workbench.figure import serve_drawing
    from werrimbi_odom.workbench.guard import guarded
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
