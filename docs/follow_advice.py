# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Real robots mended by the tool's own advice alone: diagnose, add what it names, again.

Prints the table of the README and of docs/real_robots.md. Nobody chooses: the first effect named is
added, until nothing is named or the addition is refused.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.robot_file import read_robot_file

ROOT = Path(__file__).parents[1]
ROBOTS = Path(os.environ.get("WERRIMBI_DATA", ROOT / "recordings")) / "robots"
MOST = 6
"""Rounds, at the most."""


@dataclass(frozen=True, slots=True)
class Case:
    """A robot, what is fitted, and what is judged."""

    robot: str
    told: str
    fitted: tuple[str, ...]
    judged: tuple[str, ...]
    options: tuple[str, ...] = ()


CASES = (
    Case(
        "optitrack_robot",
        "OptiTrack robot, median of 0.5 m legs",
        ("square_*", "circular_*"),
        ("free_*",),
        ("--leg", "0.5"),
    ),
    Case(
        "khepera_laser_to_the_side",
        "Khepera, laser to the side, median of 0.1 m legs",
        ("part_0", "part_1"),
        ("part_2",),
        ("--leg", "0.1", "--reference-kind", "incremental"),
    ),
    Case(
        "khepera_laser_moved",
        "Khepera, laser moved, median of 0.1 m legs",
        ("part_0", "part_1"),
        ("part_2",),
        ("--leg", "0.1", "--reference-kind", "incremental"),
    ),
    Case("labyrinth", "Labyrinth robot, rms of the whole drive", ("drive",), ()),
)


def werrimbi(*words: str) -> int:
    """Run a command; its exit code."""
    command = [sys.executable, "-m", "werrimbi_odom.cli.main", *words]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    return done.returncode


def followed(case: Case, folder: Path) -> tuple[Path, list[str], str]:
    """The robot file at the end, the effects added, and the last verdict."""
    home = ROBOTS / case.robot
    fitted = [str(path) for pattern in case.fitted for path in sorted(home.glob(pattern))]
    judged = [str(path) for pattern in case.judged for path in sorted(home.glob(pattern))]
    drives = [*fitted, *(["--holdout", *judged] if judged else []), *case.options]
    robot, added, verdict = home / "robot.yaml", [], ""
    for number in range(MOST):
        said = folder / f"{number}.json"
        assert werrimbi("diagnose", "--robot", str(robot), *drives, "--json", str(said)) == 0
        answer = json.loads(said.read_text())
        verdict, effect = answer["verdict"], answer["effect"]
        better = folder / f"{number}.yaml"
        if effect is None:
            break
        if werrimbi("add", effect, "--robot", str(robot), *drives, "--out", str(better)) != 0:
            break
        robot, added = better, [*added, effect]
    return robot, added, verdict


def error(case: Case, robot: Path, folder: Path) -> float:
    """The figure of the case [m]."""
    home = ROBOTS / case.robot
    if case.judged:
        judged = [str(path) for pattern in case.judged for path in sorted(home.glob(pattern))]
        said = folder / "compare.json"
        code = werrimbi(
            "compare", "--robot", str(robot), *judged, *case.options, "--json", str(said)
        )
        assert code == 0
        return float(json.loads(said.read_text())["legs"]["median_position_m"])
    return whole_drive(home / case.fitted[0], robot, folder)


def whole_drive(run: Path, robot: Path, folder: Path) -> float:
    """Root mean square of the position over a drive, its start pose fitted [m]."""
    out = folder / "odom.csv"
    out.unlink(missing_ok=True)
    code = werrimbi("odom", "--robot", str(robot), str(run), "--as-reference", "--out", str(out))
    assert code == 0
    path = np.genfromtxt(out, delimiter=",", names=True)
    reference = read_run(run, read_robot_file(robot)).reference
    assert reference is not None
    known = (reference.time >= path["t_s"][0]) & (reference.time <= path["t_s"][-1])
    known &= reference.has_position
    x, y = (np.interp(reference.time[known], path["t_s"], path[name]) for name in ("x_m", "y_m"))
    there, measured = x + 1j * y, reference.x[known] + 1j * reference.y[known]
    there, measured = there - there.mean(), measured - measured.mean()
    turned = there * np.exp(1j * np.angle(np.sum(np.conj(there) * measured)))
    return float(np.sqrt(np.mean(np.abs(turned - measured) ** 2)))


def row(case: Case) -> str:
    """One line of the table."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        before = error(case, ROBOTS / case.robot / "robot.yaml", folder)
        robot, added, verdict = followed(case, folder)
        after = error(case, robot, folder)
    effects = ", ".join(f"`{effect}`" for effect in added)
    figures = f"{1e3 * before:.1f} mm | {effects} | {1e3 * after:.1f} mm"
    return f"| {case.told} | {figures} | {verdict} |"


if __name__ == "__main__":
    print("| robot, held-out error | as its robot file says | added | after | then |")
    print("| --- | --- | --- | --- | --- |")
    for each in CASES:
        print(row(each), flush=True)
