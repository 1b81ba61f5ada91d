# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A fleet on a Dask cluster: files are sent with the task, so no shared disk is needed."""

from __future__ import annotations

import logging
import re
import time
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any

from werrimbi_odom.errors import InputError
from werrimbi_odom.fleet.robot_task import Task, bug, failed
from werrimbi_odom.fleet.worker_archive import PACKAGE, code_here, doubts, packed, refusal
from werrimbi_odom.report.fleet import Row

if TYPE_CHECKING:
    from distributed import Client, Future

DIED = (
    "every worker that diagnosed it died: killed, out of memory, or a crash of a library; the "
    "workers' own logs say more"
)
PATIENCE = 30.0
"""Timeout for a scheduler to answer, and for a worker to be available [s]."""

AHEAD = 2
"""Robots per worker, including the running one: no worker waits, and memory is bounded."""

_NOISY = ("distributed", "tornado", "asyncio")
"""Loggers that print tracebacks on lost connections."""

_LOOK = 2.0
"""Period of checks that the cluster is still available [s]."""


def on_cluster(
    tasks: Sequence[Task],
    address: str,
    warn: Callable[[str], None] = lambda words: None,
    patience: float = PATIENCE,
) -> Iterator[Row]:
    """Rows in the order of completion.

    `address` is tcp://HOST:PORT or tls://HOST:PORT, and `warn` is told of versions that may change
    the last digits. A scheduler must answer, and a worker be available, within `patience` [s].

    InputError if there is no scheduler or no worker, they are lost, or a worker runs other code
    than this machine.
    """
    with _connected(address, patience) as client:
        _check_code(client, address, warn, patience)
        yield from _rows(client, tasks, address, patience)


def _rows(client: Client, tasks: Sequence[Task], address: str, patience: float) -> Iterator[Row]:
    work = _work()
    wanted = dict(code_here())
    left = deque(tasks)
    under_way: dict[Future, Task] = {}
    seen = time.monotonic()
    try:
        while left or under_way:
            workers = _workers(client, address)
            seen = time.monotonic() if workers else seen
            if time.monotonic() - seen > patience:
                raise InputError(f"--scheduler {address}: all of its workers are gone")
            while left and len(under_way) < AHEAD * max(workers, 1):
                task = left.popleft()
                try:
                    data = packed(task)
                except InputError as error:
                    yield failed(task, str(error))
                    continue
                under_way[client.submit(work, data, wanted, pure=False)] = task
            for future in _done(client, under_way, address):
                task = under_way.pop(future)
                yield _row(future, task, address)
    finally:
        client.cancel(list(under_way), force=True)


def _done(client: Client, under_way: Mapping[Future, Task], address: str) -> list[Future]:
    """Completed futures, after a short wait for one."""
    from distributed import CancelledError, wait
    from distributed import TimeoutError as LateError  # until Python 3.10 not the built-in one

    if not under_way:
        return []
    try:
        with client.as_current():
            wait(list(under_way), timeout=_LOOK, return_when="FIRST_COMPLETED")
    except LateError:
        pass
    except CancelledError:
        raise _lost(address) from None
    return [future for future in under_way if future.done()]


def _row(future: Future, task: Task, address: str) -> Row:
    from distributed import CancelledError, KilledWorker

    try:
        row, words = future.result()
    except KilledWorker:
        return failed(task, DIED)
    except CancelledError:
        raise _lost(address) from None
    except Exception as error:  # the result cannot be unpickled
        return failed(task, bug(error))
    finally:
        future.release()
    if row is None:
        raise InputError(f"--scheduler {address}: a worker {words}")
    found: Row = row
    return found


def _work() -> Callable[[bytes, dict[str, str]], tuple[Any, str]]:
    """Function for a worker; a closure, because these are sent as code, not by their module name.

    So a worker without this package, which may join later, can report that it is missing.
    """

    def work(data: bytes, wanted: dict[str, str]) -> tuple[Any, str]:
        try:
            from werrimbi_odom.fleet.worker_archive import code_here, refusal, row_of_parcel
        except ImportError as error:
            return None, f"cannot import werrimbi_odom ({error})"
        why = refusal(wanted, code_here())
        return (None, f"runs other code: {why}") if why else (row_of_parcel(data), "")

    return work


