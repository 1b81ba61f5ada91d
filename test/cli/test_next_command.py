# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The command that follows is one that a shell takes, for the same files and options."""

from __future__ import annotations

import shlex
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import werrimbi_odom as wo
from test.cli.commands import RECORDING
from test.command_line import Werrimbi, ran
from werrimbi_odom.api.drives import recordings_of
from werrimbi_odom.api.next_command import next_command
from werrimbi_odom.cli.main import _parser
from werrimbi_odom.errors import InputError


def pasted(command: str) -> list[str]:
    """Its words as a shell makes them, patterns filled in."""
    done = ran(["sh", "-c", command.replace("werrimbi ", "printf '%s\\0' ", 1)])
    assert done.returncode == 0
    return done.stdout.split("\0")[:-1]


@pytest.mark.parametrize("every", [True, False])
def test_what_compare_prints_can_be_pasted(tmp_path: Path, werrimbi: Werrimbi, every: bool) -> None:
    runs = [tmp_path / "my drives" / name for name in ("a b", "it's", "{c}")]
    for folder in runs:
        shutil.copytree(RECORDING, folder)
    text = (
        (RECORDING / "robot.yaml")
        .read_text()
        .replace("wheel_separation: 0.35 ", "wheel_separation: 0.4 ")
    )
    robot = tmp_path / "my robot.yaml"
    robot.write_text(text)
    given = runs if every else runs[:2]
    words = ["--robot", str(robot), "--leg", "0.5", "--reference-sigma-xy", "0.001"]
    lines = werrimbi("compare", *words, *given).out.splitlines()
    first = next(n for n, line in enumerate(lines) if line.startswith("    werrimbi diagnose"))
    assert lines[first - 1].endswith((".", "noise.", "mistake."))
    command = "\n".join(lines[first : lines.index("", first)])
    again = pasted(command)
    assert again == ["diagnose", *words, *map(str, given)]
    assert ("/*" in command) == every
    assert _parser(again).parse_args(again).leg == 0.5
    assert shlex.split(command.replace("\\\n", " "))[:2] == ["werrimbi", "diagnose"]


@pytest.mark.parametrize("own", ["local_map", None])
def test_a_kind_of_reference_that_was_asked_for_is_kept(own: str | None) -> None:
    robot = wo.read_robot(RECORDING / "robot.yaml")
    run = wo.read_run(RECORDING, robot)
    assert run.reference is not None
    seen = replace(run.reference, kind=own)
    given = recordings_of(robot, replace(run, reference=seen), reference_kind="absolute")
    asks = "--reference-kind absolute" in next_command(["diagnose"], given)
    assert asks == (own is not None), "by itself a localiser is taken as local_map"


def test_references_stay_with_their_drives(tmp_path: Path) -> None:
    drives, others = [tmp_path / "drives" / name for name in "ba"], []
    for drive in drives:
        shutil.copytree(RECORDING, drive)
        others.append(tmp_path / f"poses of {drive.name}")
        others[-1].mkdir()
        (drive / "reference.csv").rename(others[-1] / "reference.csv")
    robot = wo.read_robot(RECORDING / "robot.yaml")
    again = pasted(next_command(["diagnose"], recordings_of(robot, drives, references=others)))
    references = [word for other in others for word in ("--reference", str(other))]
    assert again[3:] == [*references, *map(str, drives)]


def test_what_was_forced_is_forced_again(tmp_path: Path) -> None:
    """Odometry of these very counts, by its numbers: nothing in its name says so."""
    robot = wo.read_robot(RECORDING / "robot.yaml")
    ticks = wo.read_run(RECORDING, robot).ticks
    path = wo.odometry(robot, ticks.time, ticks.left, ticks.right)
    poses = np.column_stack((ticks.time, path.x, path.y, path.yaw))
    run = wo.write_run(tmp_path / "run", ticks.time, ticks.left, ticks.right, poses)
    with pytest.raises(InputError, match="--force takes it all the same"):
        recordings_of(robot, run)
    with pytest.warns(UserWarning, match="taken all the same"):
        given = recordings_of(robot, run, force_reference=True)
    assert " --force " in next_command(["diagnose"], given)
    sound = recordings_of(robot, RECORDING, force_reference=True)
    assert "--force" not in next_command(["diagnose"], sound)


@pytest.mark.parametrize("leg", [1.0, 0.1, 0.47123889, 1234.5678])
def test_legs_are_cut_as_they_were(leg: float) -> None:
    """To the last digit: a little longer, and other legs are judged."""
    robot = wo.read_robot(RECORDING / "robot.yaml")
    again = pasted(next_command(["diagnose"], recordings_of(robot, RECORDING, leg=leg)))
    assert _parser(again).parse_args(again).leg == leg
