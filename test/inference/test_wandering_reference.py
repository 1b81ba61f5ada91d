# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A localiser that is taken as absolute: it is told, and its slow error is no effect's."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from test.evidence import in_evidence
from test.inference.driven import parts
from test.inference.test_homogeneity import ROBOT, driven, nothing, wanders
from test.inference.test_local_map_errors import MEMORY, TRUE, WALK, session
from werrimbi_odom.api.compare_diagnose_add import as_judged
from werrimbi_odom.effects.lookup import find
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.recordings import DriveOptions, Recordings
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis, diagnose
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.report.diagnosis.next_steps import NextSteps
from werrimbi_odom.report.diagnosis.reference_remarks import wandering
from werrimbi_odom.report.diagnosis.words import words_of

NAMES = ("floor_slope", "anisotropic_floor", "reference_delay", "track_width", "sideways_drift")
EFFECTS = [find(name) for name in (*NAMES, "unequal_wheel_radii", "wheel_radius_scale")]


def seen_by_a_localiser(robot: Robot, effects: Sequence[Effect] = EFFECTS) -> Diagnosis:
    return diagnose(
        session(range(40, 43), jumps=0, seconds=45.0), robot, effects, EvaluationOptions()
    )


@pytest.fixture(scope="module")
def sound() -> Diagnosis:
    return seen_by_a_localiser(TRUE.entered())


@pytest.mark.evidence
def test_a_localiser_taken_as_absolute_names_nothing_false(sound: Diagnosis) -> None:
    assert (sound.verdict, sound.found) == ("none", ())
    assert sound.wander is not None
    assert sound.wander.place_in_a_second == pytest.approx(WALK[0], rel=0.2)
    assert 0.5 * WALK[1] < sound.wander.heading_in_a_second < 2.0 * WALK[1]


@pytest.mark.evidence
def test_it_is_said_and_what_follows_reckons_with_it(sound: Diagnosis) -> None:
    said = " ".join(str(each) for each in words_of(AdvisedDiagnosis(sound, None, ()), NextSteps()))
    assert "--reference-kind local_map" in said
    given = Recordings(SimpleNamespace(), SimpleNamespace(), (), (), DriveOptions())  # type: ignore[arg-type]
    assert as_judged(given, sound).how.reference_kind == "local_map"
    assert as_judged(given, replace(sound, wander=None)) is given


@pytest.mark.evidence
def test_an_antenna_has_no_heading_that_wanders() -> None:
    """Its size was the prior's: two degrees, said of positions alone."""
    drives = [parts(run, "positions") for run in session(range(50, 53), jumps=0, seconds=45.0)]
    found = diagnose(drives, TRUE.entered(), [find("track_width")])
    assert found.wander is not None
    assert (found.wander.heading, found.wander.heading_in_a_second) == (None, None)
    assert found.wander.place_in_a_second == pytest.approx(WALK[0], rel=0.2)
    [said] = wandering(found)
    assert "mm in a second" in said
    assert "°" not in said
    assert "rad" not in said


def satellites(time: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """A metre and a half that is alike for half a minute."""
    keeps = np.exp(-np.diff(time, prepend=time[0]) / 30.0)
    new = random.normal(size=(time.size, 3)) * np.sqrt(1.0 - keeps**2)[:, None]
    new[0] = random.normal(size=3)
    error = np.zeros((time.size, 3))
    for row in range(time.size):
        error[row] = keeps[row] * error[row - 1] + new[row]
    return 1.5 * error


@pytest.mark.evidence
def test_positions_of_satellites_are_no_law_of_the_floor() -> None:
    """No typical localiser wanders by decimetres in a second, and what was left was *unknown*."""
    drives = []
    for seed in range(60, 63):
        run = parts(driven(seed, satellites, f"drive_{seed}", seconds=200.0), "positions")
        assert run.reference is not None
        once = run.reference.chosen(np.arange(run.reference.time.size) % 12 == 0)
        drives.append(replace(run, reference=once))
    found = diagnose(drives, ROBOT, EFFECTS[2:4])
    assert (found.verdict, found.found) == ("none", ())
    assert found.wander is not None
    assert found.wander.place_in_a_second == pytest.approx(1.5 * math.sqrt(2.0 / 30.0), rel=0.3)


@pytest.mark.parametrize("effects", [EFFECTS[2:4], in_evidence(EFFECTS)])
def test_what_is_really_wrong_is_named_beside_it(effects: Sequence[Effect]) -> None:
    robot = replace(TRUE.entered(), wheel_separation_multiplier=1.05)
    wide = seen_by_a_localiser(robot, effects)
    assert wide.wander is not None
    assert wide.found == ("track_width",)


@pytest.mark.evidence
def test_a_mount_askew_is_not_taken_for_wander() -> None:
    """The wander, fitted without it, grows and lasts until it is most of that angle."""
    turned = [
        replace(run, reference=replace(run.reference, yaw=run.reference.yaw + 0.03))
        for run in session(range(40, 43), jumps=0, seconds=45.0)
        if run.reference is not None
    ]
    found = diagnose(turned, TRUE.entered(), [*EFFECTS, find("reference_yaw_offset")])
    assert found.wander is not None
    assert found.wander.seconds < 2.0 * MEMORY
    assert set(found.found) <= {"reference_yaw_offset", "sideways_drift"}
    assert found.found


@pytest.mark.evidence
def test_motion_capture_that_errs_alike_is_no_unknown_law() -> None:
    """Here it was one of the distance: errors that are alike go with something by chance."""
    drives = [
        driven(seed, lambda at, random: 0.2 * wanders(at, random), f"drive_{seed}", seconds=25.0)
        for seed in range(209, 212)
    ]
    found = diagnose(drives[:2], ROBOT, EFFECTS[:2], holdout=drives[2:])
    assert (found.verdict, found.found) == ("none", ())
    assert found.wander is not None


@pytest.mark.evidence
def test_motion_capture_that_errs_alike_for_seconds_is_told() -> None:
    """By a fifth of what a camera's map does, which is no more than the noise of its poses."""
    drives = [
        driven(seed, lambda time, random: 0.2 * wanders(time, random), f"drive_{seed}")
        for seed in range(80, 84)
    ]
    found = diagnose(drives[:3], ROBOT, EFFECTS, holdout=drives[3:])
    assert found.wander is not None
    assert (found.verdict, found.found) == ("none", ())
    assert 0.5 < found.wander.heading / 1.6e-3 < 2.0
    assert found.left is not None
    assert not found.left.not_white, "what was alike is told"


@pytest.mark.evidence
@pytest.mark.parametrize("hotter", [0.0, 0.02])
def test_independent_errors_stay_absolute_whatever_the_library_lacks(hotter: float) -> None:
    *drives, apart = [
        driven(seed, nothing, f"drive_{seed}", hotter, seconds=40.0) for seed in (90, 91, 92, 94)
    ]
    found = diagnose(drives, ROBOT, EFFECTS, holdout=[apart])
    assert found.verdict == ("unknown" if hotter else "none")
    assert found.wander is None
    assert found.final.point.options.reference_kind == "absolute"
