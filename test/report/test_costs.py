# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What an effect costs, what base and radii do beside it, and what is left with both."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from test.inference.driven import COMMON, run_of, swapped
from test.inference.test_local_map_errors import TRUE, session
from test.model.drives import ROBOT
from werrimbi_odom.effects import find
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.adding.adding import add_effects
from werrimbi_odom.inference.calibration.any_driving import calibrate
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis, diagnose
from werrimbi_odom.inference.diagnosis.estimated_values import best_sizes, ranked_of
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS
from werrimbi_odom.inference.legs.cutting import match_for_fit
from werrimbi_odom.report.calibration.fit_words import fit_in_words
from werrimbi_odom.report.diagnosis.costs import cost, whole
from werrimbi_odom.report.diagnosis.next_steps import NextSteps
from werrimbi_odom.report.diagnosis.reference_remarks import as_one_that_wanders
from werrimbi_odom.report.diagnosis.words import words_of
from werrimbi_odom.report.phrases import sizes_words
from werrimbi_odom.report.terminal import as_text


def late_and_one_wheel_larger(seed: int) -> Run:
    """A reference 20 ms late; the right wheel rolls 1 % more, and 3 % more from 45 s on."""
    seen = run_of(ROBOT, seed)
    assert seen.reference is not None
    late = replace(seen.reference, time=seen.reference.time + 0.02)
    rolled = np.diff(seen.ticks.right, prepend=seen.ticks.right[0])
    rolled = rolled / np.where(seen.ticks.time > seen.ticks.time[0] + 45.0, 1.03, 1.01)
    right = seen.ticks.right[0] + np.rint(np.cumsum(rolled))
    return replace(seen, ticks=replace(seen.ticks, right=right), reference=late)


@cache
def late() -> Diagnosis:
    return diagnose([late_and_one_wheel_larger(seed) for seed in (1, 2)], ROBOT, COMMON)


def told(diagnosis: Diagnosis) -> Any:
    return SimpleNamespace(
        diagnosis=diagnosis, held_out=(), leg=1.0, changes=(), sights=(), manoeuvre=None,
        open_at=None,
    )  # fmt: skip


def test_what_a_late_clock_costs_is_not_what_a_wheel_too_large_does() -> None:
    """2.9 mm a metre were said to be its cost, of 1 mm at most: the radius had done all."""
    found = late()
    assert found.found[0] == "reference_delay"
    ranked = ranked_of(found, "reference_delay")
    assert ranked is not None
    assert ranked.holdout is not None
    assert ranked.holdout.before < 0.9 * found.holdout.before
    (said,) = cost(told(found), "reference_delay")
    assert "(base and radii fitted in both)" in said
    (said,) = whole(told(found))
    assert "put in, the position error" in said


def test_what_no_effect_explains_is_told_beside_what_is_named() -> None:
    """One thing was missing; then `add` said that something is still missing (p = 2e-32)."""
    found = late()
    assert found.verdict == "named"
    assert found.misfit is not None
    assert found.misfit.cell.channel == "right"
    said = as_text(words_of(told(found), NextSteps()))
    assert "something is left" in said
    assert "how far the right wheel rolls" in said


def test_the_noise_of_a_model_that_does_not_fit_is_said_to_hold_what_is_missing() -> None:
    """A camera that wanders made k 8 times the truth, without a word."""
    runs = match_for_fit([late_and_one_wheel_larger(seed) for seed in (1, 2)], ROBOT, 1.0)
    found = calibrate(runs, ROBOT)
    assert found.misfit
    assert found.changes["right_wheel_noise"] == found.noises["right_wheel_noise"].value
    said = " ".join(as_text(fit_in_words(found)).split())
    assert "fit that noise again when a model explains the drives" in said
    assert "--reference-kind local_map" in said


