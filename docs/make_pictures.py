# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the pictures of README and docs anew: `make pictures` (needs Chrome or Chromium)."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.references.start_pose import start_of
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.model.trajectory import trajectory
from werrimbi_odom.report.path_figure import PathDrawing, path_figure
from werrimbi_odom.report.save import save_png

ROOT = Path(__file__).parents[1]
PICTURES = ROOT / "docs" / "pictures"
DATA = Path(os.environ.get("WERRIMBI_DATA", ROOT / "recordings")) / "robots"


def picture(
    robot: Path, run: Path, name: str, title: str, subtitle: str, size: float | None
) -> None:
    """Path of a run by odometry against its reference."""
    robot_file = read_robot_file(robot)
    recorded = read_run(run, robot_file)
    start = start_of(recorded, robot_file)
    ticks = recorded.ticks
    path = trajectory(robot_file.robot, ticks.time, ticks.left, ticks.right, start=start.pose)
    reference = recorded.reference
    figure = path_figure(
        PathDrawing(
            path.x,
            path.y,
            path.covariance.matrix()[:, :2, :2],
            None if reference is None else reference.x,
            None if reference is None else reference.y,
            title,
            subtitle,
            size,
        )
    )
    if not save_png(figure, PICTURES / name):
        sys.exit("no Chrome or Chromium found; e.g. apt install chromium")
    print(PICTURES / name)


def main() -> None:
    """All pictures; those of recorded robots only where their data are."""
    shipped = ROOT / "werrimbi_odom" / "recordings" / "square"
    picture(
        shipped / "robot.yaml",
        shipped,
        "demo.png",
        "A square and an eight, in a physics engine",
        "odometry with its 95 % ellipses: the error grows, and the ellipses know it",
        None,
    )
    optitrack = DATA / "optitrack_robot"
    if optitrack.exists():
        picture(
            optitrack / "robot.yaml",
            optitrack / "square_231220200029_04",
            "optitrack_square.png",
            "A real robot, not calibrated: odometry against motion capture",
            "OptiTrack robot, square 04: the truth leaves the ellipses; more than noise is wrong",
            1.0,
        )


if __name__ == "__main__":
    main()
