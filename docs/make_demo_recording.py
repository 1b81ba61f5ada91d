# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The recorded drive that ships with the package: what it is, and the command that makes it.

    python docs/make_demo_recording.py [FOLDER]

writes FOLDER/square (ticks.csv, reference.csv, robot.yaml) and FOLDER/square_bag (the same drive as
a rosbag2); FOLDER is by default werrimbi_odom/recordings of this checkout, and is overwritten.
"""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

from werrimbi_odom.simulation import (
    Recording,
    TrueRobot,
    chain,
    figure_eight,
    record,
    square,
    write_robot_file,
    write_run,
)
from werrimbi_odom.simulation.bag import write_bag

ROBOT = TrueRobot(left_wheel_noise=4.0e-4, right_wheel_noise=5.8e-4)
"""True geometry, and the wheel noise that the paper measured on its robot."""

SEED = 1997


def demo_recording() -> Recording:
    """A square of 2 m to the left, then a figure of eight of 0.7 m radius: 58 s and 17 m."""
    return record(ROBOT, chain("square", square(2.0), figure_eight(0.7)), seed=SEED)


def make(folder: Path) -> None:
    """Write the recording as a run folder and as a bag below `folder`."""
    recording = demo_recording()
    run = write_run(recording, folder / "square")
    write_robot_file(ROBOT, run / "robot.yaml")
    bag = folder / "square_bag"
    if bag.exists():
        shutil.rmtree(bag)
    write_bag(recording, ROBOT, bag)


if __name__ == "__main__":
    make(
        Path(
            sys.argv[1]
            if len(sys.argv) > 1
            else Path(__file__).parents[1] / "werrimbi_odom/recordings"
        )
    )
