# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Two poses a drive: what they cannot tell is said, before and after an effect is added."""

from __future__ import annotations

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from werrimbi_odom.report.diagnosis.told import Told

from test.inference.driven import run_of
from werrimbi_odom.effects import LIBRARY, find
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.adding.adding import Added, add_effect
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis, diagnose
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.report.adding.words import json_of as json_of_added
from werrimbi_odom.report.adding.words import words_of as words_of_added
from werrimbi_odom.report.diagnosis.as_json import json_of
from werrimbi_odom.report.diagnosis.tables import tables_of
from werrimbi_odom.report.diagnosis.words import NextSteps, words_of

PLAIN = Robot(0.35, 0.05, 2000.0, 2000.0, left_wheel_noise=4e-4, right_wheel_noise=4e-4)
KICKING = find("castor_kick").using(angle=0.0, alternating=0.02, length=0.04)


def by_tape(run: Run) -> Run:
    """The first pose and the last."""
    assert run.reference is not None
    ends = np.array([0, run.reference.time.size - 1])
    return replace(run, reference=replace(run.reference.chosen(ends)))


@pytest.fixture(scope="module")
def runs() -> list[Run]:
    return [by_tape(run_of(replace(PLAIN, effects=(KICKING,)), seed, 40)) for seed in range(12)]


def diagnosed(runs: list[Run], robot: Robot) -> Diagnosis:
    return diagnose(runs[:9], robot, LIBRARY, holdout=runs[9:])


@pytest.fixture(scope="module")
def first(runs: list[Run]) -> Diagnosis:
    return diagnosed(runs, PLAIN)


@pytest.fixture(scope="module")
def kick(runs: list[Run]) -> Added:
    return add_effect(find("castor_kick"), runs[:9], PLAIN, holdout=runs[9:])


def test_a_length_that_they_do_not_hold_is_no_number(first: Diagnosis, kick: Added) -> None:
    assert "castor_kick" in (*first.found, *first.rivals)
    assert "castor_kick.length not determined" in " ".join(tables_of(first).split())
    assert kick.parameters["length"].value is None
    assert kick.robot.effects[0].values["length"] == find("castor_kick").nulls["length"]
    assert "length = not determined by these drives, left at 40 mm" in words_of_added(kick)
    figures = json_of_added(kick)["parameters"]["length"]
    assert figures["value"] is figures["std"] is None


def test_rivals_are_not_forgotten_when_one_of_them_is_added(
    runs: list[Run], first: Diagnosis, kick: Added
) -> None:
    assert first.verdict == "ambiguous"
    later = diagnosed(runs, kick.robot)
    assert later.verdict == "none"
    others = later.rivals_of_held["castor_kick"]
    assert set(others) & set(first.rivals)
    words = " ".join(words_of(Told(later, None, ()), NextSteps()).split())
    assert "that it is castor_kick, which the robot file holds, these drives do not show" in words
    assert all(name in words for name in others)


def test_drives_that_tell_have_no_rivals_to_recall(kick: Added) -> None:
    runs = [run_of(replace(PLAIN, effects=(KICKING,)), seed, 40) for seed in range(4)]
    robot = replace(PLAIN, effects=(KICKING,))
    found = diagnose(runs[:3], robot, LIBRARY, holdout=runs[3:])
    assert found.verdict == "none"
    assert found.rivals_of_held == {}


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_whatever_a_reference_says_no_number_is_beyond_sense(seed: int) -> None:
    """Poses by chance: what is printed of them stays within what the parameters allow."""
    random = np.random.default_rng(seed)
    runs = []
    for number in range(5):
        run = by_tape(run_of(PLAIN, 10 * seed + number, 20))
        assert run.reference is not None
        x, y = random.uniform(-2.0, 2.0, (2, 2))
        seen = replace(run.reference, x=x, y=y, yaw=random.uniform(-3.0, 3.0, 2))
        runs.append(replace(run, reference=seen))
    found = diagnose(runs[:4], PLAIN, LIBRARY, holdout=runs[4:])
    said = words_of(Told(found, None, ()), NextSteps()) + tables_of(found)
    assert "nan" not in said.lower()
    assert not re.search(r"± \d(\.\d+)?e\+", said)
    for name in found.found:
        for parameter, item in json_of(found, None, ())["found"][0]["parameters"].items():
            low, high = find(name).parameters[parameter].bounds
            assert item["std"] is None or math.isnan(item["std"]) or item["std"] <= high - low
