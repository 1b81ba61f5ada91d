# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Reads topics that were written as text: `rostopic echo -p /odom > odom.csv`, a file each.

The first line names the fields of the message: `%time,field.header.seq,field.header.stamp,...`. The
topic is named as its file, and its type is told by the fields. What bagpy and rosbag_to_csv write
is read as well: `Time,header.seq,header.stamp.secs,...`, with arrays in one cell or as `ranges_0`.
Some end the file's name in `.txt`.
"""

from __future__ import annotations

import csv
import re
from codecs import BOM_UTF8
from collections.abc import Iterator, Sequence
from heapq import merge
from operator import attrgetter
from pathlib import Path
from types import SimpleNamespace
from typing import Any, NamedTuple

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.bags.unfinished_bag import Raw

SUFFIXES = (".csv", ".txt")
"""Ends of the names of such files."""
LONGEST_CELL = 2**31 - 1
"""Characters, as many as C can count: bagpy writes an image into one cell."""
_FIRST = "%time"
_STAMP = ("header.stamp.secs", "header.stamp.nsecs")
"""Columns by which the text of other programs is known, whose first is `Time` or `time`."""
_OF_STAMP = {"secs": "sec", "nsecs": "nanosec"}
_INTEGERS, _FLOATS = "std_msgs/msg/Int64MultiArray", "std_msgs/msg/Float64MultiArray"
_KINDS = {
    "nav_msgs/msg/Odometry": ("pose.pose.position.x", "twist.twist.linear.x"),
    "geometry_msgs/msg/PoseWithCovarianceStamped": ("pose.pose.position.x", "pose.covariance0"),
    "geometry_msgs/msg/PoseStamped": ("header.stamp", "pose.position.x"),
    "geometry_msgs/msg/TransformStamped": ("header.stamp", "transform.translation.x"),
    "tf2_msgs/msg/TFMessage": ("transforms0.transform.translation.x",),
    "geometry_msgs/msg/PointStamped": ("header.stamp", "point.x"),
    "geometry_msgs/msg/Pose2D": ("x", "y", "theta"),
    "sensor_msgs/msg/Imu": ("angular_velocity.z", "linear_acceleration.x"),
    "sensor_msgs/msg/LaserScan": ("ranges0", "angle_increment"),
    "sensor_msgs/msg/NavSatFix": ("latitude", "longitude", "status.status"),
    "sensor_msgs/msg/JointState": ("header.stamp", "name0"),
    "turtlebot3_msgs/msg/SensorState": ("left_encoder", "right_encoder", "torque"),
    "kobuki_msgs/msg/SensorState": ("left_encoder", "right_encoder", "time_stamp"),
    "irobot_create_msgs/msg/WheelTicks": ("ticks_left", "ticks_right"),
    "duckietown_msgs/msg/WheelEncoderStamped": ("header.stamp", "data", "resolution"),
    _INTEGERS: ("layout.data_offset", "data0"),
    "std_msgs/msg/Int64": ("data",),
}
"""Fields by which a type is told; the first of which all are there."""
_ARRAYS = ("position", "velocity", "effort")
"""Arrays that may be empty, and then have no column."""


class EchoedTopic(NamedTuple):
    """A file of one topic."""

    file: Path
    name: str
    kind: str
    """Message type; "unknown" if its fields tell none."""
    fields: tuple[tuple[str, ...], ...]
    """Path of each column within the message."""
    messages: int
    broken: int
    """Rows that do not have the columns of the first line."""


def echoed_files(path: Path) -> list[Path]:
    """Files of such topics: the path itself, or what it holds."""
    files = sorted(path.iterdir()) if path.is_dir() else [path]
    return [
        each
        for each in files
        if each.suffix.lower() in SUFFIXES and each.is_file() and _begins(each)
    ]


def _begins(file: Path) -> bool:
    with file.open("rb") as opened:
        if opened.read(len(_FIRST) + 3).removeprefix(BOM_UTF8).startswith(_FIRST.encode()):
            return True
    first = next(_rows(file), [])
    return first[:1] in (["Time"], ["time"]) and set(_fields(first)).issuperset(_STAMP)


def _fields(first: Sequence[str]) -> list[str]:
    """Names of the columns after the first, as `rostopic` writes them."""
    names = (each.strip().removeprefix("field.").removeprefix(".") for each in first[1:])
    return [re.sub(r"_(\d+)$", r"\1", each) for each in names]


def echoed_topic(file: Path) -> EchoedTopic:
    """Read the first line of a file, and count its rows."""
    rows = _rows(file)
    header = _fields(next(rows))
    names, counts, whole = set(header), list[bool](), True
    values = [place for place, name in enumerate(header, start=1) if re.fullmatch(r"data\d+", name)]
    for row in rows:
        whole = whole and not any("." in row[place] for place in values if place < len(row))
        if not counts:  # an array in one cell has a first item as well
            names |= {
                f"{name}0" for name, cell in zip(header, row[1:], strict=False) if _many(cell)
            }
        counts.append(len(row) == len(header) + 1)
    if names.issuperset(_STAMP):
        names.add("header.stamp")
    kind = next((kind for kind, own in _KINDS.items() if names.issuperset(own)), "unknown")
    if kind == "std_msgs/msg/Int64" and len(header) > 1:
        kind = "unknown"
    if kind == _INTEGERS and not whole:
        kind = _FLOATS
    fields = tuple(tuple(each.split(".")) for each in header)
    return EchoedTopic(file, f"/{file.stem}", kind, fields, sum(counts), counts.count(False))


def echoed_messages(topics: Sequence[EchoedTopic]) -> Iterator[Raw]:
    """Yield the messages of some topics, in order of receipt; `data` is the message itself.

    InputError at a time that is none.
    """
    return merge(*map(_messages, topics), key=attrgetter("received"))


class _NoColumnError(InputError, AttributeError):
    """A field without a column; an AttributeError to those who ask whether it is there."""


class _Fields(SimpleNamespace):
    """Fields of a message, or of a part of it. `place`: file, and path of the part."""

    def __init__(self, place: str, **fields: Any) -> None:
        super().__init__(_place=place, **fields)

    def __getattr__(self, name: str) -> Any:
        raise _NoColumnError(
            f"{self._place}{name}: there is no such column, and it is needed; write all fields of "
            "the messages, as `rostopic echo -p` does"
        )


class Parsed:
    """Stands for the types of a bag: these messages are read already."""

    def read(self, data: Any, kind: str) -> Any:
        """Return the message."""
        return data


def _rows(file: Path) -> Iterator[list[str]]:
    csv.field_size_limit(LONGEST_CELL)  # of the whole process; a table of numbers needs none
    with file.open(encoding="utf-8-sig", errors="replace", newline="") as opened:
        first: list[str] = []
        for row in csv.reader(line.replace("\0", "") for line in opened):
            if row and row != first:  # one echo after another into a file: names once more
                yield row
            first = first or row


def _messages(topic: EchoedTopic) -> Iterator[Raw]:
    rows = _rows(topic.file)
    next(rows)
    for row in rows:
        if len(row) == len(topic.fields) + 1:
            place = f"{topic.file}, column "
            message = _Fields(place, **{name: [] for name in _ARRAYS})
            for path, cell in zip(topic.fields, row[1:], strict=True):
                _put(message, path, cell, topic.file)
            yield Raw(topic.name, topic.kind, _received(topic.file, row[0], message), message, "")


def _received(file: Path, cell: str, message: Any) -> int:
    """When a message came [ns]: whole ns, or seconds; of a date, its stamp."""
    stamp = getattr(getattr(message, "header", None), "stamp", None)
    if cell.strip().isdecimal() or stamp is None:
        return _nanoseconds(file, _FIRST, cell)
    try:
        return round(float(cell) * 1e9)
    except ValueError:
        return int(stamp.sec * 10**9 + stamp.nanosec)


def _nanoseconds(file: Path, name: str, cell: str) -> int:
    if not cell.strip().isdecimal():
        raise InputError(f"{file}, column {name}: {cell!r} is no time in nanoseconds")
    return int(cell)


def _put(message: Any, path: Sequence[str], cell: str, file: Path) -> None:
    """Set a field of a message; `covariance7` and `transforms0` are items of a list."""
    *parts, last = path
    for part in parts:
        message = _within(message, part)
    if parts[-1:] == ["stamp"]:
        name = ".".join(path)
        setattr(message, _OF_STAMP.get(last, last), _nanoseconds(file, name, cell))
        return
    if last == "stamp":
        seconds, rest = divmod(_nanoseconds(file, ".".join(path), cell), 10**9)
        message.stamp = SimpleNamespace(sec=seconds, nanosec=rest)
        return
    array = last.rstrip("0123456789")
    if _many(cell):
        setattr(message, last, [_value(last, each) for each in _items(cell)])
    elif array != last:
        if not hasattr(message, array):
            setattr(message, array, [])
        getattr(message, array).append(_value(array, cell))
    else:
        setattr(message, last, _value(last, cell))


def _within(message: Any, part: str) -> Any:
    array = part.rstrip("0123456789")
    if array == part:
        if not hasattr(message, part):
            setattr(message, part, _Fields(f"{message._place}{part}."))
        return getattr(message, part)
    if not hasattr(message, array):
        setattr(message, array, [])
    items = getattr(message, array)
    if int(part[len(array) :]) == len(items):
        items.append(_Fields(f"{message._place}{part}."))
    return items[-1]


def _many(cell: str) -> bool:
    """Whether a cell holds an array, as Python writes a tuple or a list."""
    return cell[:1] + cell[-1:] in ("()", "[]")


def _items(cell: str) -> list[str]:
    return [each.strip().strip("'\"") for each in cell[1:-1].split(",") if each.strip()]


def _value(name: str, cell: str) -> Any:
    if name == "name" or name.endswith("frame_id"):
        return cell
    try:
        return float(cell)
    except ValueError:
        return cell
