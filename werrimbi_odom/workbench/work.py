# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What runs in a process of its own: it is told what to do, tells how far it is, sends what came.

It imports what is wanted first at once, while the drives are still being read, and the rest when
that is asked for.
"""

from __future__ import annotations

import io
import os
import pickle
import signal
from collections.abc import Mapping
from multiprocessing.connection import Connection
from types import MappingProxyType
from typing import Any, get_args

from werrimbi_odom.effects.collection import Collection, all_effects
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.recordings import Recordings
from werrimbi_odom.inference.comparison.reference_noise import Measure
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.progress import Show
from werrimbi_odom.workbench.job import Diagnose, Open, Task
from werrimbi_odom.workbench.opened import Opened, opened


def _read_only(values: dict[str, Any]) -> Mapping[str, Any]:
    return MappingProxyType(values)


class _Out(pickle.Pickler):
    def __init__(self, file: io.BytesIO, words: Mapping[int, str]) -> None:
        super().__init__(file, protocol=pickle.HIGHEST_PROTOCOL)
        self._words = words

    def persistent_id(self, thing: Any) -> tuple[str, str] | None:
        if isinstance(thing, Effect):
            return "effect", thing.name
        word = self._words.get(id(thing))
        return None if word is None else ("known", word)

    def reducer_override(self, thing: Any) -> Any:
        if isinstance(thing, MappingProxyType):  # a robot file's values; pickle has no word for it
            return _read_only, (dict(thing),)
        return NotImplemented


class _In(pickle.Unpickler):
    def __init__(self, file: io.BytesIO, collection: Collection, known: Mapping[str, Any]) -> None:
        super().__init__(file)
        self._collection, self._known = collection, known

    def persistent_load(self, pid: tuple[str, str]) -> Any:
        what, name = pid
        return self._collection.find(name) if what == "effect" else self._known[name]


def packed(value: Any, known: Mapping[str, Any]) -> bytes:
    """The value as bytes; `known` is what the other process has, by the words it knows it by."""
    file = io.BytesIO()
    _Out(file, {id(thing): word for word, thing in known.items()}).dump(value)
    return file.getvalue()


def unpacked(data: bytes, collection: Collection, known: Mapping[str, Any]) -> Any:
    """What `packed` made, from a process that we started ourselves."""
    return _In(io.BytesIO(data), collection, known).load()


def known_to_both(opened: Opened) -> Mapping[str, Any]:
    """What both processes cut alike, and need not send."""
    return {"train": opened.train, "holdout": opened.holdout}


def known_before(given: Recordings) -> Mapping[str, Any]:
    """What both have before anything is cut; a run that was looked at has the same columns."""
    there: dict[str, Any] = {"given": given}
    for number, run in enumerate((*given.runs, *given.holdout)):
        there[f"run {number}"] = run
        there[f"ticks {number}"] = run.ticks
        if run.reference is not None:
            there[f"reference {number}"] = run.reference
    return there


def left_there(opened: Opened) -> Mapping[str, Any]:
    """Most of what was cut: whoever compares cuts it himself, and the page does without."""
    there: dict[str, Any] = {}
    for side, drives in (("train", opened.train), ("holdout", opened.holdout)):
        there[f"{side} cuts"] = drives.cuts
        there |= {f"{side} {group.measure}": group.every for group in drives.groups}
    return there


NOT_SENT: Mapping[str, Any] = {
    f"{side} {what}": {} if what == "cuts" else None
    for side in ("train", "holdout")
    for what in ("cuts", *get_args(Measure))
}
"""What the page has for `left_there`."""


def work(asked: Connection) -> None:
    """In the worker: do what is asked, tell how far it is, send back what came of it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for who started us; he stops us
    try:
        import scipy.interpolate  # noqa: F401  # not later: it takes a good part of a second

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
        pass  # nobody waits any more


def _done(task: Task, given: Recordings, show: Show) -> bytes:
    """What came of it, packed."""
    if isinstance(task, Open):
        show(0.0, "matching ticks and reference")
        here = opened(given)
        look = here.look(given.source.robot, show)
        return packed((here, look), {**known_before(given), **left_there(here)})
    os.nice(5)  # the page stays quick
    from werrimbi_odom.workbench.verbs import added, diagnosed

    if isinstance(task, Diagnose):
        return packed(diagnosed(task, given, show), {})
    show(0.0, "opening")
    here = opened(given)
    return packed(added(task, here, show), known_to_both(here))
