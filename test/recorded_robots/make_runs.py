# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Makes run folders of real robots from public repositories, and gets bags: `make recordings`.

    python -m test.recorded_robots.make_runs [--out recordings] [--clones FOLDER]

Clones go to FOLDER (git-ignored), each at the commit that test/recorded_robots/robots.py names, and
hold the few files that are read. A clone that is there already, in FOLDER/NAME, is used as it is.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from test.recorded_robots.robots import BAGS, ROBOTS, TURTLEBOT3, Repository, Robot
from test.recorded_robots.runs import Read, write

ROOT = Path(__file__).parents[2]


def reader(source: Repository, clones: Path) -> Read:
    """What reads a file of a repository; the repository is cloned where it is not yet."""
    clone = clones / source.name.rpartition("/")[2]
    if not clone.exists():
        # A blob is got when it is read: some of these repositories hold gigabytes of other data.
        _git("clone", "--quiet", "--filter=blob:none", "--no-checkout", source.url, str(clone))

    def read(path: str) -> bytes:
        return _git("-C", str(clone), "show", f"{source.commit}:{path}")

    return read


def make(robot: Robot, read: Read, folder: Path) -> int:
    """Write a robot's file and its drives; how many drives there are."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "robot.yaml").write_text(robot.robot_file(), encoding="utf-8")
    drives = list(robot.drives(read))
    for drive in drives:
        write(drive, folder / drive.name)
    return len(drives)


def get_bags(read: Read, folder: Path) -> int:
    """Write the bags of the TurtleBot3 as they are; how many files there are."""
    for file in BAGS:
        place = folder / file
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(read(f"lab03_pkg/recordings/{file}"))
    return len(BAGS)


def main(arguments: Sequence[str] | None = None) -> int:
    """Make every robot; 1 where a repository could not be had."""
    parser = argparse.ArgumentParser(description="run folders of real robots, from public data")
    parser.add_argument("--out", type=Path, default=ROOT / "recordings")
    parser.add_argument("--clones", type=Path, help="(default: OUT/clones)")
    given = parser.parse_args(arguments)
    clones = given.clones or given.out / "clones"
    clones.mkdir(parents=True, exist_ok=True)
    failed: dict[str, str] = {}
    wanted: list[tuple[str, Repository, str, Callable[[Read], int]]] = [
        (robot.folder, robot.source, "drives", partial(_made, robot, given.out)) for robot in ROBOTS
    ]
    bags = given.out / "bags" / "turtlebot3"
    wanted.append(("bags/turtlebot3", TURTLEBOT3, "files", lambda read: get_bags(read, bags)))
    for name, source, what, got in wanted:
        try:
            count = got(reader(source, clones))
        except subprocess.CalledProcessError as error:
            failed[source.url] = source.name.rpartition("/")[2]
            words = " ".join(error.stderr.decode(errors="replace").split())
            print(f"{name}: not made: {source.url}: {words}", file=sys.stderr)
        else:
            print(f"{name}: {count} {what} ({source.licence})")
    if failed:
        print(
            "Without a network, clone these where there is one, bring them here, and run it again:",
            *(f"git clone {url} {clones / name}" for url, name in failed.items()),
            sep="\n  ",
            file=sys.stderr,
        )
    return 1 if failed else 0


def _made(robot: Robot, out: Path, read: Read) -> int:
    return make(robot, read, out / "robots" / robot.folder)


def _git(*arguments: str) -> bytes:
    return subprocess.run(["git", *arguments], capture_output=True, check=True).stdout


if __name__ == "__main__":
    sys.exit(main())
