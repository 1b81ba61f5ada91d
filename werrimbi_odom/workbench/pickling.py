# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""How tasks and results cross between the page's process and its worker.

What both have already is sent by name.
"""

from __future__ import annotations

import io
import pickle
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, get_args

from werrimbi_odom.effects.lookup import Collection
from werrimbi_odom.files.recordings import Recordings
from werrimbi_odom.inference.comparison.residuals import Measure
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.workbench.loaded_input import Opened


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
        if isinstance(thing, MappingProxyType):  # values of a robot file; not supported by pickle
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
    """Serialise a value; objects in `known` exist in the other process and are sent by name."""
    file = io.BytesIO()
    _Out(file, {id(thing): word for word, thing in known.items()}).dump(value)
    return file.getvalue()


def unpacked(data: bytes, collection: Collection, known: Mapping[str, Any]) -> Any:
    """Deserialise the output of `packed`, from our own process only."""
    return _In(io.BytesIO(data), collection, known).load()


def known_to_both(opened: Opened) -> Mapping[str, Any]:
    """Objects that both processes cut identically, and that need not be sent."""
    return {"train": opened.train, "holdout": opened.holdout}


def known_before(given: Recordings) -> Mapping[str, Any]:
    """Objects that both have before cutting; the arrays of a run are shared."""
    there: dict[str, Any] = {"given": given}
    for number, run in enumerate((*given.runs, *given.holdout)):
        there[f"run {number}"] = run
        there[f"ticks {number}"] = run.ticks
        if run.reference is not None:
            there[f"reference {number}"] = run.reference
    return there


def left_there(opened: Opened) -> Mapping[str, Any]:
    """Most results of the cutting, which the page does not need."""
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
"""Replacements on the page for `left_there`."""
