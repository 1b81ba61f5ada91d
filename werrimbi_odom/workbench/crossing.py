# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Values to another process and back.

Effects hold functions, which do not travel: their names do, and both processes know the same
effects. What both have open already travels as a word too.
"""

from __future__ import annotations

import io
import pickle
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from werrimbi_odom.effects.collection import Collection
from werrimbi_odom.model.effect import Effect


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
