# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Real robots mended by the tool's own advice alone: diagnose, add what it names, again.

Prints the table of the README and of docs/real_robots.md. Nobody chooses: what the printed command
names is added, until it names nothing or the addition is refused.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.robot_files.robot_file import read_robot_file

ROOT = Path(__file__).parents[1]
ROBOTS = Path(os.environ.get("WERRIMBI_DATA", ROOT / "recordings")) / "robots"
MOST = 6
"""Rounds, at the most."""
_ADD = re.compile(r"^ +werrimbi add (\S+)", re.MULTILINE)
_WITHOUT = re.compile(r"without \w+: werrimbi add ([\w,]+) \.\.\.")
"""What `add` says to add in place of what the held-out drives refused."""


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


@dataclass(frozen=True, slots=True)
class Step:
    """What was said of a robot file, and what was added because of it."""

    robot: Path
    words: str
    answer: dict[str, Any]
    added: str | None
    refused: str = ""
    """Why not, in the words of `add`."""


def werrimbi(*words: str) -> subprocess.CompletedProcess[str]:
    """Run a command."""
    command = [sys.executable, "-m", "werrimbi_odom.cli.main", *words]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)


def drives_of(case: Case, patterns: tuple[str, ...]) -> list[str]:
    """The folders of some drives of a robot."""
    home = ROBOTS / case.robot
    return [str(path) for pattern in patterns for path in sorted(home.glob(pattern))]


def followed(case: Case, folder: Path) -> list[Step]:
    """All that was said, and done because of it; the last step adds nothing."""
    judged = drives_of(case, case.judged)
    drives = drives_of(case, case.fitted)
    drives += [*(["--holdout", *judged] if judged else []), *case.options]
    robot, steps = ROBOTS / case.robot / "robot.yaml", []
    for number in range(MOST):
        said, better = folder / f"{number}.json", folder / f"{number}.yaml"
        done = werrimbi("diagnose", "--robot", str(robot), *drives, "--json", str(said))
        assert done.returncode == 0, done.stderr
        answer = json.loads(said.read_text())
        printed = _ADD.search(done.stdout)
        if printed is None:
            return [*steps, Step(robot, done.stdout, answer, None)]
        effect = printed[1]
        tried = werrimbi("add", effect, "--robot", str(robot), *drives, "--out", str(better))
        while tried.returncode != 0:
            without = _WITHOUT.search(" ".join(tried.stderr.split()))
            if without is None:
                break
            effect = without[1]
            tried = werrimbi("add", effect, "--robot", str(robot), *drives, "--out", str(better))
        if tried.returncode != 0:
            return [*steps, Step(robot, done.stdout, answer, None, tried.stderr or tried.stdout)]
        steps.append(Step(robot, done.stdout, answer, effect))
        robot = better
    return steps


def error(case: Case, robot: Path, folder: Path) -> float:
    """The figure of the case [m]."""
    if case.judged:
        return float(compared(case, robot, folder)["legs"]["median_position_m"])
    return whole_drive(Path(drives_of(case, case.fitted)[0]), robot, folder)


def compared(case: Case, robot: Path, folder: Path) -> dict[str, Any]:
    """What `compare` says of the drives that took no part, or of all where all did."""
    said = folder / "compare.json"
    drives = drives_of(case, case.judged or case.fitted)
    done = werrimbi("compare", "--robot", str(robot), *drives, *case.options, "--json", str(said))
    assert done.returncode == 0, done.stderr
    return dict(json.loads(said.read_text()))


def predicted(run: Path, robot: Path, folder: Path) -> np.ndarray:
    """What a robot file says that the reference shows of a drive; columns t_s, x_m, y_m, ..."""
    out = folder / "odom.csv"
    out.unlink(missing_ok=True)
    done = werrimbi("odom", "--robot", str(robot), str(run), "--as-reference", "--out", str(out))
    assert done.returncode == 0, done.stderr
    return np.genfromtxt(out, delimiter=",", names=True)


def whole_drive(run: Path, robot: Path, folder: Path) -> float:
    """Root mean square of the position over a drive, its start pose fitted [m]."""
    path = predicted(run, robot, folder)
    reference = read_run(run, read_robot_file(robot)).reference
    assert reference is not None
    known = (reference.time >= path["t_s"][0]) & (reference.time <= path["t_s"][-1])
    known &= reference.has_position
    x, y = (np.interp(reference.time[known], path["t_s"], path[name]) for name in ("x_m", "y_m"))
    there, measured = x + 1j * y, reference.x[known] + 1j * reference.y[known]
    there, measured = there - there.mean(), measured - measured.mean()
    turned = there * np.exp(1j * np.angle(np.sum(np.conj(there) * measured)))
    return float(np.sqrt(np.mean(np.abs(turned - measured) ** 2)))


def verdict(answer: dict[str, Any]) -> str:
    """The verdict, and whether what is left is told to be the reference's own noise."""
    left = answer["left"]
    noise = answer["verdict"] == "unknown" and left is not None and left["is_reference_noise"]
    return f"{answer['verdict']}{', but the reference errs by as much' if noise else ''}"


def row(case: Case) -> str:
    """One line of the table."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        before = error(case, ROBOTS / case.robot / "robot.yaml", folder)
        steps = followed(case, folder)
        after = error(case, steps[-1].robot, folder)
    effects = ", ".join(
        f"`{name}`" for step in steps if step.added for name in step.added.split(",")
    )
    figures = f"{1e3 * before:.1f} mm | {effects} | {1e3 * after:.1f} mm"
    refused = steps[-1].refused and steps[-1].answer["verdict"] == "named"
    last = f"{verdict(steps[-1].answer)}{', but the held-out drives refuse it' if refused else ''}"
    return f"| {case.told} | {figures} | {last} |"


if __name__ == "__main__":
    if not ROBOTS.is_dir():
        sys.exit(f"no recordings in {ROBOTS}: run `make recordings` first")
    print("| robot, held-out error | as its robot file says | added | after | then |")
    print("| --- | --- | --- | --- | --- |")
    for each in CASES:
        print(row(each), flush=True)
