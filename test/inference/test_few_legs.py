# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Drives of a metre or two make too few legs of a metre: shorter ones tell what is missing."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import werrimbi_odom as wo
from test.inference.driven import common
from test.inference.test_gyro_bias import by_gyro
from test.model.drives import ROBOT
from test.robot_file import BARE
from werrimbi_odom.api.result import Result
from werrimbi_odom.errors import TooFewLegsError
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis
from werrimbi_odom.report.terminal import as_text


def slow(base: float, seed: int) -> Run:
    """A metre in 20 s with two gentle turns, by a gyro that walks by 0.1° from reading to reading.

    As the TurtleBot3s of docs/turtlebot3.md, until a hand held them.
    """
    still, side = np.zeros(60), np.sign(0.5 - seed % 2)
    speed = np.concatenate([still, np.full(400, 0.05), still])
    turn = 0.2 * np.ones(150)
    turning = side * np.concatenate([still, turn, np.zeros(100), -turn, still])
    run = by_gyro(speed, turning, base, 0.0, seed)
    assert run.reference is not None
    walk = np.cumsum(np.random.default_rng(seed).normal(0.0, 1.7e-3, run.reference.time.size))
    return replace(run, reference=replace(run.reference, yaw=run.reference.yaw + walk))


def told(base: float, folder: Path) -> Result[AdvisedDiagnosis]:
    path = folder / "robot.yaml"
    path.write_text(BARE, encoding="utf-8")
    return wo.diagnose(
        wo.read_robot(path), [slow(base, 1), slow(base, 2)], reference_kind="incremental"
    )


def held(run: Run, since: float) -> Run:
    """The drive with a hand that holds the robot from a time [s] on, while its wheels go on."""
    assert run.reference is not None
    time = run.reference.time
    yaw = np.interp(np.minimum(time, time[0] + since), time, run.reference.yaw)
    return replace(run, reference=replace(run.reference, yaw=yaw))


@pytest.fixture(autouse=True)
def library(monkeypatch: pytest.MonkeyPatch) -> None:
    effects = common("turn_dependent_track", "reference_scale", "reference_gyro_drift")
    monkeypatch.setattr("werrimbi_odom.effects.lookup.LIBRARY", effects)


def test_a_base_that_is_off_by_a_quarter_is_found_in_two_drives_of_a_metre(tmp_path: Path) -> None:
    """By legs of a metre the noise is a guess, and such a base was *unknown* on two real drives."""
    found = told(1.25, tmp_path)
    said = found.to_dict()
    words = " ".join(as_text(found.document().words).split())
    assert said["leg_m"] == 0.25
    base = said["calibration"]["wheel_separation_multiplier"]
    assert base["value"] == pytest.approx(1.25, abs=3.0 * base["std"])
    assert "track_width" in {said["effect"], *said["rivals"]}
    assert "Legs of 1 m are so few here that they do not tell the noise" in words
    assert "--leg 0.25" in words


@pytest.mark.evidence
def test_where_nothing_is_seen_it_says_that_the_noise_is_assumed(tmp_path: Path) -> None:
    found = told(1.0, tmp_path)
    words = " ".join(as_text(found.document().words).split())
    assert found.to_dict()["verdict"] == "none"
    assert "The legs are so few that their noise is assumed" in words
    # It printed "track_width seen from 1" beside the base of a quarter that is found above.
    assert "seen from" not in as_text(found.document().tables)
    assert "usual size" not in words


def test_what_was_held_is_no_leg() -> None:
    """Each pose in a held stretch ends a gap: with 20 a second three legs were enough."""
    drives = [held(slow(1.0, seed), 8.0) for seed in (1, 2)]
    with pytest.raises(TooFewLegsError, match=r"have \d legs? to fit, and 6 are the least"):
        diagnose(drives, ROBOT, common(), EvaluationOptions(reference_kind="incremental"))
