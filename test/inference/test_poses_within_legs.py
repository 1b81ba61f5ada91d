# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Fits use each pose of a reference, as long as its error is new in each."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from test.white_noise_robot import WhiteNoiseRobot, drive, wandering
from werrimbi_odom.effects import find
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.adding.adding import add_effects
from werrimbi_odom.inference.comparison.prepared import PreparedRuns, finely, prepare

ROBOT = WhiteNoiseRobot(left_noise=4e-4, right_noise=5e-4)


def drives(seconds: float = 60.0, count: int = 4, **sensor: float) -> list[Run]:
    """Calm drives with a pose of motion capture 17 times a second."""
    random = np.random.default_rng(5)
    return [
        replace(drive(ROBOT, wandering(random, seconds), random, **sensor), name=f"drive {number}")
        for number in range(count)
    ]


def prepared(runs: list[Run], **options: object) -> PreparedRuns:
    return prepare(runs, ROBOT.entered(), EvaluationOptions(**options))


def with_slow_error(run: Run, seconds: float, sigma: float) -> Run:
    """An error of the reference that lasts, drawn back to zero, in each of its axes."""
    reference, random = run.reference, np.random.default_rng(len(run.name))
    assert reference is not None
    stay = float(np.exp(-np.diff(reference.time).mean() / seconds))
    slow = np.zeros((2, reference.time.size))
    for row in range(1, reference.time.size):
        new = sigma * np.sqrt(1.0 - stay**2) * random.standard_normal(2)
        slow[:, row] = stay * slow[:, row - 1] + new
    moved = replace(reference, x=reference.x + slow[0], y=reference.y + slow[1])
    return replace(run, reference=moved)


def test_short_drives_with_independent_poses_are_fitted_by_each_pose() -> None:
    given = prepared(drives())
    poses = sum(run.reference.time.size for run in given.runs if run.reference)
    assert given.parts > 5 * rules.PARTS_OF_A_LEG
    assert 0.5 * poses < finely(given).begin.size <= rules.LEGS_OF_A_FIT


@pytest.mark.parametrize("lasting_s", [0.3, 1.0])
def test_an_error_that_lasts_longer_than_a_pose_is_not_averaged_away(lasting_s: float) -> None:
    slow = [with_slow_error(run, lasting_s, 2e-3) for run in drives()]
    assert prepared(slow).parts == rules.PARTS_OF_A_LEG


def test_many_drives_are_fitted_by_longer_legs() -> None:
    parts = [prepared(drives(60.0, count)).parts for count in (2, 8)]
    assert parts[0] > parts[1] > rules.PARTS_OF_A_LEG


@pytest.mark.parametrize("kind", ["incremental", "local_map"])
def test_a_reference_whose_error_goes_on_keeps_the_usual_legs(kind: str) -> None:
    assert prepared(drives(30.0, 2), reference_kind=kind).parts == rules.PARTS_OF_A_LEG


def test_each_pose_tells_where_the_marker_points(monkeypatch: pytest.MonkeyPatch) -> None:
    """A mount askew is found twice as well as by the poses at the ends of the usual legs."""
    askew = 5e-3
    turned = [
        replace(run, reference=replace(run.reference, yaw=run.reference.yaw + askew))
        for run in drives(30.0)
        if run.reference is not None
    ]
    found = {}
    for most in (rules.LEGS_OF_A_FIT, 0):
        monkeypatch.setattr(rules, "LEGS_OF_A_FIT", most)
        mount = [find("reference_yaw_offset")]
        added = add_effects(mount, turned[:3], ROBOT.entered(), holdout=turned[3:])
        found[most] = added.parameters["angle"]
    every, ends = found.values()
    assert every.value is not None
    assert every.std is not None
    assert ends.std is not None
    assert abs(every.value - askew) < 4.0 * every.std
    assert every.std < 0.6 * ends.std
