# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Caches of a few latest results, and results that are worked out side by side."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from threading import Lock
from typing import Any, TypeVar

import numpy as np

THREADS = 2
"""Results worked out side by side."""

WORTH_THREADS = range(30_000, 500_000)
"""Numbers of steps for which that is worth it. With fewer, little of the time is spent within numpy
and compiled code, which release Python's lock. With more, memory is what is short, and each thread
takes, and keeps, a dozen arrays of the steps."""

Found = TypeVar("Found")
Memory = list[tuple[object, dict[Hashable, Any]]]
"""Results by key, for the last few models."""

_REMEMBERING = Lock()


def recalled(
    memory: Memory, model: object, key: Hashable, work: Callable[[], Found], most: int
) -> Found:
    """Result of `work` for a model; cached for the last `most` models."""
    found = results_of(memory, model, most)
    if key not in found:
        found[key] = work()
    value: Found = found[key]
    return value


def results_of(memory: Memory, model: object, most: int) -> dict[Hashable, Any]:
    """Cached results of a model, by key."""
    found = next((found for known, found in memory if known == model), None)
    if found is None:
        found = {}
        memory.append((model, found))
        del memory[:-most]
    return found


def remember(memory: dict[Any, Any], key: Any, value: Any, most: int) -> None:
    """Cache a value as the latest of `most`; the least recently used is dropped."""
    with _REMEMBERING:
        memory.pop(key, None)
        while len(memory) >= most:
            del memory[next(iter(memory))]
        memory[key] = value


@cache
def keep_freed_memory() -> None:
    """Let the C library keep freed arrays of up to 32 MB for those that follow.

    It would map each anew and zero it page by page. It keeps what is as large as the largest block
    that was ever freed (glibc: mallopt(3), M_MMAP_THRESHOLD); this one is never touched.
    """
    np.empty(_KEPT)


_KEPT = 4_190_000
"""Numbers of 8 bytes, just below 32 MB."""


def side_by_side(works: Sequence[Callable[[], Found]], steps: int) -> list[Found]:
    """Results of independent functions on arrays of this many steps, in their order."""
    if steps not in WORTH_THREADS:
        return [work() for work in works]
    with ThreadPoolExecutor(THREADS) as pool:
        return list(pool.map(lambda work: work(), works))
