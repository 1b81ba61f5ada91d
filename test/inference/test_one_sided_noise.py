# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Errors that follow no law, of one wheel alone, are the robot's; a reference has no side."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from test.evidence import in_evidence
from test.inference.test_homogeneity import ROBOT, Spoil, driven, nothing, wanders
from test.white_noise_robot import WhiteNoiseRobot, drive, wandering
from werrimbi_odom.effects import find
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis, diagnose
from werrimbi_odom.inference.diagnosis.forward_selection import fit_calibration
from werrimbi_odom.inference.diagnosis.one_sided_noise import one_sided_noise
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.legs.cutting import match_for_fit
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis
from werrimbi_odom.inference.manoeuvres.next_manoeuvre import next_manoeuvre
from werrimbi_odom.report.diagnosis.as_json import json_of
from werrimbi_odom.report.diagnosis.next_steps import NextSteps
from werrimbi_odom.report.diagnosis.words import words_of
from werrimbi_odom.report.terminal import as_text

TRUE = WhiteNoiseRobot(0.35, 0.05, 0.05, 4e-4, 4e-4)
EFFECTS = [find("unequal_wheel_radii"), find("wheel_radius_scale")]
LASTING = 3.0
"""For how long the grip of a wheel stays alike [s]."""


def gripping(seed: int, left: float, right: float) -> Run:
    """A drive on which the wheels roll by a share more or less, alike for some seconds."""
    random = np.random.default_rng(seed)
    seen = drive(TRUE, wandering(random, 50.0), random, sigma_xy=4e-4, sigma_yaw=1e-3, every=2)
    ticks = seen.ticks
    kept = np.exp(-np.diff(ticks.time, prepend=-np.inf) / LASTING)
    counts = []
    for share, side in ((left, ticks.left), (right, ticks.right)):
        grip = np.zeros(side.size)
        for row, new in enumerate(random.normal(size=side.size) * np.sqrt(1.0 - kept**2)):
            grip[row] = kept[row] * grip[row - 1] + new
        rolled = np.diff(side, prepend=side[0]) * (1.0 + share * grip)
        counts.append(np.floor(side[0] + np.cumsum(rolled)))
    return replace(
        seen, name=f"{seed}", path=Path(f"{seed}"),
        ticks=replace(ticks, left=counts[0], right=counts[1]),
    )  # fmt: skip


def changing(seed: int, left: float, right: float) -> Run:
    """A drive on which radii grow and shrink by a share, once in 40 s; each time from elsewhere."""
    random = np.random.default_rng(seed)
    seen = drive(TRUE, wandering(random, 90.0), random, sigma_xy=4e-4, sigma_yaw=1e-3, every=2)
    ticks = seen.ticks
    wave = np.sin(2.0 * np.pi * (ticks.time / 40.0 + random.random()))
    counts = [
        np.floor(side[0] + np.cumsum(np.diff(side, prepend=side[0]) * (1.0 + share * wave)))
        for share, side in ((left, ticks.left), (right, ticks.right))
    ]
    return replace(
        seen, name=f"{seed}", path=Path(f"{seed}"),
        ticks=replace(ticks, left=counts[0], right=counts[1]),
    )  # fmt: skip


@pytest.mark.parametrize(
    ("left", "right", "side", "said"),
    [
        (0.0, 0.015, "right", "look at the right wheel"),
        in_evidence(0.01, 0.01, "both", "look at the wheels"),
    ],
)
def test_radii_that_come_and_go_are_the_robot_s(
    left: float, right: float, side: str, said: str
) -> None:
    """It was "nothing is missing", and "so errs a reference that wanders"."""
    runs = [changing(seed, left, right) for seed in range(3)]
    found = diagnose(runs, TRUE.entered(0.05), EFFECTS)
    assert (found.verdict, found.found, found.wander) == ("unknown", (), None)
    assert found.one_sided is not None
    assert found.one_sided.side == side
    assert found.one_sided.along is not None
    told = " ".join(as_text(words_of(AdvisedDiagnosis(found, None, ()), NextSteps())).split())
    assert said in told
    assert "along the path" in told
    assert "wanders" not in told
    assert "nothing to add" not in told
    assert json_of(found, None)["one_sided_noise"]["side"] == side


@pytest.fixture(scope="module")
def found() -> Diagnosis:
    """Of a left wheel whose grip comes and goes."""
    runs = [gripping(seed, 0.02, 0.0) for seed in range(10, 13)]
    return diagnose(runs, TRUE.entered(0.05), EFFECTS)


def test_what_one_wheel_does_without_a_law_is_no_reference_that_wanders(found: Diagnosis) -> None:
    assert (found.verdict, found.found) == ("unknown", ())
    assert found.one_sided is not None
    assert found.one_sided.side == "left"
    assert found.one_sided.times > 6.0
    assert found.wander is None


def test_it_is_told_of_that_wheel_and_no_law_is_made_of_it(found: Diagnosis) -> None:
    said = " ".join(as_text(words_of(AdvisedDiagnosis(found, None, ()), NextSteps())).split())
    assert "the left wheel errs" in said
    assert "look at the left wheel" in said
    assert "wanders" not in said
    assert "nothing to add" not in said
    assert "draft" not in said
    assert next_manoeuvre(found) is None
    told = json_of(found, None)["one_sided_noise"]
    assert told["side"] == "left"
    assert told["left_wheel_noise"]["value"] > 6.0 * told["right_wheel_noise"]["value"]


@pytest.mark.parametrize("spoil", [nothing, wanders])
@pytest.mark.parametrize("first", [80, *(in_evidence(first) for first in range(90, 130, 10))])
def test_a_reference_has_no_side(spoil: Spoil, first: int) -> None:
    """Whatever it errs by; and wheels of which one is twice as noisy are a pair."""
    runs = [driven(seed, spoil, f"drive_{seed}") for seed in range(first, first + 3)]
    laid = concatenated(match_for_fit(runs, ROBOT, 1.0, None))
    fit = fit_calibration(laid, ROBOT)
    assert one_sided_noise(laid, fit) is None
