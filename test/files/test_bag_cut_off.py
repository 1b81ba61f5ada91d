# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Bags that were cut off: read up to there, and said."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.read_run import read_run

MS = 10**6
WHEELS = ["left_wheel_joint", "right_wheel_joint"]


def drive(ros: Any, messages: int) -> list[Any]:
    return [
        ("/joint_states", n * MS, ros.joints(n * MS, WHEELS, [0.1 * n, 0.2 * n]))
        for n in range(1, messages + 1)
    ]


@pytest.mark.parametrize(
    ("plugin", "share"),
    [
        pytest.param(plugin, share, marks=[pytest.mark.evidence] * ((row + column) % 3 > 0))
        for row, plugin in enumerate(("mcap", "sqlite3", "ros1"))
        for column, share in enumerate((0.3, 0.95, 0.6))
    ],
)
def test_read_up_to_where_it_ends(
    tmp_path: Path, ros: Any, robot: Any, plugin: str, share: float
) -> None:
    if plugin == "ros1":
        bag = file = ros.write_ros1(tmp_path / "run.bag", drive(ros, 3000))
    else:
        bag = ros.write(tmp_path / "bag", drive(ros, 3000), plugin)
        file = next(each for each in bag.iterdir() if each.suffix != ".yaml")
    whole = file.read_bytes()
    file.write_bytes(whole[: int(len(whole) * share)])
    run = read_run(bag, robot())
    assert 0.5 * share < run.ticks.rows / 3000 <= 1.0
    np.testing.assert_allclose(run.ticks.left, 100.0 / (2 * np.pi) * 1000.0 * run.ticks.time)
    assert (np.diff(run.ticks.time) > 0.0).all()
    (told,) = run.damage
    assert told.startswith("the bag is cut off or was never finished; read up to t_s ")
    (bag / "metadata.yaml").unlink() if plugin != "ros1" else None
    assert read_run(bag, robot()).ticks.rows == run.ticks.rows


