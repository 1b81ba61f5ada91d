# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Readers under atheris: inputs that reach new code are kept and changed further.

    pip install atheris
    python test/faults/fuzz.py robot_file|ticks|bag SECONDS

Anything but an InputError of one line is a finding, and ends it with the input that did it.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import atheris
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))
RECORDINGS = ROOT / "werrimbi_odom" / "recordings"

with atheris.instrument_imports(include=["werrimbi_odom", "rosbags"]):
    import rosbags.rosbag2 as rosbag2
    import rosbags.typesys as typesys

    from werrimbi_odom.errors import InputError
    from werrimbi_odom.files.read_run import read_run
    from werrimbi_odom.files.robot_files.robot_file import read_robot_file


def readers(folder: Path) -> dict[str, tuple[Path, Callable[[Path], object]]]:
    """Where an input is written, and what reads it."""
    robot = read_robot_file(RECORDINGS / "square" / "robot.yaml")
    run = folder / "run"
    run.mkdir()
    return {
        "robot_file": (folder / "robot.yaml", read_robot_file),
        "ticks": (run / "ticks.csv", lambda file: read_run(file.parent, robot)),
        "bag": (folder / "bag.mcap", lambda file: read_run(file, robot)),
    }


def small_bag(folder: Path) -> bytes:
    """Ten counts of two wheels in a whole MCAP file."""
    store = typesys.get_typestore(typesys.Stores.ROS2_JAZZY)
    kind = "sensor_msgs/msg/JointState"
    with rosbag2.Writer(
        folder / "seed", version=9, storage_plugin=rosbag2.StoragePlugin.MCAP
    ) as writer:
        topic = writer.add_connection("/joint_states", kind, typestore=store)
        for row in range(10):
            stamp = store.types["builtin_interfaces/msg/Time"](row, 0)
            header = store.types["std_msgs/msg/Header"](stamp, "")
            names = ["left_wheel_joint", "right_wheel_joint"]
            position = np.array([0.1 * row, 0.2 * row])
            message = store.types[kind](header, names, position, np.zeros(0), np.zeros(0))
            writer.write(topic, row * 10**9, store.serialize_cdr(message, kind))
    return (folder / "seed" / "seed.mcap").read_bytes()


def seeds(name: str, folder: Path) -> list[bytes]:
    """What is changed first."""
    square = RECORDINGS / "square"
    return {
        "robot_file": [(square / "robot.yaml").read_bytes(), b"odom_node: {ros__parameters: {}}"],
        "ticks": [(square / "ticks.csv").read_bytes()[:2000], b"t_s,left_ticks,right_ticks\n0,0,0"],
        "bag": [small_bag(folder)],
    }[name]


def main(name: str, seconds: str) -> None:
    """Fuzz one reader for a while."""
    folder = Path(tempfile.mkdtemp())
    file, read = readers(folder)[name]
    corpus = folder / "corpus"
    corpus.mkdir()
    for number, seed in enumerate(seeds(name, folder)):
        (corpus / str(number)).write_bytes(seed)

    def one(data: bytes) -> None:
        file.write_bytes(data)
        try:
            read(file)
        except InputError as error:
            if "\n" in str(error):
                raise RuntimeError("more than one line") from error

    flags = [
        f"-max_total_time={seconds}",
        "-max_len=8192",
        "-rss_limit_mb=4096",
        "-print_final_stats=1",
    ]
    atheris.Setup([sys.argv[0], *flags, str(corpus)], one)
    atheris.Fuzz()


if __name__ == "__main__":
    main(*sys.argv[1:3])
