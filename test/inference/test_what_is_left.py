# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What is left with everything found, held against the reference's own noise."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from test.inference.driven import (
    COARSE,
    COMMON,
    NOISE_XY,
    NOISE_YAW,
    of_coarse_counts,
    run_of,
    runs_of,
)
from test.model.drives import ROBOT
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Reference, Run
from werrimbi_odom.inference.comparison.compare import compare
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis, diagnose
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis
from werrimbi_odom.report.diagnosis import as_json
from werrimbi_odom.report.diagnosis.remarks import left_is_noise

HOW = EvaluationOptions(leg=0.5)


def diagnosed(fitted: list[Run], judged: list[Run]) -> Diagnosis:
    return diagnose(fitted, ROBOT, COMMON[:4], HOW, holdout=judged)


def said_of(found: Diagnosis) -> str:
    return " ".join(left_is_noise(AdvisedDiagnosis(found, None, (), HOW.leg)))


def with_headings_off(run: Run, off: np.ndarray) -> Run:
    seen = run.reference
    assert seen is not None
    assert seen.yaw is not None
    return replace(run, reference=Reference(seen.time, seen.x, seen.y, seen.yaw + off))


def test_of_a_sound_robot_it_is_the_references_own_noise_and_white() -> None:
    found = diagnosed(runs_of(ROBOT, (1, 2)), runs_of(ROBOT, (3,)))
    left = found.left
    assert left is not None
    assert left.is_noise
    assert not left.not_white
    by_hand = math.sqrt(4.0 * NOISE_XY**2 + (NOISE_YAW * HOW.leg) ** 2)
    assert left.holdout.reference == pytest.approx(by_hand, rel=0.2)
    assert left.holdout.error == pytest.approx(left.holdout.reference, rel=0.2)
    assert "is the reference's own noise" in said_of(found)
    assert "it is white" in said_of(found)
    assert as_json.json_of(found, None)["left"]["is_reference_noise"]


def test_an_error_of_the_robot_is_not_the_references_noise() -> None:
    """Wheels that err by twice the softest that roll, which the reference has no part in."""
    random = np.random.default_rng(4)
    runs = []
    for seed in (1, 2, 3):
        run = run_of(ROBOT, seed)
        rolled = [np.diff(side, prepend=side[0]) for side in (run.ticks.left, run.ticks.right)]
        slipped = [
            np.cumsum(part + 0.05 * np.abs(part) * random.standard_normal(part.size))
            for part in rolled
        ]
        runs.append(replace(run, ticks=replace(run.ticks, left=slipped[0], right=slipped[1])))
    found = diagnosed(runs[:2], runs[2:])
    assert found.left is not None
    assert found.left.holdout.error > 1.5 * found.left.holdout.reference
    assert not said_of(found)
    assert not as_json.json_of(found, None)["left"]["is_reference_noise"]


def with_headings_that_wander(share: float) -> list[Run]:
    """By this share of their noise, alike over 8 poses."""
    random = np.random.default_rng(5)
    runs = []
    for run in runs_of(ROBOT, (1, 2, 3)):
        assert run.reference is not None
        slow = np.convolve(random.standard_normal(run.reference.time.size), np.ones(8), "same")
        runs.append(with_headings_off(run, share * NOISE_YAW / math.sqrt(8.0) * slow))
    return runs


def test_an_error_that_lasts_is_not_called_white() -> None:
    """Too small to be told as a wander of the reference."""
    runs = with_headings_that_wander(0.55)
    found = diagnosed(runs[:2], runs[2:])
    assert found.wander is None
    assert found.left is not None
    assert found.left.not_white


@pytest.mark.evidence
def test_with_a_wander_that_is_told_what_is_left_is_white() -> None:
    runs = with_headings_that_wander(0.7)
    found = diagnosed(runs[:2], runs[2:])
    assert found.wander is not None
    assert found.left is not None
    assert found.left.is_noise
    assert not found.left.not_white


def test_noise_that_is_only_assumed_is_held_against_nothing() -> None:
    """A pose every 6 s: too few differences to tell the noise by."""
    rare = []
    for run in runs_of(ROBOT, (1, 2, 3), 120):
        seen = run.reference
        assert seen is not None
        every = slice(None, None, 30)
        poses = [part[every] for part in (seen.time, seen.x, seen.y, seen.yaw) if part is not None]
        rare.append(replace(run, reference=Reference(*poses)))
    assert diagnosed(rare[:2], rare[2:]).left is None


def test_coarse_counters_do_not_hide_the_references_own_noise() -> None:
    """A reference is no better because the wheels' counts are worse: 20 of them in a turn."""
    runs = [of_coarse_counts(seed) for seed in (1, 2)]
    ((_, noise),) = compare(runs, COARSE, HOW).prepared.noises
    assert noise.sigma_xy == pytest.approx(NOISE_XY, rel=0.3)
    # A bound: this robot begins its turns at once, which the differences of the path hold too.
    assert 0.9 * NOISE_YAW < noise.sigma_yaw < 2.0 * NOISE_YAW
