# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A marker off the axle, seen by positions alone from circles: found, on one side or the other."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from test.inference.driven import COMMON
from test.model.drives import ROBOT, read
from werrimbi_odom.effects import find
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.inference.adding.adding import add_effects
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis, diagnose
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis
from werrimbi_odom.model.trajectory import trajectory
from werrimbi_odom.report.adding.as_json import json_of as added_json
from werrimbi_odom.report.adding.words import words_of as added_words
from werrimbi_odom.report.diagnosis.as_json import json_of
from werrimbi_odom.report.diagnosis.next_steps import NextSteps
from werrimbi_odom.report.diagnosis.words import words_of
from werrimbi_odom.report.terminal import as_text

BEHIND = -0.06
RATE = 20
CIRCLES = ([(0.4, 26.0)], [(1.2, 50.0)], [(-0.4, 26.0)], [(-1.2, 50.0)])
"""Radii [m], left positive, and times [s] of each drive."""
WITH_A_LINE = ([(np.inf, 8.0), (0.4, 26.0)], [(np.inf, 8.0), (-0.4, 26.0)])


def driven(parts: list[tuple[float, float]], seed: int) -> Run:
    """Circles and lines at 0.3 m/s, between rests."""
    random = np.random.default_rng(seed)
    rest = np.zeros(RATE)
    turns = [np.full(int(RATE * seconds), 0.3 / radius) for radius, seconds in parts]
    turning = np.concatenate([rest, *turns, rest])
    speed = np.concatenate([rest, *(np.full(part.size, 0.3) for part in turns), rest])
    smooth = np.ones(8) / 8.0
    commands = [np.convolve(each, smooth, "same") for each in (speed, turning)]
    ticks = read(ROBOT, float(RATE), commands[0], commands[1])
    path = trajectory(ROBOT, *ticks)
    x = path.x + BEHIND * np.cos(path.yaw) + random.normal(0.0, 1e-3, path.x.size)
    y = path.y + BEHIND * np.sin(path.yaw) + random.normal(0.0, 1e-3, path.x.size)
    reference = Reference(path.time, x, y, np.full(x.size, np.nan))
    record = Ticks(ticks.time, ticks.left.astype(float), ticks.right.astype(float), {})
    return Run(f"run_{seed}", Path(f"run_{seed}"), record, reference)


def diagnosed(drives: tuple[list[tuple[float, float]], ...]) -> Diagnosis:
    return diagnose([driven(parts, seed) for seed, parts in enumerate(drives)], ROBOT, COMMON)


def ahead(found: Diagnosis) -> float:
    return next(item.values["x"] for item in found.robot.effects)


@pytest.mark.evidence
def test_circles_tell_the_distance_and_not_the_side() -> None:
    """At a marker on the axle the score is blind: a base and a load were named, for certain."""
    found = diagnosed(CIRCLES)
    assert found.found == ("reference_lever_arm",)
    assert abs(ahead(found)) == pytest.approx(abs(BEHIND), rel=0.1)
    assert found.ahead_or_behind
    words = " ".join(as_text(words_of(AdvisedDiagnosis(found, None, ()), NextSteps())).split())
    assert "may as well lie as far on the other side of the axle" in words
    assert json_of(found, None)["ahead_or_behind"] is True


@pytest.mark.evidence
def test_add_tells_that_the_side_is_open() -> None:
    """It wrote one sign, as certain as any."""
    runs = [driven(parts, seed) for seed, parts in enumerate(CIRCLES)]
    added = add_effects([find("reference_lever_arm")], runs, ROBOT)
    assert abs(added.fitted["reference_lever_arm"]["x"].value or 0.0) == pytest.approx(
        0.06, rel=0.1
    )
    words = " ".join(as_text(added_words(added)).split())
    assert "may as well lie as far on the other side of the axle" in words
    assert added_json(added)["ahead_or_behind"] is True


@pytest.mark.evidence
def test_a_line_and_a_curve_in_one_drive_tell_the_side() -> None:
    found = diagnosed(WITH_A_LINE)
    assert found.found == ("reference_lever_arm",)
    assert ahead(found) == pytest.approx(BEHIND, abs=2e-3)
    assert not found.ahead_or_behind
