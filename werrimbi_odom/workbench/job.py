# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A task in another process, with progress and cancellation.

This module has few imports, because the first process is started before anything else.
"""

from __future__ import annotations

import multiprocessing
import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from pathlib import Path
from threading import Thread
from typing import TYPE_CHECKING, Any

from werrimbi_odom.errors import InputError

if TYPE_CHECKING:
    from werrimbi_odom.effects.lookup import Collection
    from werrimbi_odom.files.recordings import Recordings
    from werrimbi_odom.workbench.task import Task


def begin(asked: Connection) -> None:
    """Entry point of the process; see `worker.work`."""
    from werrimbi_odom.workbench.worker import work

    work(asked)


class CancelledError(Exception):
    """The task was cancelled by its owner."""


@dataclass(eq=False)
class Job:
    """A running task and its progress."""

    task: Task
    share: float = 0.0
    """Share done, 0 to 1."""
    words: str = "starting"
    cancelled: bool = False
    begun: float = field(default_factory=time.monotonic)
    """Time of the start [s]."""
    _process: Any = field(default=None, repr=False)
    _pipe: Any = field(default=None, repr=False)

    def cancel(self) -> None:
        """Cancel the task; whoever waits for its result gets `CancelledError`."""
        self.cancelled = True
        if self._process is not None:
            self._process.kill()

    async def result(self, given: Recordings, known: Mapping[str, Any]) -> Any:
        """Run the task without blocking the event loop.

        `known` are objects that the worker has too and need not send back, by their common names.
        InputError if the task fails on these drives; CancelledError if it was cancelled.
        """
        import asyncio

        try:
            return await asyncio.to_thread(self._run, given, known)
        finally:
            self.cancel()

    def start(self) -> None:
        """Start the process, which imports its modules before the task is known.

        CancelledError if it was cancelled already.
        """
        # Not forked: a fork of a process with threads (those of the server) may deadlock.
        context = multiprocessing.get_context("spawn")
        self._pipe, other = context.Pipe()
        process = context.Process(target=begin, args=(other,), daemon=True)
        if self.cancelled:
            raise CancelledError
        process.start()
        self._process = process
        if self.cancelled:
            process.kill()
        other.close()  # our copy, so that the end of the pipe is seen when the worker ends

    def ask(self, given: Recordings) -> None:
        """Send the task to a process that was started."""
        from werrimbi_odom.workbench.pickling import packed

        data = packed((self.task, given), {})
        # The process may still be importing, and a pipe blocks until it reads.
        Thread(target=self._send, args=(given.how.effects, data), daemon=True).start()

    def _send(self, files: tuple[Path, ...], data: bytes) -> None:
        with suppress(OSError):  # it was cancelled; the waiting side reports it
            self._pipe.send(files)
            self._pipe.send_bytes(data)

    def _run(self, given: Recordings, known: Mapping[str, Any]) -> Any:
        if self._process is None:
            self.start()
            self.ask(given)
        process, receiving = self._process, self._pipe
        try:
            result = self._received(receiving, known, given.collection)
            process.kill()  # it has nothing left to do, and its exit takes time
            return result
        except (EOFError, OSError):  # with unread data, the pipe is reset instead of ended
            if self.cancelled:
                raise CancelledError from None
            raise InputError(
                f"the work ended before it was done (its process ended with {process.exitcode}; "
                "was there memory enough?)"
            ) from None
        finally:
            process.join()
            receiving.close()

    def _received(
        self, receiving: Connection, known: Mapping[str, Any], collection: Collection
    ) -> Any:
        from werrimbi_odom.workbench.pickling import unpacked

        while True:
            what, value, words = receiving.recv()
            if what == "done":
                if self.cancelled:
                    raise CancelledError
                return unpacked(receiving.recv_bytes(), collection, known)
            if what == "refused":
                raise InputError(value)
            self.share, self.words = value, words
