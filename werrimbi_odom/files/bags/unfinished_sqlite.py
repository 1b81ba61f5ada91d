# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Messages of a truncated sqlite3 bag, page by page.

SQLite finds rows through pages anywhere in the file, and therefore cannot read a truncated table.
The rows themselves are in consecutive leaf pages. Format: https://www.sqlite.org/fileformat2.html,
sections 1.5, 1.6 and 2.1.
"""

from __future__ import annotations

import mmap
import sqlite3
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

LEAF = 0x0D
"""First byte of a leaf page with rows of a table."""
MOST = 10_000
"""Largest plausible number of topics."""


class MessageRow(NamedTuple):
    """A row of the messages table."""

    topic: int
    received: int
    """[ns]"""
    data: bytes


def described(file: Path) -> tuple[dict[int, tuple[str, str]], dict[str, str]]:
    """Name and type of each topic by its number, and the definition of each type."""
    database = sqlite3.connect(f"{file.resolve().as_uri()}?immutable=1", uri=True)
    try:
        # Needed to read a file that is shorter than its header states.
        database.execute("PRAGMA writable_schema=ON")
        found = database.execute("SELECT name FROM sqlite_master WHERE type = 'table' LIMIT 100")
        tables = {name for (name,) in found}  # a view may be a program that never ends
        if "topics" not in tables:
            return {}, {}
        rows = database.execute(f"SELECT id, name, type FROM topics LIMIT {MOST}")
        topics = {key: (name, kind) for key, name, kind in rows}
        definitions: dict[str, str] = {}
        if "message_definitions" in tables:  # from ROS 2 Iron on
            with suppress(sqlite3.Error):
                definitions.update(
                    database.execute(
                        "SELECT topic_type, encoded_message_definition FROM message_definitions "
                        f"LIMIT {MOST}"
                    )
                )
        return topics, definitions
    finally:
        database.close()


def rows_of(file: Path) -> Iterator[MessageRow]:
    """Yield messages in order of writing; truncated ones are skipped."""
    with file.open("rb") as stream, mmap.mmap(stream.fileno(), 0, access=mmap.ACCESS_READ) as held:
        pages = _Pages(held)
        for _, place in sorted(pages.cells()):
            row = pages.row(place)
            if row is not None:
                yield row


class _Pages:
    def __init__(self, held: mmap.mmap) -> None:
        self._held = held
        size = int.from_bytes(held[16:18], "big")
        self._size = 65536 if size == 1 else max(size, 512)
        self._usable = self._size - held[20]

    def cells(self) -> Iterator[tuple[int, int]]:
        """Yield the number of each row, and the position of its payload length."""
        for start in range(0, len(self._held), self._size):
            head = start + (100 if start == 0 else 0)
            if self._held[head] != LEAF or head + 8 > len(self._held):
                continue
            count = int.from_bytes(self._held[head + 3 : head + 5], "big")
            for at in range(head + 8, min(head + 8 + 2 * count, start + self._size), 2):
                place = start + int.from_bytes(self._held[at : at + 2], "big")
                if place < min(start + self._size, len(self._held)) - 8:
                    yield self._number(self._number(place)[1])[0], place

    def row(self, place: int) -> MessageRow | None:
        """Parse a row of four columns (number, topic, time, bytes); None for other rows."""
        length, at = self._number(place)
        payload = self._payload(length, self._number(at)[1])
        if payload is None:
            return None
        size, at = _varint(payload, 0)
        kinds = []
        while at < size:
            kind, at = _varint(payload, at)
            kinds.append(kind)
        if len(kinds) != 4 or kinds[0] != 0 or kinds[3] < 12 or kinds[3] % 2:
            return None
        numbers = []
        for kind in kinds[1:3]:
            if kind not in _WIDTHS:
                return None
            width = _WIDTHS[kind]
            numbers.append(int.from_bytes(payload[at : at + width], "big", signed=True))
            at += width
            numbers[-1] = {8: 0, 9: 1}.get(kind, numbers[-1])
        return MessageRow(numbers[0], numbers[1], payload[at : at + (kinds[3] - 12) // 2])

    def _payload(self, length: int, at: int) -> bytes | None:
        """Bytes of a row, including overflow pages; None if some are missing."""
        if length > len(self._held):
            return None
        most = self._usable - 35
        if length <= most:
            row = self._held[at : at + length]
            return row if len(row) == length else None
        least = (self._usable - 12) * 32 // 255 - 23
        here = least + (length - least) % (self._usable - 4)
        here = here if here <= most else least
        found = bytearray(self._held[at : at + here])
        page = int.from_bytes(self._held[at + here : at + here + 4], "big")
        while page and len(found) < length:
            start = (page - 1) * self._size
            block = self._held[start : start + self._usable]
            if len(block) < 4:
                return None
            page = int.from_bytes(block[:4], "big")
            found += block[4:]
        return bytes(found[:length]) if len(found) >= length else None

    def _number(self, at: int) -> tuple[int, int]:
        return _varint(self._held, at)


_WIDTHS = {1: 1, 2: 2, 3: 3, 4: 4, 5: 6, 6: 8, 8: 0, 9: 0}
"""Size in bytes of an integer by its serial type."""


def _varint(held: bytes | mmap.mmap, at: int) -> tuple[int, int]:
    """Read a varint of one to nine bytes; also return the position after it."""
    value = 0
    for index in range(9):
        byte = held[at + index]
        if index == 8:
            return (value << 8) | byte, at + 9
        value = (value << 7) | (byte & 0x7F)
        if byte < 0x80:
            return value, at + index + 1
    raise AssertionError
