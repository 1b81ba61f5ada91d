# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The first comparison, made while the server and the page come up: how far it is, what came of it.

In a process of its own, as all long work: in a thread it would hold up the server, and NiceGUI, as
it starts, looks at every object there is (`gc.get_objects`), which CPython does not allow beside a
thread that is making tuples.
"""

from __future__ import annotations

import asyncio
from typing import Any

from werrimbi_odom.files.recordings import Recordings
from werrimbi_odom.workbench.job import Job
from werrimbi_odom.workbench.saving import Target
from werrimbi_odom.workbench.tab import Shared
from werrimbi_odom.workbench.work import NOT_SENT, known_before


class Opening:
    """What all tabs wait for.

    Parameters
    ----------
    job : Job
        A process that was started, for an `Open`; it is asked at once.
    given : Recordings
        What was read.
    target : Target
        Where files may be written.

    Attributes
    ----------
    trouble : BaseException or None
        Why it did not work.
    """

    def __init__(self, job: Job, given: Recordings, target: Target) -> None:
        self.job, self.given = job, given
        self.trouble: BaseException | None = None
        self._target = target
        self._task: asyncio.Task[Shared] | None = None
        job.ask(given)

    @property
    def shared(self) -> Shared | None:
        """What was opened, if that is done already."""
        if self._task is None or not self._task.done() or self.trouble is not None:
            return None
        return self._task.result()

    async def result(self) -> Shared:
        """What was opened, once it is there; who stops waiting does not stop the others.

        Raises
        ------
        InputError
            When the drives cannot be used.
        """
        if self._task is None:
            self._task = asyncio.create_task(self._finished())
        return await asyncio.shield(self._task)

    async def _finished(self) -> Shared:
        try:
            known = {**known_before(self.given), **NOT_SENT}
            made: Any = await self.job.result(self.given, known)
        except BaseException as error:
            self.trouble = error
            raise
        opened, look = made
        return Shared(opened, look, self.given.source, self.given.collection, self._target)
