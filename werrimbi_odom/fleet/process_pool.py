# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A fleet on this machine, one process per robot; a crash of one is reported in its row."""

from __future__ import annotations

import multiprocessing
import os
import signal
from collections import deque
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing.connection import wait as wait_for
from threading import Thread
from typing import TypeVar

from werrimbi_odom.fleet.robot_task import bug

Asked = TypeVar("Asked")
Found = TypeVar("Found")
Work = Callable[[Asked], Found]
Lost = Callable[[Asked, str], Found]

DIED = (
    "the process that worked on it died, and again when it was tried alone: killed, out of memory, "
    "or a crash of a library"
)


def processors() -> int:
    """Number of processors available to this process."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def spread(
    tasks: Sequence[Asked], jobs: int, work: Work[Asked, Found], lost: Lost[Asked, Found]
) -> Iterator[Found]:
    """Results of tasks in the order of completion, from at most `jobs` processes.

    If a process dies, the pool loses all running tasks, and the cause is unknown. So these are
    tried again one by one, and only a task that kills its process again is given up.

    `work` is a function of a module; `lost` makes the result of a task that ended its process, or
    whose result is unreadable.
    """
    left = deque(tasks)
    while left:
        for task in (yield from _pooled(left, jobs, work, lost)):
            if (yield from _pooled(deque([task]), 1, work, lost)):
                yield lost(task, DIED)


def _pooled(
    left: deque[Asked], jobs: int, work: Work[Asked, Found], lost: Lost[Asked, Found]
) -> Generator[Found, None, list[Asked]]:
    """Results of tasks, taken from `left`; returns those running when a process died."""
    others = set(multiprocessing.active_children())
    pool = ProcessPoolExecutor(
        min(jobs, len(left)), multiprocessing.get_context("spawn"), _end_with_parent
    )
    under_way: dict[Future[Found], Asked] = {}
    died: list[Asked] = []
    try:
        while under_way or (left and not died):
            while left and not died and len(under_way) < jobs:
                with _no_interrupt():
                    try:
                        under_way[pool.submit(work, left[0])] = left[0]
                    except BrokenProcessPool:
                        break
                left.popleft()
            if not under_way:
                break
            done, _ = wait(under_way, return_when=FIRST_COMPLETED)
            for future in done:
                task = under_way.pop(future)
                try:
                    row = future.result()
                except BrokenProcessPool:
                    died.append(task)
                    continue
                except Exception as error:  # the result cannot be unpickled
                    row = lost(task, bug(error))
                yield row
    finally:
        if under_way:
            for child in set(multiprocessing.active_children()) - others:
                child.terminate()
        pool.shutdown(cancel_futures=True)
    return died


@contextmanager
def _no_interrupt() -> Iterator[None]:
    """Start processes that ignore Ctrl-C, which the terminal sends to all; this one handles it."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _end_with_parent() -> None:
    """End this process with its parent, as it would otherwise wait for work for ever."""
    parent = multiprocessing.parent_process()
    assert parent is not None

    def watch() -> None:
        wait_for([parent.sentinel])
        os._exit(1)

    Thread(target=watch, daemon=True).start()
