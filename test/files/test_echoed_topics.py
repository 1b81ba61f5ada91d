# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Topics as `rostopic echo -p` or bagpy writes them are read as the bag of the same messages is."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Sequence
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.run import Run

MS = 10**6
WHEELS = ["left_wheel_joint", "right_wheel_joint"]


def cells(message: Any, path: str = "field") -> Iterator[tuple[str, Any]]:
    """Name and text of each field, as ROS 1 names them."""
    if type(message).__name__.endswith("msg__Time"):
        yield path, message.sec * 10**9 + message.nanosec
    elif is_dataclass(message):
        for each in fields(message):
            if not each.name.startswith("__"):
                yield from cells(getattr(message, each.name), f"{path}.{each.name}")
    elif isinstance(message, list | np.ndarray):
        for number, item in enumerate(message):
            yield from cells(item, f"{path}{number}")
    else:
        yield path, message


def echoed(folder: Path, entries: Sequence[tuple[str, int, tuple[str, Any]]]) -> Path:
    """Write each topic to a file of its name."""
    folder.mkdir()
    for topic in {name for name, *_ in entries}:
        rows = [(at, dict(cells(message))) for name, at, (_, message) in entries if name == topic]
        with (folder / f"{topic.strip('/')}.csv").open("w", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(["%time", *rows[0][1]])
            writer.writerows([at, *row.values()] for at, row in rows)
    return folder


def of_bagpy(message: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """The same as bagpy names them: arrays in columns, or those deeper down in one cell."""
    for each in fields(message):
        if each.name.startswith("__"):
            continue
        name, value = f"{path}{each.name}", getattr(message, each.name)
        if type(value).__name__.endswith("msg__Time"):
            yield from ((f"{name}.secs", value.sec), (f"{name}.nsecs", value.nanosec))
        elif is_dataclass(value):
            yield from of_bagpy(value, f"{name}.")
        elif isinstance(value, np.ndarray) and not path:
            yield from ((f"{name}_{number}", item) for number, item in enumerate(value))
        else:
            yield name, tuple(value.tolist()) if isinstance(value, np.ndarray) else value


def by_bagpy(folder: Path, entries: Sequence[tuple[str, int, tuple[str, Any]]], dot: str) -> Path:
    """Write each topic to a file of its name; `dot` is before the names of rosbag_to_csv."""
    folder.mkdir()
    for topic in {name for name, *_ in entries}:
        rows = [(at, dict(of_bagpy(seen))) for name, at, (_, seen) in entries if name == topic]
        with (folder / f"{topic.strip('/')}.csv").open("w", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(["time" if dot else "Time", *(f"{dot}{name}" for name in rows[0][1])])
            date = "2001/09/09/03:46:40.000000"
            for at, row in rows:
                writer.writerow([date if dot else f"{1e-9 * at:.9f}", *row.values()])
    return folder


def same(one: Run, other: Run) -> None:
    assert one.reference is not None
    assert other.reference is not None
    for name in ("time", "left", "right"):
        assert getattr(one.ticks, name) == pytest.approx(getattr(other.ticks, name), abs=1e-9)
    for name in ("time", "x", "y", "yaw"):
        found, wanted = getattr(one.reference, name), getattr(other.reference, name)
        assert found == pytest.approx(wanted, abs=1e-9, nan_ok=True)
    assert one.notes == other.notes


def drive(ros: Any, number: int) -> list[Any]:
    """The wheels of a robot on a circle, and one of what may measure it."""
    entries = []
    for n in range(60):
        at, yaw = n * 50 * MS + 10**18, 0.02 * n
        x, y = 2.0 * np.sin(yaw), 2.0 - 2.0 * np.cos(yaw)
        wheels = ros.joints(at, WHEELS, [0.7 * n, 0.9 * n]), ros.odometry(at, x, y, yaw)
        frames = ("map", "odom"), ("odom", "base_link")
        measured = (
            ("/pose", ros.pose(at + MS, x, y, yaw)),
            ("/imu", ros.imu(at + MS, 0.4)),
            ("/amcl_pose", ros.pose_with_covariance(at + MS, x, y, yaw, [1e-4, 1e-4, 1e-5])),
            ("/fix", ros.fix(at + MS, (50.0 + 1e-5 * x, 10.0 + 1e-5 * y))),
            (
                "/tf",
                ros.transforms(
                    ros.transform(at + MS, frames[0], 0.01 * np.sin(n), 0.02, 0.001),
                    ros.transform(at + MS, frames[1], x, y, yaw),
                ),
            ),
        )[number]
        entries.append(("/odom" if number == 2 else "/joint_states", at, wheels[number == 2]))
        entries.append((measured[0], at + 2 * MS, measured[1]))
    return entries


@pytest.mark.parametrize("number", range(5))
def test_topics_as_text_are_those_of_the_bag(
    tmp_path: Path, ros: Any, robot: Any, number: int
) -> None:
    entries = drive(ros, number)
    bag, text = ros.write(tmp_path / "bag", entries), echoed(tmp_path / "text", entries)
    topic = "/tf:map:base_link" if number == 4 else None
    same(*(read_run(path, robot(), reference_topic=topic) for path in (text, bag)))


def test_files_may_end_in_txt(tmp_path: Path, ros: Any, robot: Any) -> None:
    entries = drive(ros, 0)
    named, text = echoed(tmp_path / "csv", entries), echoed(tmp_path / "text", entries)
    for file in text.iterdir():
        file.rename(file.with_suffix(".txt"))
    same(*(read_run(path, robot()) for path in (text, named)))


def test_a_byte_order_mark_a_capital_end_and_names_once_more(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    """Saved again by an editor; and two echoes, one after the other, into one file."""
    entries = drive(ros, 0)
    plain, text = echoed(tmp_path / "csv", entries), echoed(tmp_path / "text", entries)
    wheels = text / "joint_states.csv"
    first, *rows = wheels.read_text().splitlines(keepends=True)
    told = [first, *rows[:30], first, *rows[30:]]
    (text / "joint_states.CSV").write_text("".join(told), encoding="utf-8-sig")
    wheels.unlink()
    same(*(read_run(path, robot()) for path in (text, plain)))


@pytest.mark.parametrize("kind", ["counts", "floats"])
def test_arrays_of_counters(tmp_path: Path, ros: Any, robot: Any, kind: str) -> None:
    """Of two whole numbers both are counters; of floats those that run on as counters do."""
    entries = [
        (
            "/encoders",
            n * 50 * MS + 10**18,
            getattr(ros, kind)(round(300 * np.sin(0.02 * n)), round(200 * np.sin(0.03 * n))),
        )
        for n in range(300)
    ]
    text = echoed(tmp_path / "text", entries)
    run = read_run(text, robot())
    assert run.ticks.left.tolist() == [round(300 * np.sin(0.02 * n)) for n in range(300)]
    assert run.ticks.right.tolist() == [round(200 * np.sin(0.03 * n)) for n in range(300)]
    assert f"std_msgs/msg/{'Int' if kind == 'counts' else 'Float'}64MultiArray" in run.notes[0]


@pytest.mark.parametrize("dot", ["", "."])
@pytest.mark.parametrize("number", range(4))
def test_what_bagpy_writes_is_the_bag(
    tmp_path: Path, ros: Any, robot: Any, number: int, dot: str
) -> None:
    entries = drive(ros, number)
    bag, text = ros.write(tmp_path / "bag", entries), by_bagpy(tmp_path / "text", entries, dot)
    same(*(read_run(path, robot()) for path in (text, bag)))


def test_an_image_in_one_cell_and_a_binary_file_beside_them(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    entries = drive(ros, 0)
    text = by_bagpy(tmp_path / "text", entries, "")
    whole = read_run(text, robot())
    image = "0, " * 100_000  # as bagpy writes its data
    head = "Time,header.seq,header.stamp.secs,header.stamp.nsecs,data"
    (text / "image.csv").write_text(f'{head}\n1.0,0,1,0,"{image}"\n')
    (text / "map.txt").write_bytes(b"\0\x01" * 300_000)
    same(read_run(text, robot()), whole)


def test_rows_with_other_columns_are_told_and_left_out(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    text = echoed(tmp_path / "text", drive(ros, 0))
    file = text / "pose.csv"
    file.write_text(file.read_text() + "1000000003000000000,0,100000")  # the disk was full
    run = read_run(text, robot())
    assert run.damage == (
        "pose.csv: 1 of 61 rows have not the columns of its first line; left out",
    )


def test_a_stamp_that_is_none(tmp_path: Path, ros: Any, robot: Any) -> None:
    text = echoed(tmp_path / "text", drive(ros, 0))
    file = text / "pose.csv"
    file.write_text(file.read_text().replace("1000000000001000000", "1.5e18"))
    with pytest.raises(InputError, match=r"pose.csv, column header.stamp: '1.5e18' is no time"):
        read_run(text, robot())


@pytest.mark.parametrize(
    ("number", "topic", "column"),
    [
        (1, "imu", "linear_acceleration_covariance"),
        (2, "odom", "header.stamp"),
        (3, "fix", "position_covariance"),
    ],
)
def test_a_column_that_was_taken_out_is_named(
    tmp_path: Path, ros: Any, robot: Any, number: int, topic: str, column: str
) -> None:
    """To save space, or by another program: a Python error was told."""
    text = echoed(tmp_path / "text", drive(ros, number))
    file = text / f"{topic}.csv"
    first, *rows = csv.reader(file.read_text().splitlines())
    kept = [place for place, name in enumerate(first) if f"field.{column}" not in name]
    with file.open("w", newline="") as made:
        csv.writer(made).writerows([row[place] for place in kept] for row in (first, *rows))
    with pytest.raises(InputError, match=rf"{file.name}, column {column}: there is no such column"):
        read_run(text, robot())


def test_one_topic_alone_is_wheels_and_no_reference(tmp_path: Path, ros: Any, robot: Any) -> None:
    text = echoed(tmp_path / "text", drive(ros, 2))
    run = read_run(text / "odom.csv", robot())
    assert run.reference is None
    assert run.ticks.right[-1] > run.ticks.left[-1]
    (text / "other.csv").write_text("x, y, th\n0, 0, 0\n")  # of another program
    assert read_run(text, robot()).reference is not None
    with pytest.raises(InputError, match=r"other.csv is neither a run folder nor a bag"):
        read_run(text / "other.csv", robot())


def test_a_folder_that_is_named_as_such_a_file_is_none(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    text = echoed(tmp_path / "text", drive(ros, 0))
    (text / "plots.csv").mkdir()
    assert read_run(text, robot()).reference is not None