def _probe() -> Callable[[], dict[str, str]]:
    """Function that reports a worker's code; also sent as code."""

    def probe() -> dict[str, str]:
        try:
            from werrimbi_odom.fleet.worker_archive import code_here

            return dict(code_here())
        except ImportError as error:
            return {"": str(error)}

    return probe


def _check_code(client: Client, address: str, warn: Callable[[str], None], patience: float) -> None:
    """Check that every worker runs the same code as this machine."""
    from distributed import TimeoutError as LateError

    try:
        client.wait_for_workers(1, timeout=patience)
    except LateError:
        raise InputError(
            f"--scheduler {address}: it has no worker; start some: dask worker {address} "
            "--nthreads 1"
        ) from None
    here = code_here()
    unsure: set[str] = set()
    for worker, there in client.run(_probe(), on_error="return").items():
        if isinstance(there, BaseException):
            raise InputError(f"--scheduler {address}: its worker {worker} says: {there!r}")
        if "" in there:
            raise InputError(
                f"--scheduler {address}: its worker {worker} cannot import {PACKAGE} "
                f"({there['']}); install it there: pip install '{PACKAGE}[cluster]'"
            )
        why = refusal(here, there)
        if why:
            raise InputError(
                f"--scheduler {address}: its worker {worker} runs other code: {why}; install the "
                "same everywhere and start the workers again"
            )
        unsure.add(doubts(here, there))
    for words in sorted(unsure - {""}):
        warn(f"workers with {words}: last digits may differ")


@contextmanager
def _connected(address: str, patience: float) -> Iterator[Client]:
    if not re.fullmatch(r"(tcp|tls)://.+:\d+/?", address):
        raise InputError(
            f"--scheduler {address}: write tcp://HOST:PORT (or tls://HOST:PORT), as `dask "
            "scheduler` says it when it starts"
        )
    try:
        import dask
        from distributed import TimeoutError as LateError
    except ModuleNotFoundError as missing:
        raise InputError(
            f"--scheduler needs the Python package {missing.name}: "
            f"pip install '{PACKAGE}[cluster]', here and on the workers"
        ) from missing
    # Each robot's drives are sent once, so Dask's advice on large graphs does not apply.
    large = {"distributed.admin.large-graph-warning-threshold": "16 GiB"}
    with _unheard(), dask.config.set(large):
        try:
            client = _client(address, patience)
        except (OSError, ValueError, TypeError, RuntimeError, LateError) as error:
            said = " ".join(str(error).split())
            raise InputError(
                f"--scheduler {address}: no Dask scheduler answers there ({said}); start one with "
                "`dask scheduler` and give the address that it prints"
            ) from error
        try:
            yield client
        finally:
            client.close(timeout=5.0)


@contextmanager
def _unheard() -> Iterator[None]:
    """Silence Dask's logs on a lost cluster, which is reported in one line instead."""
    names = [name for name in logging.root.manager.loggerDict if name.startswith(_NOISY)]
    loggers = [logging.getLogger(name) for name in names]
    levels = [each.level for each in loggers]
    for each in loggers:
        each.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        for each, level in zip(loggers, levels, strict=True):
            each.setLevel(level)


def _client(address: str, patience: float) -> Client:
    """A client that closes itself if it cannot connect.

    Dask leaves this to the garbage collector, which may run while another client starts its loop:
    both then wait for the same lock in one thread, a deadlock.
    """
    from distributed import Client as DaskClient

    class Closing(DaskClient):  # type: ignore[misc]
        def start(self, **how: Any) -> None:
            try:
                super().start(**how)
            except BaseException:
                with suppress(Exception):
                    self.close(timeout=5.0)
                raise

    return Closing(address, timeout=patience, set_as_default=False)


def _workers(client: Client, address: str) -> int:
    """Current number of workers."""
    from distributed import TimeoutError as LateError

    try:
        return len(client.nthreads())
    except (OSError, LateError, ValueError, RuntimeError):
        raise _lost(address) from None


def _lost(address: str) -> InputError:
    return InputError(f"--scheduler {address}: the connection to it is lost")
