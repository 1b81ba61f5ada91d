# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Opens a bag (a rosbag2 folder, a single .mcap, .db3 or ROS 1 .bag) for reading, without ROS.

Topics that `rostopic echo -p` or bagpy wrote as text are read as one.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path, PurePath
from typing import Any, NamedTuple

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.bags.driver_messages import Types
from werrimbi_odom.files.bags.echoed_topics import (
    Parsed,
    echoed_files,
    echoed_messages,
    echoed_topic,
)
from werrimbi_odom.files.bags.several_bags import refuse_several
from werrimbi_odom.files.bags.standard_forms import kinds_as_read
from werrimbi_odom.files.bags.unfinished_bag import Raw, absolute, ending, of_message, raw_messages

ROS1 = ".bag"
SUFFIXES = (".mcap", ".db3", ROS1)
_STRETCH = 100
"""Messages in a row of a sample, for differences from each to the next."""
_BEGIN = (b"\x89MCAP0", b"SQLite format 3", b"#ROSBAG V")


class Topic(NamedTuple):
    """A topic of a bag, with at least one message."""

    name: str
    kind: str
    """Message type, as in `sensor_msgs/msg/JointState`, or that as which it is read (`FORMS`); if
    there are several, all of them joined."""
    messages: int


def topic_in_words(topic: Topic) -> str:
    """Name and type of a topic."""
    return f"{topic.name} ({topic.kind})"


class BagMessage(NamedTuple):
    """A message of a bag."""

    topic: str
    received: int
    """Time of recording [ns]."""
    content: Any


