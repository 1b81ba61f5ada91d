# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The worker process: receives a task, reports progress, sends the result.

It imports what is needed first at once, while the drives are still being read, and the rest on
demand.
"""

from __future__ import annotations

import os
import signal
from multiprocessing.connection import Connection

from werrimbi_odom.effects.lookup import all_effects
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.recordings import Recordings
from werrimbi_odom.progress import Show
from werrimbi_odom.workbench.loaded_input import opened
from werrimbi_odom.workbench.pickling import (
    known_before,
    known_to_both,
    left_there,
    packed,
    unpacked,
)
from werrimbi_odom.workbench.task import Diagnose, Open, Task


def work(asked: Connection) -> None:
    """Main function of the worker: do the task, report progress, send the result."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent handles Ctrl-C and ends this process
    try:
        import scipy.interpolate  # noqa: F401  # at once: it takes a good part of a second

        collection = all_effects(asked.recv())
        task, given = unpacked(asked.recv_bytes(), collection, {})

        def show(share: float, words: str) -> None:
            asked.send(("share", share, words))

        result = _done(task, given, show)
        asked.send(("done", None, ""))
        asked.send_bytes(result)
    except InputError as error:
        asked.send(("refused", str(error), ""))
    except (BrokenPipeError, EOFError):
        pass  # the parent has closed the connection


def _done(task: Task, given: Recordings, show: Show) -> bytes:
    """The result of a task, serialised."""
    if isinstance(task, Open):
        show(0.0, "matching ticks and reference")
        here = opened(given)
        look = here.look(given.source.robot, show)
        return packed((here, look), {**known_before(given), **left_there(here)})
    os.nice(5)  # keeps the page responsive
    from werrimbi_odom.workbench.worker_tasks import added, diagnosed

    if isinstance(task, Diagnose):
        return packed(diagnosed(task, given, show), {})
    show(0.0, "opening")
    here = opened(given)
    return packed(added(task, here, show), known_to_both(here))
