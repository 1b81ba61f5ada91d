# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A fleet on the processors of this machine, a process each; a robot that kills one is a row."""

from __future__ import annotations

import multiprocessing
import os
import signal
from collections import deque
from collections.abc import Generator, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing.connection import wait as wait_for
from threading import Thread

from werrimbi_odom.fleet.one import Task, bug, failed, row_of
from werrimbi_odom.report.fleet.rows import Row

DIED = (
    "the process that diagnosed it died, and again when it was tried alone: killed, out of memory, "
    "or a crash of a library"
)


def processors() -> int:
    """How many this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def here(tasks: Sequence[Task], jobs: int) -> Iterator[Row]:
    """Rows as they come, from `jobs` processes at the most.

    A process that dies takes others with it, and nobody knows which robot killed it. So those that
    were under way are tried again one by one, and only who kills again is given up.
    """
    left = deque(tasks)
    while left:
        for task in (yield from _pooled(left, jobs)):
            if (yield from _pooled(deque([task]), 1)):
                yield failed(task, DIED)


def _pooled(left: deque[Task], jobs: int) -> Generator[Row, None, list[Task]]:
    """Rows of tasks, which are taken from `left`; returns those under way when a process died."""
    others = set(multiprocessing.active_children())
    pool = ProcessPoolExecutor(
        min(jobs, len(left)), multiprocessing.get_context("spawn"), _end_with_parent
    )
    under_way: dict[Future[Row], Task] = {}
    lost: list[Task] = []
    try:
        while under_way or (left and not lost):
            while left and not lost and len(under_way) < jobs:
                with _no_interrupt():
                    try:
                        under_way[pool.submit(row_of, left[0])] = left[0]
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
                    lost.append(task)
                    continue
                except Exception as error:  # what comes back cannot be read
                    row = failed(task, bug(error))
                yield row
    finally:
        if under_way:
            for child in set(multiprocessing.active_children()) - others:
                child.terminate()
        pool.shutdown(cancel_futures=True)
    return lost


@contextmanager
def _no_interrupt() -> Iterator[None]:
    """Processes begun here never see Ctrl-C, which the terminal sends to all: it is for us."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _end_with_parent() -> None:
    """A process whose parent was killed would wait for work for ever."""
    parent = multiprocessing.parent_process()
    assert parent is not None

    def watch() -> None:
        wait_for([parent.sentinel])
        os._exit(1)

    Thread(target=watch, daemon=True).start()
