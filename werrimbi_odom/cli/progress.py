# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A bar on the terminal while something takes its time; nothing where nobody looks."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from importlib.util import find_spec
from typing import TypeVar

Item = TypeVar("Item")


def with_progress(items: Sequence[Item], words: str) -> Iterator[Item]:
    """The items one by one, with a bar on stderr if that is a terminal."""
    if not sys.stderr.isatty():
        yield from items
        return
    from rich.console import Console
    from rich.progress import track

    yield from track(items, words, console=Console(stderr=True), transient=True)


@contextmanager
def share_done(words: str) -> Iterator[Callable[[float, str], None]]:
    """A bar on stderr, if that is a terminal, to be told the share done and what is being done."""
    if not sys.stderr.isatty() or find_spec("rich") is None:
        yield lambda share, words: None
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(words, total=1.0)
        yield lambda share, words: bar.update(task, completed=share, description=words)