@dataclass(frozen=True)
class Bag:
    """An open bag."""

    path: Path
    topics: tuple[Topic, ...]
    damage: tuple[str, ...]
    """Damage that was worked around, in words for the user."""
    _raw: Callable[[Sequence[str]], Iterator[Raw]]
    _types: Types | Parsed

    def messages(self, topics: Sequence[str]) -> Iterator[BagMessage]:
        """The messages of some topics, in order of recording.

        InputError if a message cannot be read.
        """
        return self._stretches(topics, 1)

    def sampled(self, topic: str, most: int) -> Iterator[BagMessage]:
        """The messages of a topic, or about `most` in stretches spread over all of the bag.

        Others are not deserialised, which takes most of the time. InputError as in `messages`.
        """
        count = sum(each.messages for each in self.topics if each.name == topic)
        return self._stretches([topic], max(1, count // most))

    def _stretches(self, topics: Sequence[str], every: int) -> Iterator[BagMessage]:
        """One stretch of messages of each `every`."""
        try:
            for number, raw in enumerate(self._raw(topics)):
                if number // _STRETCH % every == 0:
                    yield BagMessage(raw.topic, raw.received, self._read(raw))
        except Exception as error:  # a damaged bag may raise anything, from struct to zstd
            raise _unreadable(self.path, error) from error

    def _read(self, raw: Raw) -> Any:
        try:
            return self._types.read(of_message(raw.data), raw.kind)
        except Exception as error:  # as above
            raise InputError(
                f"{self.path} cannot be read as a bag: a message of {raw.topic} ({raw.kind}): "
                f"{_in_a_line(error)}"
            ) from error

    def firsts(self, topics: Sequence[str]) -> dict[str, Any]:
        """First readable message of each topic, by topic name."""
        found = {}
        for topic in topics:
            with suppress(InputError, StopIteration):
                found[topic] = next(self.messages([topic])).content
        return found


@contextmanager
def opened_bag(path: Path) -> Iterator[Bag]:
    """Open a bag; it is closed at the end.

    A truncated bag is read up to the cut, and its `damage` says so. InputError if rosbags is not
    installed, or the bag cannot be opened.
    """
    echoed = [] if path.is_dir() and _files(path) else echoed_files(path)
    if echoed:
        yield _echoed(path, echoed)
        return
    try:
        from rosbags.rosbag1 import Reader as Reader1
        from rosbags.rosbag2 import Reader as Reader2
    except ModuleNotFoundError as missing:
        raise InputError(
            f"{path}: bags are read by the Python package {missing.name}: "
            'pip install "werrimbi_odom[tools]"'
        ) from missing
    ros1 = ending(path) == ROS1 and not path.is_dir()  # `ros2 bag record -o drive.bag`: a folder
    try:
        if path.is_dir():
            _refuse_repeated(path)
        reader: Any = (Reader1 if ros1 else Reader2)(path)
        reader.open()
        topics = _topics(
            (absolute(each.topic), each.msgtype, each.msgcount) for each in reader.connections
        )
        definitions = {each.msgtype: each.msgdef.data for each in reader.connections}
    except Exception as error:  # as above
        scanned = None
        if not isinstance(error, InputError) and _is_cut_off(path):
            refuse_several(path, _files(path))
            scanned = _scanned(path, ros1)
        if scanned is None:
            raise _unreadable(path, error) from error
        yield scanned
        return

    def raw(names: Sequence[str]) -> Iterator[Raw]:
        chosen = [each for each in reader.connections if absolute(each.topic) in names]
        for connection, received, data in reader.messages(connections=chosen) if chosen else ():
            topic = absolute(connection.topic)
            yield Raw(topic, connection.msgtype, received, data, "")

    try:
        yield Bag(path, topics, (), raw, Types(ros1, definitions))
    finally:
        reader.close()


def _echoed(path: Path, files: Sequence[Path]) -> Bag:
    """Topics that were written as text."""
    found = [echoed_topic(file) for file in files]
    damage = [
        f"{each.file.name}: {each.broken} of {each.broken + each.messages} rows have not the "
        "columns of its first line; left out"
        for each in found
        if each.broken
    ]

    def raw(names: Sequence[str]) -> Iterator[Raw]:
        return echoed_messages([each for each in found if each.name in names])

    topics = _topics((each.name, each.kind, each.messages) for each in found)
    return Bag(path, topics, tuple(damage), raw, Parsed())


def _topics(found: Iterable[tuple[str, str, int]]) -> tuple[Topic, ...]:
    """Topics with messages."""
    kinds: dict[str, dict[str, None]] = {}
    counts: Counter[str] = Counter()
    for name, kind, messages in found:
        if messages:
            kinds.setdefault(name, {})[kind] = None
            counts[name] += messages
    read = kinds_as_read([kind for each in kinds.values() for kind in each])
    kinds = {name: {read.get(kind, kind): None for kind in each} for name, each in kinds.items()}
    return tuple(Topic(name, " and ".join(each), counts[name]) for name, each in kinds.items())


def _scanned(path: Path, ros1: bool) -> Bag | None:
    """Read a truncated bag up to the cut; None if nothing is readable.

    The files of `rosbag record --split`, which have no metadata, are read so as well.
    """
    from rosbags.rosbag1 import Reader

    files = _files(path)
    split = path.is_dir() and all(ending(each) == ROS1 for each in files)
    counts: Counter[tuple[str, str]] = Counter()
    definitions: dict[str, str] = {}
    last = 0
    for each in raw_messages(files):
        counts[each.topic, each.kind] += 1
        definitions[each.kind] = each.definition
        last = max(last, each.received)
    if not counts:
        return None

    def raw(names: Sequence[str]) -> Iterator[Raw]:
        return (each for each in raw_messages(files) if each.topic in names)

    cut = f"the bag is cut off or was never finished; read up to t_s {last / 1e9:.1f}"
    damage = () if split and all(_is_whole(file, Reader) for file in files) else (cut,)
    topics = _topics((name, kind, number) for (name, kind), number in counts.items())
    return Bag(path, topics, damage, raw, Types(ros1 or split, definitions))


def _is_cut_off(path: Path) -> bool:
    """Whether a file of a bag is damaged or its metadata were never written."""
    from rosbags.rosbag2 import Reader

    if not path.is_dir() or not (path / "metadata.yaml").exists():
        return True
    return not all(_is_whole(file, Reader) for file in _files(path))


def _is_whole(file: Path, reader: Callable[[Path], Any]) -> bool:
    """Whether a reader opens a file: its end, or its index, is there."""
    try:
        with reader(file):
            return True
    except Exception:  # as above
        return False


def _files(path: Path) -> list[Path]:
    """Files of a bag, in order of recording."""
    if not path.is_dir():
        return [path]
    found = [each for each in path.iterdir() if ending(each) in SUFFIXES]
    return sorted(found, key=lambda each: (len(each.name), each.name))  # bag_9 before bag_10


def named_files(folder: Path) -> list[Path]:
    """Files that the metadata of a bag name, whether they are there or not."""
    from ruamel.yaml import YAML
    from ruamel.yaml.error import YAMLError

    with suppress(YAMLError, LookupError, TypeError):
        metadata = YAML(typ="safe").load(folder / "metadata.yaml")
        names = list(metadata["rosbag2_bagfile_information"]["relative_file_paths"])
        return [folder / PurePath(name).name for name in names]
    return []


def _refuse_repeated(folder: Path) -> None:
    """Raise if the metadata name a file repeatedly: it would be read as often.

    Other faults of the metadata are reported by rosbags.
    """
    seen: set[tuple[int, int]] = set()
    for file in filter(Path.exists, named_files(folder)):
        found = file.stat()
        if (found.st_dev, found.st_ino) in seen:
            name = file.name
            raise InputError(f"{folder / 'metadata.yaml'}: it names the file {name} more than once")
        seen.add((found.st_dev, found.st_ino))


def _unreadable(path: Path, error: Exception) -> InputError:
    if isinstance(error, InputError):
        return error
    ros1 = ending(path) == ROS1
    tools = "`rosbag reindex`" if ros1 else "`mcap recover`, or `ros2 bag reindex`"
    hint = f"a recording cut off in mid-file: {tools}"
    with suppress(OSError), path.open("rb") as file:  # a folder cannot be opened
        if not file.read(16).startswith(_BEGIN):
            hint = "it does not begin as an MCAP, SQLite or ROS 1 bag does"
    return InputError(f"{path} cannot be read as a bag: {_in_a_line(error)} ({hint})")


def _in_a_line(error: Exception) -> str:
    return " ".join(str(error).split())[:300] or type(error).__name__


def stamp_of(message: BagMessage, header: Any = None) -> float:
    """Stamp of the header [s]; the time of recording if that is zero."""
    stamp = (message.content if header is None else header).header.stamp
    nanoseconds = stamp.sec * 10**9 + stamp.nanosec
    return float((nanoseconds or message.received) / 1e9)


def left_out_words(left_out: Counter[str]) -> list[str]:
    """Numbers of skipped messages, with the reason."""
    return [f"left out: {count} messages {why}" for why, count in left_out.items() if count]
