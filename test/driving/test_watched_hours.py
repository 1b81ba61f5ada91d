# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Hours of driving in the engine, looked at as compare_node does: five minutes and the last five.

No alarm where nothing is hidden; what sets in is named by the second look. By the node itself, for
hours: `test.ros.watched_hours`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("mujoco", reason="needs mujoco (pip install werrimbi_odom[all])")

import werrimbi_odom as wo
from test.driving.in_engine import LIMITS, InEngine
from werrimbi_odom.driving.manoeuvres import BEFORE
from werrimbi_odom.driving.plan import ManoeuvrePlan, Move
from werrimbi_odom.files.robot_files.robot_file import RobotFile
from werrimbi_odom.files.run import Run
from werrimbi_odom.simulation import LiveRobot, Peculiarity, TrueRobot, hide, write_robot_file

MINUTES = 5.0
"""Of driving between two looks: compare_node's own."""
TRUTH = TrueRobot(left_wheel_noise=4.0e-4, right_wheel_noise=5.8e-4)


def patrol(rng: np.random.Generator) -> ManoeuvrePlan:
    """Lines, curves and turns as they come, for as long as between two looks; hardly any back."""
    moves = [BEFORE]
    while ManoeuvrePlan("patrol", "", tuple(moves)).duration(LIMITS) < 60.0 * MINUTES:
        kind = rng.random()
        turn = float(rng.uniform(-0.5, 0.5) * math.pi)
        length = float(rng.uniform(0.5, 2.5)) if kind < 0.75 else 0.0
        if kind < 0.08:
            length = -0.4
        moves.append(Move(length, 0.0 if kind < 0.4 else turn, float(rng.uniform(0.5, 1.0))))
    return ManoeuvrePlan("patrol", "a patrol", tuple(moves))


def drives(hidden: list[Peculiarity], seed: int, folder: Path) -> tuple[RobotFile, Iterator[Run]]:
    """A robot's file, and its patrols one after the other, without end."""
    path = folder / f"robot_{len(hidden)}.yaml"
    write_robot_file(TRUTH, path)
    file, rng = wo.read_robot(path), np.random.default_rng(seed)
    there = InEngine(LiveRobot(TRUTH, seed=seed, hidden=hidden), file)

    def driven() -> Iterator[Run]:
        while True:
            run, driver = there.drive(patrol(rng))
            assert driver.state == "done", driver.words
            yield run

    return file, driven()


def looks(file: RobotFile, runs: Iterator[Run]) -> Iterator[tuple[str, tuple[str, ...], int]]:
    """Verdict, names and how many changes, of each pair of neighbours."""
    for pair in pairwise(runs):
        said = wo.diagnose(file, list(pair)).to_dict()
        names = said["rivals"] or [each["effect"] for each in said["found"]]
        yield said["verdict"], tuple(names), len(said["changes"])


@pytest.mark.evidence
def test_an_hour_without_anything_hidden_has_no_alarm(tmp_path: Path) -> None:
    file, runs = drives([], 4401, tmp_path)
    found = [look for look, _ in zip(looks(file, runs), range(11), strict=False)]
    assert found == [("none", (), 0)] * 11


@pytest.mark.evidence
@pytest.mark.parametrize("name", ["castor_kick=-0.02", "unequal_wheel_radii=1.01"])
def test_what_sets_in_is_named_by_the_second_look(name: str, tmp_path: Path) -> None:
    effect, _, strength = name.partition("=")
    file, sound = drives([], 4402, tmp_path)
    _, ill = drives([hide(effect, float(strength), seed=1).peculiarity], 4403, tmp_path)
    runs = iter([next(sound), next(ill), next(ill)])
    _, second = looks(file, runs)
    assert second[:2] == ("named", (effect,))