def test_files_of_a_recording_that_was_killed(tmp_path: Path, ros: Any, robot: Any) -> None:
    """Two files of one bag, the second one cut off, and no metadata."""
    folder = tmp_path / "bag"
    folder.mkdir()
    for number in range(2):
        part = ros.write(tmp_path / f"part_{number}", drive(ros, 2000)[1000 * number :][:1000])
        whole = next(part.glob("*.mcap")).read_bytes()
        cut = whole if number == 0 else whole[: len(whole) // 2]
        (folder / f"bag_{number}.mcap").write_bytes(cut)
    run = read_run(folder, robot())
    assert 1000 < run.ticks.rows < 2000
    assert run.damage


@pytest.mark.parametrize("plugin", ["mcap", "sqlite3", "bag", "BAG"])
@pytest.mark.parametrize(("later", "apart"), [(600.0, "600 s apart"), (-0.9, "overlap")])
def test_several_recordings_in_a_folder_are_not_one(
    tmp_path: Path, ros: Any, robot: Any, plugin: str, later: float, apart: str
) -> None:
    """Two finished drives were "cut off or never finished", and one of 660 s."""
    folder = tmp_path / "drives"
    folder.mkdir()
    for number, name in enumerate(("a", "b")):
        shift = round(number * (1.0 + later) * 1e9)
        entries = [(topic, at + shift, each) for topic, at, each in drive(ros, 1000)]
        if plugin.lower() == "bag":
            ros.write_ros1(folder / f"{name}.bag", entries).rename(folder / f"{name}.{plugin}")
        else:
            part = ros.write(tmp_path / name, entries, plugin)
            file = next(each for each in part.iterdir() if each.suffix != ".yaml")
            file.rename(folder / f"{name}{file.suffix}")
    with pytest.raises(InputError, match=rf"recordings of their own .*{apart}.* give each") as said:
        read_run(folder, robot())
    assert f"{folder / 'a'}." in str(said.value)


@pytest.mark.parametrize("share", [1.0, 0.5])
def test_a_folder_of_ros1_bags(tmp_path: Path, ros: Any, robot: Any, share: float) -> None:
    """As `rosbag record --split` leaves it: whole, or the last one cut off."""
    folder = tmp_path / "bags"
    folder.mkdir()
    for number in range(2):
        part = drive(ros, 2000)[1000 * number :][:1000]
        last = ros.write_ros1(folder / f"run_{number}.bag", part)
    whole = last.read_bytes()
    last.write_bytes(whole[: int(share * len(whole))])
    run = read_run(folder, robot())
    np.testing.assert_allclose(run.ticks.left, 100.0 / (2 * np.pi) * 1000.0 * run.ticks.time)
    assert (run.ticks.rows == 2000) == (run.damage == ()) == (share == 1.0)


@pytest.mark.parametrize(("name", "share"), [("X.BAG", 1.0), ("x.bag.active", 0.9)])
def test_other_ends_of_the_name_of_a_ros1_bag(
    tmp_path: Path, ros: Any, robot: Any, name: str, share: float
) -> None:
    """Of another file system, and of a recorder that was killed."""
    plain = ros.write_ros1(tmp_path / "x.bag", drive(ros, 300))
    bag = tmp_path / name
    bag.write_bytes(plain.read_bytes()[: int(share * plain.stat().st_size)])
    plain.unlink()
    for path in (bag, tmp_path):
        run = read_run(path, robot())
        assert 100 < run.ticks.rows <= 300
        assert bool(run.damage) == (share < 1.0)


@pytest.mark.parametrize("plugin", ["mcap", "sqlite3"])
@pytest.mark.parametrize("mode", ["MESSAGE", "FILE"])
def test_compressed_by_ros2_bag_and_without_metadata(
    tmp_path: Path, ros: Any, robot: Any, plugin: str, mode: str
) -> None:
    bag = ros.write(tmp_path / "bag", drive(ros, 30), plugin, mode)
    (bag / "metadata.yaml").unlink()
    (file,) = bag.iterdir()
    if mode == "MESSAGE":
        assert read_run(bag, robot()).ticks.rows == 30
        return
    for path in (bag, file):
        with pytest.raises(InputError, match=rf"`zstd -d {file.name}` writes {file.stem}, which"):
            read_run(path, robot())


def test_what_recovers_a_bag_is_of_its_kind(tmp_path: Path, ros: Any, robot: Any) -> None:
    for name, tool in (("x.bag", "`rosbag reindex`"), ("x.mcap", "`mcap recover`")):
        begin = b"#ROSBAG V2.0\n" if name == "x.bag" else b"\x89MCAP0\r\n"
        (tmp_path / name).write_bytes(begin + 9 * b"\xff")
        with pytest.raises(InputError, match=tool):
            read_run(tmp_path / name, robot())


@pytest.mark.parametrize("plugin", ["mcap", "sqlite3"])
def test_a_file_that_was_renamed_is_read_beside_its_old_metadata(
    tmp_path: Path, ros: Any, robot: Any, plugin: str
) -> None:
    bag = ros.write(tmp_path / "bag", drive(ros, 30), plugin)
    file = next(each for each in bag.iterdir() if each.suffix != ".yaml")
    file.rename(bag / f"rosbag{file.suffix}")
    run = read_run(bag, robot())
    assert run.ticks.rows == 30
    assert run.damage == ()


def test_a_file_of_several_that_is_gone_is_missed(tmp_path: Path, ros: Any, robot: Any) -> None:
    """What is there is a part, and would pass for the whole."""
    bag = ros.write(tmp_path / "bag", drive(ros, 30))
    metadata = bag / "metadata.yaml"
    name = next(bag.glob("*.mcap")).name
    metadata.write_text(metadata.read_text().replace(f"- {name}", f"- {name}\n  - gone.mcap", 1))
    with pytest.raises(InputError, match=r"gone\.mcap"):
        read_run(bag, robot())


def test_an_undamaged_bag_says_nothing(tmp_path: Path, ros: Any, robot: Any) -> None:
    assert read_run(ros.write(tmp_path / "bag", drive(ros, 3)), robot()).damage == ()


def test_nothing_is_left(tmp_path: Path, ros: Any, robot: Any) -> None:
    bag = ros.write(tmp_path / "bag", drive(ros, 3))
    file = next(bag.glob("*.mcap"))
    file.write_bytes(file.read_bytes()[:60])
    with pytest.raises(InputError, match="cannot be read as a bag"):
        read_run(bag, robot())
