# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What the page asks of a process of its own: told how far it is, stopped when nobody wants it.

Few imports: the first process is begun before anything else is.
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
    from werrimbi_odom.effects.collection import Collection
    from werrimbi_odom.files.recordings import Recordings
    from werrimbi_odom.model.robot import Robot


def begin(asked: Connection) -> None:
    """See `work.work`."""
    from werrimbi_odom.workbench.work import work

    work(asked)


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
    _pipe: Any = field(default=None, repr=False)

    def cancel(self) -> None:
        """Stop it; whoever waits for its result gets `CancelledError`."""
        self.cancelled = True
        if self._process is not None:
            self._process.kill()

    async def result(self, given: Recordings, known: Mapping[str, Any]) -> Any:
        """Do the work; the event loop goes on meanwhile.

        Parameters
        ----------
        known
            What the worker has too, and need not send back, by the words it knows it by.

        Raises
        ------
        InputError
            When the drives do not allow it.
        CancelledError
            When it was stopped.
        """
        import asyncio

        try:
            return await asyncio.to_thread(self._run, given, known)
        finally:
            self.cancel()

    def start(self) -> None:
        """Have the process there, and let it import what it needs, before the work is known.

        Raises
        ------
        CancelledError
            When it was stopped already.
        """
        # Not forked: a copy of a process with threads (those of the server) may hang.
        context = multiprocessing.get_context("spawn")
        self._pipe, other = context.Pipe()
        process = context.Process(target=begin, args=(other,), daemon=True)
        if self.cancelled:
            raise CancelledError
        process.start()
        self._process = process
        if self.cancelled:
            process.kill()
        other.close()  # ours; so that its end is seen when the worker ends

    def ask(self, given: Recordings) -> None:
        """Say what is to be done, to a process that was started."""
        from werrimbi_odom.workbench.work import packed

        data = packed((self.task, given), {})
        # It may still be importing, and a pipe holds little until it reads.
        Thread(target=self._send, args=(given.how.effects, data), daemon=True).start()

    def _send(self, files: tuple[Path, ...], data: bytes) -> None:
        with suppress(OSError):  # it was stopped; whoever waits for the result is told
            self._pipe.send(files)
            self._pipe.send_bytes(data)

    def _run(self, given: Recordings, known: Mapping[str, Any]) -> Any:
        if self._process is None:
            self.start()
            self.ask(given)
        process, receiving = self._process, self._pipe
        try:
            result = self._received(receiving, known, given.collection)
            process.kill()  # it has nothing left to do, and would take its time to end
            return result
        except (EOFError, OSError):  # what it had not read yet makes it a reset, not an end
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
        from werrimbi_odom.workbench.work import unpacked

        while True:
            what, value, words = receiving.recv()
            if what == "done":
                if self.cancelled:
                    raise CancelledError
                return unpacked(receiving.recv_bytes(), collection, known)
            if what == "refused":
                raise InputError(value)
            self.share, self.words = value, words


@dataclass(frozen=True)
class Diagnose:
    """Find out what a robot's model is missing."""

    robot: Robot


@dataclass(frozen=True)
class Add:
    """Fit more effects together, and compare."""

    effects: tuple[str, ...]
    robot: Robot


@dataclass(frozen=True)
class Open:
    """Cut the drives into legs, and compare the robot as given."""


Task = Diagnose | Add | Open
