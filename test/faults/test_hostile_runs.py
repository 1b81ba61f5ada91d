# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings from a stranger: no code of theirs runs, no file outside is read, memory is bounded.

Each case goes through the command line in a process of its own with 2 GB of address space and 60
seconds of CPU, so that "bounded" is enforced, not estimated.
"""

from __future__ import annotations

import resource
import shutil
import sqlite3
import subprocess
import sys
from pathlib import Path

import pytest

from test.evidence import in_evidence

pytest.importorskip("rosbags", reason="rosbags is not installed")

ROOT = Path(__file__).parents[2]
RECORDINGS = ROOT / "werrimbi_odom" / "recordings"
ROBOT = RECORDINGS / "square" / "robot.yaml"
MEMORY = 2 * 2**30
SECONDS = 60


def limits() -> None:
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))


def odom(run: Path, robot: Path = ROBOT) -> subprocess.CompletedProcess[str]:
    out = run.parent / "odom.csv"
    command = [sys.executable, "-m", "werrimbi_odom.cli.main", "odom"]
    return subprocess.run(
        [*command, "--robot", str(robot), str(run), "--out", str(out)],
        cwd=run.parent,
        env={"PYTHONPATH": str(ROOT), "OPENBLAS_NUM_THREADS": "1", "PATH": "/usr/bin:/bin"},
        capture_output=True,
        text=True,
        check=False,
        preexec_fn=limits,
        timeout=300.0,
    )


def refused(run: Path, said: str) -> None:
    """One clear line, and exit code 2."""
    done = odom(run)
    assert done.returncode == 2, done.stderr[-2000:]
    assert done.stderr.count("\n") == 1, done.stderr[-2000:]
    assert said in done.stderr


@pytest.fixture
def bag(tmp_path: Path) -> Path:
    folder = tmp_path / "bag"
    shutil.copytree(RECORDINGS / "square_bag", folder)
    return folder


def metadata(bag: Path, old: str, new: str) -> None:
    file = bag / "metadata.yaml"
    text = file.read_text(encoding="utf-8")
    assert old in text
    file.write_text(text.replace(old, new), encoding="utf-8")


def test_the_limits_leave_room_for_an_honest_bag(bag: Path) -> None:
    assert odom(bag).returncode == 0


@pytest.mark.parametrize(
    "escape", ["../secret.mcap", *map(in_evidence, ("{outside}/secret.mcap", ".."))]
)
def test_a_bag_cannot_name_files_outside_itself(bag: Path, tmp_path: Path, escape: str) -> None:
    """What lies outside is a whole bag: if it were followed, the command would succeed."""
    (bag / "square_bag.mcap").rename(tmp_path / "secret.mcap")
    metadata(bag, "square_bag.mcap", escape.format(outside=tmp_path))
    refused(bag, "cannot be read as a bag")


@pytest.mark.parametrize("link", [in_evidence(False), True])
def test_a_file_that_is_named_a_thousand_times_is_not_read_so_often(bag: Path, link: bool) -> None:
    names = [f"more_{n}.mcap" if link else "square_bag.mcap" for n in range(1000)]
    for name in names if link else ():
        (bag / name).symlink_to(bag / "square_bag.mcap")
    listed = "".join(f"  - {name}\n" for name in names)
    metadata(bag, "  - square_bag.mcap\n", f"  - square_bag.mcap\n{listed}")
    refused(bag, "more than once")


@pytest.mark.parametrize(
    "tag",
    ["!!python/object/apply:os.system [touch pwned]", in_evidence("!!python/name:os.system")],
)
def test_metadata_runs_no_code(bag: Path, tag: str) -> None:
    metadata(bag, "rosbag2_bagfile_information:", f"harm: {tag}\nrosbag2_bagfile_information:")
    refused(bag, "cannot be read as a bag")
    assert not list(bag.parent.rglob("pwned"))


def test_a_bomb_of_aliases_costs_nothing(bag: Path) -> None:
    bomb = ["a0: &a0 [lol, lol, lol, lol, lol, lol, lol, lol, lol, lol]"]
    bomb += [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]" for i in range(1, 30)]
    file = bag / "metadata.yaml"
    file.write_text("\n".join(bomb) + "\n" + file.read_text(encoding="utf-8"), encoding="utf-8")
    done = odom(bag)
    assert done.returncode in (0, 2)
    assert "Traceback" not in done.stderr


def test_a_message_that_lies_about_its_length_is_refused(bag: Path, tmp_path: Path) -> None:
    """A JointState whose list of names claims to hold two thousand million of them."""
    from rosbags.rosbag2 import StoragePlugin, Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_JAZZY)
    folder = tmp_path / "liar"
    with Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        joints = writer.add_connection(
            "/joint_states", "sensor_msgs/msg/JointState", typestore=store
        )
        header = b"\0\1\0\0" + bytes(8) + (1).to_bytes(4, "little") + bytes(4)
        for row in range(10):
            data = header + (2**31 - 1).to_bytes(4, "little") + b"\xff" * 16
            writer.write(joints, row * 10**9, data)
    refused(folder, "cannot be read as a bag")


BLOCK = 2**17
"""The largest of zstd."""


def zeros(blocks: int) -> bytes:
    """A frame of zstd (RFC 8878) of blocks that repeat a zero: nobody has to compress them."""
    repeated = (BLOCK << 3 | 1 << 1).to_bytes(3, "little") + b"\0"
    last = (BLOCK << 3 | 1 << 1 | 1).to_bytes(3, "little") + b"\0"
    return b"\x28\xb5\x2f\xfd" + b"\x00\x58" + repeated * (blocks - 1) + last


def test_a_chunk_that_unpacks_to_more_than_memory_is_refused(bag: Path) -> None:
    """Eight thousand million zeros in a quarter of a megabyte of zstd."""
    try:
        from compression import zstd  # type: ignore[import-not-found]
    except ImportError:
        zstd = pytest.importorskip("backports.zstd")
    assert zstd.decompress(zeros(3)) == bytes(3 * BLOCK)
    bomb = zeros(2**33 // BLOCK)
    assert len(bomb) < 2**20
    name = "square_bag.mcap"
    head = b"\x89MCAP0\r\n"
    start_end = bytes(8) + (10).to_bytes(8, "little")
    kind = len(b"zstd").to_bytes(4, "little") + b"zstd"
    chunk = start_end + (2**33).to_bytes(8, "little") + bytes(4) + kind
    chunk += len(bomb).to_bytes(8, "little") + bomb
    record = b"\x06" + len(chunk).to_bytes(8, "little") + chunk
    profile = (4).to_bytes(4, "little") + b"ros2" + bytes(4)
    header = b"\x01" + len(profile).to_bytes(8, "little") + profile
    footer = b"\x02" + (20).to_bytes(8, "little") + bytes(20)
    (bag / name).write_bytes(head + header + record + footer + head)
    refused(bag / name, "Unable to allocate output buffer")


def test_a_database_whose_messages_are_a_program_is_refused(tmp_path: Path) -> None:
    """A view in the place of the table, with a row for every integer: it would never end."""
    bag = tmp_path / "endless.db3"
    with sqlite3.connect(bag) as database:
        database.executescript(
            """
            CREATE TABLE schema(schema_version INTEGER, ros_distro TEXT);
            INSERT INTO schema VALUES (4, 'jazzy');
            CREATE TABLE metadata(id INTEGER, metadata_version INTEGER, metadata TEXT);
            CREATE TABLE topics(id INTEGER, name TEXT, type TEXT, serialization_format TEXT,
                offered_qos_profiles TEXT, type_description_hash TEXT);
            INSERT INTO topics VALUES (1, '/left_ticks', 'std_msgs/msg/Int32', 'cdr', '', '');
            CREATE TABLE message_definitions(id INTEGER, topic_type TEXT, encoding TEXT,
                encoded_message_definition TEXT, type_description_hash TEXT);
            CREATE VIEW messages AS WITH RECURSIVE n(i) AS
                (SELECT 1 UNION ALL SELECT i + 1 FROM n)
                SELECT i AS id, 1 AS topic_id, i AS timestamp, x'0001000001000000' AS data FROM n;
            """
        )
    refused(bag, "missing tables")


def test_a_table_without_end_is_not_read_to_its_end(tmp_path: Path) -> None:
    run = tmp_path / "run"
    run.mkdir()
    (run / "ticks.csv").symlink_to("/dev/zero")
    refused(run, "line 1 is longer than")


def test_a_folder_that_links_to_itself_is_no_run(tmp_path: Path) -> None:
    run = tmp_path / "run"
    run.mkdir()
    (run / "again").symlink_to(run)
    refused(run, "holds neither ticks.csv nor a bag")
