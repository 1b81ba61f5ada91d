# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Reads unfinished bags (a killed recorder, a power failure) from the beginning.

The index is at the end of a bag, so a truncated one has none. The messages are stored in order of
recording; they are read up to the first damage.
"""

from __future__ import annotations

import bz2
import io
import sqlite3
import struct
from collections.abc import Callable, Iterator, Sequence
from importlib import import_module
from pathlib import Path, PurePath
from typing import IO, Any, NamedTuple

from werrimbi_odom.files.bags.unfinished_sqlite import described, rows_of

MCAP_MAGIC = b"\x89MCAP0\r\n"
ROS1_MAGIC = b"#ROSBAG V2.0\n"
LARGEST = 2**30
"""Largest record [bytes]; a greater length is damage."""


class Raw(NamedTuple):
    """A message as stored in a file."""

    topic: str
    kind: str
    received: int
    """[ns]"""
    data: Any
    """Its bytes, or itself if it was written as text."""
    definition: str
    """Definition of its type; "" if the file has none."""


def absolute(topic: str) -> str:
    """Absolute topic name; ROS 1 recorders store names as typed."""
    return "/" + topic.strip("/")


def ending(file: Path) -> str:
    """End of a bag's name: `.bag` in any case, and of one that `rosbag record` has not closed."""
    low = PurePath(file.name.lower().removesuffix(".active")).suffix
    return low if low == ".bag" else file.suffix


def of_message(data: Any) -> Any:
    """A message's bytes, without the compression of each message by `ros2 bag record`.

    The metadata tell of it, and may be missing; neither CDR nor text begins so.
    """
    if isinstance(data, bytes | memoryview) and bytes(data[:4]) == _ZSTD:
        return _decompressor("zstd").decompress(data, LARGEST)
    return data


_ZSTD = b"\x28\xb5\x2f\xfd"


class SpoiltError(Exception):
    """A file ends in mid-record, or contains an invalid record."""


def raw_messages(files: Sequence[Path]) -> Iterator[Raw]:
    """Yield the messages of successive files, each up to its damage."""
    for file in files:
        scan = _SCANS[ending(file)]
        try:
            yield from scan(file)
        except (SpoiltError, sqlite3.Error, struct.error, OSError, ValueError, LookupError):
            continue


def _mcap(file: Path) -> Iterator[Raw]:
    with file.open("rb") as stream:
        if stream.read(8) != MCAP_MAGIC:
            raise SpoiltError
        yield from _mcap_records(stream, {}, {})


def _mcap_records(
    stream: IO[bytes], schemas: dict[int, tuple[str, str]], channels: dict[int, tuple[str, int]]
) -> Iterator[Raw]:
    while head := stream.read(9):
        code, length = struct.unpack("<BQ", head)
        body = _exactly(stream, length, cut=code == _CHUNK)
        if code == 0x03:
            (key,), rest = struct.unpack_from("<H", body), body[2:]
            name, rest = _text(rest)
            _, rest = _text(rest)
            schemas[key] = (name, _text(rest)[0])
        elif code == 0x04:
            key, schema = struct.unpack_from("<HH", body)
            channels[key] = (_text(body[4:])[0], schema)
        elif code == 0x05:
            key, _, received = struct.unpack_from("<HIQ", body)
            topic, schema = channels[key]
            kind, definition = schemas[schema]
            yield Raw(topic, kind, received, body[22:], definition)
        elif code == _CHUNK:
            size, _ = struct.unpack_from("<QI", body, 16)
            compression, rest = _text(body[28:])
            inside = _decompressed(rest[8:], compression, size)
            yield from _mcap_records(io.BytesIO(inside), schemas, channels)
        elif code in (0x0F, 0x02):
            return  # end of the data, or the footer


_CHUNK = 0x06


def _text(body: bytes) -> tuple[str, bytes]:
    (length,) = struct.unpack_from("<I", body)
    if 4 + length > len(body):
        raise SpoiltError
    return body[4 : 4 + length].decode("utf-8", "replace"), body[4 + length :]


def _decompressed(data: bytes, compression: str, size: int) -> bytes:
    if not compression:
        return data
    if size > LARGEST:
        raise SpoiltError
    try:
        return bytes(_decompressor(compression).decompress(data, size))
    except Exception as error:  # each library has its own exception
        raise SpoiltError from error


def _decompressor(compression: str) -> Any:
    """Decompressor with a size limit that also returns the data before a cut; one interface."""
    if compression == "bz2":
        return bz2.BZ2Decompressor()
    if compression == "lz4":
        from lz4.frame import LZ4FrameDecompressor

        return LZ4FrameDecompressor()
    if compression != "zstd":
        raise SpoiltError
    try:
        zstd = import_module("compression.zstd")  # from Python 3.14 on
    except ModuleNotFoundError:
        zstd = import_module("backports.zstd")
    return zstd.ZstdDecompressor()


def _ros1(file: Path) -> Iterator[Raw]:
    with file.open("rb") as stream:
        if stream.readline() != ROS1_MAGIC:
            raise SpoiltError
        yield from _ros1_records(stream, {})


def _ros1_records(stream: IO[bytes], connections: dict[int, tuple[str, str, str]]) -> Iterator[Raw]:
    from rosbags.typesys.msg import normalize_msgtype

    while head := stream.read(4):
        fields = _fields(_exactly(stream, *struct.unpack("<I", head)))
        code = fields["op"][0]
        (length,) = struct.unpack("<I", _exactly(stream, 4))
        data = _exactly(stream, length, cut=code == 5)
        if code == 7:
            told = _fields(data)
            kind = normalize_msgtype(told["type"].decode())
            names = (fields["topic"].decode(), kind, told["message_definition"].decode())
            connections[struct.unpack("<I", fields["conn"])[0]] = names
        elif code == 2:
            topic, kind, definition = connections[struct.unpack("<I", fields["conn"])[0]]
            seconds, nanoseconds = struct.unpack("<II", fields["time"])
            received = seconds * 10**9 + nanoseconds
            yield Raw(absolute(topic), kind, received, data, definition)
        elif code == 5:
            size = struct.unpack("<I", fields["size"])[0]
            compression = fields["compression"].decode().replace("none", "")
            inside = _decompressed(data, compression, size)
            yield from _ros1_records(io.BytesIO(inside), connections)


def _fields(header: bytes) -> dict[str, bytes]:
    found, at = {}, 0
    while at < len(header):
        (length,) = struct.unpack_from("<I", header, at)
        name, _, value = header[at + 4 : at + 4 + length].partition(b"=")
        found[name.decode()] = value
        at += 4 + length
    return found


def _exactly(stream: IO[bytes], length: int, cut: bool = False) -> bytes:
    """Read `length` bytes; fewer only if `cut` is true."""
    if length > LARGEST:
        raise SpoiltError
    found = stream.read(length)
    if len(found) < length and not cut:
        raise SpoiltError
    return found


def _sqlite(file: Path) -> Iterator[Raw]:
    topics, definitions = described(file)
    for key, received, data in rows_of(file):
        if key in topics:
            topic, kind = topics[key]
            yield Raw(topic, kind, received, data, definitions.get(kind, ""))


_SCANS: dict[str, Callable[[Path], Iterator[Raw]]] = {
    ".mcap": _mcap,
    ".db3": _sqlite,
    ".bag": _ros1,
}
