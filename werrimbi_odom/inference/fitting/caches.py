# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Caches of what is worked out of runs again and again, and work that is done side by side."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from concurrent.futures import ThreadPoolExecutor
from copy import copy
from dataclasses import dataclass, field, fields
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

MODELS = 8
"""Models whose results are cached: a fit returns to a few only."""
DELAYS = 4
"""Reference delays whose shifted runs are cached: a fit moves one both ways, then on."""
DRIVES = 2
"""Robots whose inputs to effects are cached: twenty numbers for each step."""

Found = TypeVar("Found")
OfModels = list[tuple[object, dict[Hashable, Any]]]
"""Results by key, for the last few models."""

_REMEMBERING = Lock()


@dataclass(frozen=True, slots=True, eq=False)
class Caches:
    """What was worked out of some runs."""

    drives: dict[Hashable, Any] = field(default_factory=dict)
    _delayed: dict[Hashable, Any] = field(default_factory=dict)
    _known: dict[Hashable, Any] = field(default_factory=dict)
    _of_models: OfModels = field(default_factory=list)
    _of_steps: OfModels = field(default_factory=list)
    _latest: list[tuple[tuple[object, ...], Any]] = field(default_factory=list)

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle empty: some keys are functions."""
        return Caches, ()

    def copied(self) -> Caches:
        """Caches that go on by themselves, for a thread: they are of one model at a time."""
        return Caches(*(copy(getattr(self, item.name)) for item in fields(self)))

    def known(self, key: Hashable, work: Callable[[], Found]) -> Found:
        """Result of `work`, cached by key."""
        return _remembered(self._known, key, work, MODELS)

    def delayed(self, clocks: Hashable, work: Callable[[], Found]) -> Found:
        """The runs by another clock of the reference."""
        return _remembered(self._delayed, clocks, work, DELAYS)

    def drive(self, robot: Hashable, work: Callable[[], Found]) -> Found:
        """Inputs of the effects for a robot."""
        return _remembered(self.drives, robot, work, DRIVES)

    def of_model(self, model: object, key: Hashable, work: Callable[[], Found]) -> Found:
        """Result of `work` for a model, of the size of the legs; cached for the last few models."""
        (found,) = self.each_of_model(model, [(key, work)], 0)
        return found

    def each_of_model(
        self, model: object, works: Sequence[tuple[Hashable, Callable[[], Found]]], steps: int
    ) -> list[Found]:
        """`of_model` for several keys, whose missing results are worked out side by side."""
        found = _results_of(self._of_models, model, MODELS)
        missing = {key: work for key, work in works if key not in found}
        found.update(zip(missing, side_by_side(list(missing.values()), steps), strict=True))
        return [found[key] for key, _ in works]

    def of_steps(self, model: object, key: Hashable, work: Callable[[], Found]) -> Found:
        """Result of `work` for a model, of the size of the steps; cached for the last model."""
        found = _results_of(self._of_steps, model, 1)
        if key not in found:
            found[key] = work()
        value: Found = found[key]
        return value

    def latest(self, of: tuple[object, ...], work: Callable[[], Found]) -> Found:
        """Result of `work`, cached while called with the identical objects."""
        if not self._latest or any(
            one is not other for one, other in zip(self._latest[0][0], of, strict=True)
        ):
            self._latest[:] = [(of, work())]
        value: Found = self._latest[0][1]
        return value

    def forget_steps(self) -> None:
        """Drop what is cached of the size of the steps, where a task needs the memory itself."""
        for each in (self.drives, self._delayed, self._of_steps):
            each.clear()


def _results_of(memory: OfModels, model: object, most: int) -> dict[Hashable, Any]:
    found = next((found for known, found in memory if known == model), None)
    if found is None:
        found = {}
        memory.append((model, found))
        del memory[:-most]
    return found


def _remembered(
    memory: dict[Hashable, Any], key: Hashable, work: Callable[[], Found], most: int
) -> Found:
    """Result of `work`, cached as the latest of `most`; the least recently used is dropped."""
    value: Found | None = memory.get(key)
    if value is None:
        value = work()
    with _REMEMBERING:
        memory.pop(key, None)
        while len(memory) >= most:
            del memory[next(iter(memory))]
        memory[key] = value
    return value


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
