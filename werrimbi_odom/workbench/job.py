# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Long work in a process of its own: told how far it is, stopped when nobody wants it any more."""

from __future__ import annotations

import asyncio
import multiprocessing
import time
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from typing import Any

from werrimbi_odom.effects.collection import Collection
from werrimbi_odom.errors import InputError
from werrimbi_odom.workbench.crossing import packed, unpacked
from werrimbi_odom.workbench.opened import Opened
from werrimbi_odom.workbench.work import Task, known_to_both, work


class CancelledError(Exception):
    """The work was stopped by who had asked for it."""


@dataclass(eq=False)
class Job:
    """One piece of work under way; its progress is there to be looked at."""

    task: Task
    share: float = 0.0
    """Done, 0 to 1."""
    words: str = "starting"
    cancelled: bool = False
    begun: float = field(default_factory=time.monotonic)
    """[s]"""
    _process: Any = field(default=None, repr=False)

    def cancel(self) -> None:
        """Stop it; whoever waits for its result gets `CancelledError`."""
        self.cancelled = True
        if self._process is not None:
            self._process.kill()

    async def result(self, opened: Opened, collection: Collection) -> Any:
        """Do the work; the event loop goes on meanwhile.

        Raises
        ------
        InputError
            When the drives do not allow it.
        CancelledError
            When it was stopped.
        """
        try:
            return await asyncio.to_thread(self._run, opened, collection)
        finally:
            self.cancel()

    def _run(self, opened: Opened, collection: Collection) -> Any:
        # Not forked: a copy of a process with threads (those of the server) may hang.
        context = multiprocessing.get_context("spawn")
        receiving, sending = context.Pipe(duplex=False)
        data = packed((self.task, opened.given), {})
        files = opened.given.told.effect_files
        process = context.Process(target=work, args=(sending, data, files), daemon=True)
        if self.cancelled:
            raise CancelledError
        process.start()
        self._process = process
        if self.cancelled:
            process.kill()
        sending.close()  # ours; so that its end is seen when the worker ends
        try:
            return self._received(receiving, opened, collection)
        except EOFError:
            if self.cancelled:
                raise CancelledError from None
            raise InputError(
                f"the work ended before it was done (its process ended with {process.exitcode}; "
                "was there memory enough?)"
            ) from None
        finally:
            process.join()
            receiving.close()

    def _received(self, receiving: Connection, opened: Opened, collection: Collection) -> Any:
        while True:
            what, value, words = receiving.recv()
            if what == "done":
                if self.cancelled:
                    raise CancelledError
                return unpacked(value, collection, known_to_both(opened))
            if what == "refused":
                raise InputError(value)
            self.share, self.words = value, words