@pytest.mark.parametrize(("kind", "asked"), [("absolute", True), ("local_map", False)])
def test_where_the_reference_wanders_its_kind_is_the_next_step(kind: str, asked: bool) -> None:
    """`calibrate fit` said to diagnose, `diagnose` said to calibrate: none said how."""
    point = SimpleNamespace(options=SimpleNamespace(reference_kind=kind))
    wandering: Any = SimpleNamespace(final=SimpleNamespace(point=point))
    said = " ".join(as_one_that_wanders(wandering, NextSteps().on_map))
    assert ("Next: there is nothing to add" in said) == asked
    assert ("--reference-kind local_map" in said) == asked


def test_a_base_off_is_told_beside_wheels_that_are_exchanged() -> None:
    """Base 3 % larger, wheels exchanged: `add` found it to 0.01 %, `diagnose` had no line of it."""
    truth = replace(ROBOT, wheel_separation_multiplier=1.03)
    runs = [run_of(truth, seed, 60) for seed in (1, 2)]
    runs = [swapped(run) for run in runs]
    found = diagnose(runs, ROBOT, COMMON)
    assert found.verdict == "ambiguous"
    value, std = best_sizes(found)["wheel_separation_multiplier"]
    assert std is not None
    assert 0.0 < std < 0.003
    assert abs(value - 1.03) < 3.0 * std
    said = " ".join(as_text(words_of(told(found), NextSteps())).split())
    assert "On the robot, if it is wheels_swapped: wheel base 3.0" in said


@pytest.mark.parametrize(
    ("std", "ratio_std", "said"),
    [
        (0.011, 2e-4, "right over left radius 1.000 ± 0.020 % larger, both radii known"),
        (0.002, 2e-4, "left wheel right as it is, right wheel 1.00 ± 0.20 % larger"),
        (0.011, 0.01, "left wheel right as it is, right wheel 1.0 ± 1.1 % larger"),
    ],
)
def test_wheels_within_their_uncertainty_are_told_by_a_ratio_that_is_sure(
    std: float, ratio_std: float, said: str
) -> None:
    """Left right as it is, right 1.0 +- 1.1 % larger, beside a ratio known to 0.02 %."""
    found = dict(zip(MULTIPLIERS, [(1.03, 0.01), (1.0, 0.0), (1.01, std)], strict=True))
    words = sizes_words(replace(ROBOT, wheel_separation=0.3), found, ratio_std)
    assert words.startswith("wheel base 3.0 ± 1.0 % larger (309.0 mm), ")
    assert said in words


@pytest.mark.evidence
def test_that_a_camera_s_metre_may_be_why_is_said_before_anything_is_added() -> None:
    """Base and radii 1.5 % smaller were written for a camera that shows 1.5 % too little."""
    runs = []
    for seed in (1, 2):
        run = run_of(ROBOT, seed)
        seen = run.reference
        assert seen is not None
        runs.append(replace(run, reference=replace(seen, x=0.985 * seen.x, y=0.985 * seen.y)))
    found = diagnose(runs, ROBOT, COMMON)
    assert set(found.found) == {"wheel_radius_scale", "track_width"}
    said = " ".join(as_text(words_of(told(found), NextSteps())).split())
    assert said.index("beside a tape") < said.index("Next: measure that first.")
    assert said.index("Next: measure that first.") < said.index("werrimbi add wheel_radius_scale,")
    assert "write reference_scale with multiplier 0.98" in said
    by_hand = replace(ROBOT, effects=(find("reference_scale").using(multiplier=0.985),))
    assert diagnose(runs, by_hand, COMMON).verdict == "none"


@pytest.mark.evidence
def test_noise_alone_leaves_no_more_than_there_is_though_the_file_lacks_a_delay() -> None:
    """Noise alone was to make 9.2 mm of errors of 3.3: the late clock was in the wander."""
    drives = [
        replace(run, reference=replace(run.reference, time=run.reference.time + 0.15))
        for run in session(range(40, 42), jumps=0, seconds=45.0)
        if run.reference is not None
    ]
    how = EvaluationOptions(reference_kind="local_map")
    added = add_effects([find("reference_delay")], drives, TRUE.entered(), how)
    assert added.explained
    for side in (added.train, added.holdout):
        assert 0.6 * side.error("after") < added.noise_alone(side) < 1.5 * side.error("after")
