# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What compare_node's looks say of a robot that became another one while it was watched."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import werrimbi_odom as wo
from test.cli.commands import RECORDING
from test.white_noise_robot import WhiteNoiseRobot, drive, wandering
from werrimbi_odom.api.drives import recordings_of
from werrimbi_odom.api.live_diagnosis import halves, of_now
from werrimbi_odom.api.next_command import next_command
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.inference.legs.gaps import LeftOut
from werrimbi_odom.report.phrases import left_out_words
from werrimbi_odom.simulation.robot import TrueRobot, write_robot_file

SOUND = WhiteNoiseRobot(0.35, 0.05, 0.05, 4.0e-4, 5.8e-4)
WIDER = replace(SOUND, separation=SOUND.separation * 1.02)


def driven(robot: WhiteNoiseRobot, name: str, seed: int, seconds: float) -> Run:
    rng = np.random.default_rng(seed)
    return replace(drive(robot, wandering(rng, seconds), rng), name=name, path=Path(name))


@pytest.mark.evidence
@pytest.mark.usefixtures("few_effects")
def test_what_set_in_is_told_by_the_younger_half_alone(tmp_path: Path) -> None:
    """All of it is unknown, or a mean of two robots."""
    write_robot_file(TrueRobot(left_wheel_noise=4.0e-4, right_wheel_noise=5.8e-4), tmp_path / "r")
    file = wo.read_robot(tmp_path / "r")
    drives = [driven(SOUND, "older_half", 1, 30.0), driven(WIDER, "younger_half", 2, 30.0)]
    whole = wo.diagnose(file, drives)
    assert whole.to_dict()["changes"], "else there is nothing to be told"
    now, of = of_now(whole, file, drives, {})
    assert now.to_dict()["effect"] == "track_width"
    assert [each.name for each in of] == ["younger_half"]


@pytest.mark.evidence
def test_a_robot_that_is_as_it_was_is_told_by_all_of_its_drives(tmp_path: Path) -> None:
    write_robot_file(TrueRobot(left_wheel_noise=4.0e-4, right_wheel_noise=5.8e-4), tmp_path / "r")
    file = wo.read_robot(tmp_path / "r")
    drives = [driven(WIDER, "older_half", 3, 100.0), driven(WIDER, "younger_half", 4, 100.0)]
    whole = wo.diagnose(file, drives)
    assert of_now(whole, file, drives, {}) == (whole, drives)


def test_a_counter_that_begins_anew_is_no_travel() -> None:
    """Halves are of equal travel, wherever a counter of 16 bits begins anew."""
    time = np.arange(101.0)
    counts = 100 * np.arange(101)
    poses = Reference(time, 0.01 * time, 0.0 * time, 0.0 * time)
    # Both begin anew after a tenth of the way.
    ticks = Ticks(time, *2 * [(counts + 2**15 - 1000 + 2**15) % 2**16 - 2**15])
    older, younger = halves(Run("drive", Path("drive"), ticks, poses), 16)
    assert older.ticks.time[-1] == younger.ticks.time[0] == 50.0


def test_what_is_told_of_a_half_says_which() -> None:
    """A stretch left out of the younger half; in a command both are what a user recorded."""
    robot = wo.read_robot(RECORDING / "robot.yaml")
    both = halves(wo.read_run(RECORDING, robot), 0)
    left_out = [LeftOut(half.path, 1.0, 2.0, "gap", "the reference is silent") for half in both]
    said = left_out_words(left_out)
    assert [" of older_half " in words for words in said] == [True, False]
    assert [" of younger_half " in words for words in said] == [False, True]
    command = next_command(["diagnose"], recordings_of(robot, both))
    assert command.split("\n")[-1].split() == ["RUN..."]
