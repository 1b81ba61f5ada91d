# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A ROS 2 bag (a rosbag2 folder, a single .mcap or .db3) opened for reading, without ROS."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path, PurePath
from typing import Any, NamedTuple

from werrimbi_odom.errors import InputError

SUFFIXES = (".mcap", ".db3")


class Topic(NamedTuple):
    """A topic of a bag that has messages."""

    name: str
    kind: str
    """Message type, as in `sensor_msgs/msg/JointState`."""
    messages: int


def topic_in_words(topic: Topic) -> str:
    """Its name and its type."""
    return f"{topic.name} ({topic.kind})"


class Message(NamedTuple):
    """A message of a bag."""

    topic: str
    received: int
    """When the recorder got it [ns]."""
    content: Any


@dataclass(frozen=True)
class Bag:
    """An open bag."""

    path: Path
    topics: tuple[Topic, ...]
    _reader: Any
    _types: Any

    def messages(self, topics: Sequence[str]) -> Iterator[Message]:
        """Messages of some topics, in the order in which they were received.

        Raises
        ------
        InputError
            When a message cannot be read.
        """
        chosen = [each for each in self._reader.connections if each.topic in topics]
        try:
            for connection, received, data in self._reader.messages(connections=chosen):
                content = self._types.deserialize_cdr(data, connection.msgtype)
                yield Message(connection.topic, received, content)
        except Exception as error:  # a damaged bag raises anything, from struct to zstd
            raise _unreadable(self.path, error) from error


@contextmanager
def opened_bag(path: Path) -> Iterator[Bag]:
    """Open a bag, and close it at the end.

    Message types are the standard ones of ROS 2 Jazzy; those that odometry needs have been the same
    in every distribution, so definitions in the bag, which may be broken, are not looked at.

    Raises
    ------
    InputError
        When rosbags is not installed, or the bag cannot be opened.
    """
    try:
        from rosbags.rosbag2 import Reader
        from rosbags.typesys import Stores, get_typestore
    except ModuleNotFoundError as missing:
        raise InputError(
            f"{path}: bags are read by the Python package {missing.name}: "
            'pip install "werrimbi_odom[tools]"'
        ) from missing
    reader = None
    try:
        if path.is_dir():
            _refuse_repeated(path)
        reader = Reader(path)
        reader.open()
        found = reader.topics.items()
        topics = tuple(
            Topic(name, info.msgtype, info.msgcount)
            for name, info in found
            if info.msgtype is not None and info.msgcount > 0
        )
    except Exception as error:  # as above
        raise _unreadable(path, error) from error
    try:
        yield Bag(path, topics, reader, get_typestore(Stores.ROS2_JAZZY))
    finally:
        reader.close()


def _refuse_repeated(folder: Path) -> None:
    """A file that the metadata name a thousand times would be read a thousand times.

    What else is wrong with the metadata, rosbags says.
    """
    from ruamel.yaml import YAML
    from ruamel.yaml.error import YAMLError

    names: list[str] = []
    with suppress(YAMLError, LookupError, TypeError):
        metadata = YAML(typ="safe").load(folder / "metadata.yaml")
        names = list(metadata["rosbag2_bagfile_information"]["relative_file_paths"])
    seen: set[tuple[int, int]] = set()
    for name in names:
        file = folder / PurePath(name).name
        if not file.exists():
            continue
        found = file.stat()
        if (found.st_dev, found.st_ino) in seen:
            raise InputError(f"{folder / 'metadata.yaml'}: it names the file {name} more than once")
        seen.add((found.st_dev, found.st_ino))


def _unreadable(path: Path, error: Exception) -> InputError:
    if isinstance(error, InputError):
        return error
    problem = " ".join(str(error).split())[:300] or type(error).__name__
    return InputError(
        f"{path} cannot be read as a bag: {problem} (a recording cut off in mid-file: "
        "`mcap recover`, or `ros2 bag reindex`)"
    )
