# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A progress bar on a terminal; elsewhere an occasional line."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec

from werrimbi_odom.progress import Show

EVERY = 30.0
"""Interval between lines without a terminal [s]."""


@contextmanager
def share_done(words: str) -> Iterator[Show]:
    """Show a progress bar on stderr; yields a callback for the share done and the current work.

    Without a terminal (a log, a service), a line is printed after `EVERY` seconds, repeatedly.
    """
    if not sys.stderr.isatty() or find_spec("rich") is None:
        yield _now_and_then(words)
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(words, total=1.0)
        yield lambda share, words: bar.update(task, completed=share, description=words)


def _now_and_then(title: str) -> Show:
    """Create a callback that prints a line on stderr every `EVERY` seconds."""
    told = time.monotonic()

    def show(share: float, words: str) -> None:
        nonlocal told
        if time.monotonic() - told >= EVERY:
            told = time.monotonic()
            print(f"{title}: {100.0 * share:.0f} %, {words}", file=sys.stderr, flush=True)

    return show
