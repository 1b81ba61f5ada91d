# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Commands as tests give them, with what they wrote or their one line; run folders for them."""

from __future__ import annotations

import argparse
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from test.inference.driven import run_of
from test.robot_file import BARE
from werrimbi_odom.cli.main import main
from werrimbi_odom.files.run import Run
from werrimbi_odom.model.robot import Robot

RECORDING = Path(__file__).parents[2] / "werrimbi_odom" / "recordings" / "square"
"""The drive that the package ships, and its robot file."""
ROBOT = RECORDING / "robot.yaml"


def refuse(constant: str) -> None:
    raise AssertionError(f"{constant} is no JSON")


def written_by(file: Path, *words: object) -> dict[str, Any]:
    """What a command writes with --json, which must be JSON to any reader."""
    assert main([*map(str, words), "--json", str(file)]) == 0
    found = json.loads(file.read_text(), parse_constant=refuse)
    assert isinstance(found, dict)
    return found


def called(verb: ModuleType, *words: object) -> int:
    """Code of a verb that raises its mistakes, as it does in front of `main`."""
    parser = argparse.ArgumentParser()
    verb.add_arguments(parser)
    return int(verb.run(parser.parse_args([str(word) for word in words])))


PLAIN = Robot(0.35, 0.05, 2000.0, 2000.0, left_wheel_noise=4e-4, right_wheel_noise=4e-4)

ROBOT_FILE = f"{BARE}    left_wheel_noise: 4.0e-4\n    right_wheel_noise: 4.0e-4\n"


def written(
    folder: Path,
    truths: Sequence[Robot],
    channels: Sequence[Mapping[str, np.ndarray]] | None = None,
) -> Path:
    """A minute for each true robot as a run folder, and the file of the plain one."""
    (folder / "robot.yaml").write_text(ROBOT_FILE)
    for seed, truth in enumerate(truths):
        measured = None if channels is None else channels[seed]
        run = run_of(truth, seed, 60, measured)
        write_run(folder / run.name, run)
    return folder


def write_controllers(path: Path, robot: Robot) -> None:
    """Parameters of a diff_drive_controller, which say a robot's sizes and no counts of a turn."""
    path.write_text(
        "diff_drive_controller:\n  ros__parameters:\n"
        "    left_wheel_names: [a]\n    right_wheel_names: [b]\n"
        f"    wheel_separation: {robot.wheel_separation}\n    wheel_radius: {robot.wheel_radius}\n"
    )


def write_run(place: Path, run: Run) -> None:
    """A run as a folder."""
    assert run.reference is not None
    place.mkdir()
    names = ["t_s", "left_ticks", "right_ticks", *run.ticks.channels]
    columns = [run.ticks.time, run.ticks.left, run.ticks.right, *run.ticks.channels.values()]
    _table(place / "ticks.csv", names, columns)
    seen = run.reference
    names = ["t_s", "x_m", "y_m", "yaw_rad"]
    _table(place / "reference.csv", names, [seen.time, seen.x, seen.y, seen.yaw])


def _table(path: Path, names: Sequence[str], columns: Sequence[np.ndarray]) -> None:
    np.savetxt(path, np.column_stack(columns), "%.9g", ",", header=",".join(names), comments="")
