# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Effects that hold only beside one another: of each alone the parts of the drives disagree."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from test.evidence import in_evidence
from test.inference.driven import COMMON, run_by, run_of, runs_of
from test.model.drives import ROBOT
from werrimbi_odom.effects import find
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.inference.comparison.prepared_runs import for_fit
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.inference.diagnosis.forward_selection import (
    Round,
    best_of_each,
    fit_calibration,
    fitted_beside,
    refit_to_rest,
    search_round,
)
from werrimbi_odom.inference.diagnosis.holdout import begin
from werrimbi_odom.inference.diagnosis.sequential_replacement import reconsidered
from werrimbi_odom.inference.fitting.candidate import Candidate
from werrimbi_odom.inference.fitting.candidate_starts import started_with
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.free_parameters import CALIBRATION
from werrimbi_odom.inference.fitting.score_tests import candidates, scores
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.simulation import TrueRobot, free, record, write_run
from werrimbi_odom.simulation.robot import write_robot_file

PLAIN = Robot(0.35, 0.05, 2000.0, 2000.0, left_wheel_noise=4e-4, right_wheel_noise=4e-4)

AHEAD, LEFT, ASKEW = 0.11, -0.012, 0.032
TWINS = {"sideways_drift": "reference_yaw_offset"}
"""An axle askew is to every reference a mount askew."""
EARLY, DRIFT = 0.07, 0.025
"""Of the headings [s], and of all positions along x, for each metre driven."""


@pytest.mark.evidence
def test_a_mount_a_clock_and_a_drift_are_found_in_one_short_drive(tmp_path: Path) -> None:
    """A student's robot under motion capture: 70 s, and nothing of its reference is right.

    Of the lever arm beside the headings, which are early, the parts disagreed, by what the drift
    and the mount's angle did: two were named, and 12.7 mm were left of 25.5.
    """
    write_robot_file(TrueRobot(), tmp_path / "robot.yaml")
    file = read_robot_file(tmp_path / "robot.yaml")
    drive = free(70.0, seed=1, speed=0.2, yaw_rate=0.3)
    run = read_run(write_run(record(TrueRobot(), drive, seed=1), tmp_path / "run"), file)
    seen = run.reference
    assert seen is not None
    yaw = np.unwrap(seen.yaw)
    x = seen.x + AHEAD * np.cos(yaw) - LEFT * np.sin(yaw)
    y = seen.y + AHEAD * np.sin(yaw) + LEFT * np.cos(yaw)
    x = x + DRIFT * np.cumsum(np.hypot(np.diff(x, prepend=x[0]), np.diff(y, prepend=y[0])))
    early = np.interp(seen.time + EARLY, seen.time, yaw) + ASKEW
    run = replace(run, reference=replace(seen, x=x, y=y, yaw=early))
    names = (
        *("track_width", "lateral_slip", "sideways_drift", "floor_slope", "anisotropic_floor"),
        *("reference_lever_arm", "reference_yaw_offset", "reference_delay"),
        "reference_heading_delay",
    )
    found = diagnose([run], file.robot, [find(name) for name in names])
    assert {TWINS.get(name, name) for name in found.found} == {
        "reference_lever_arm",
        "reference_yaw_offset",
        "reference_heading_delay",
        "floor_slope",
    }
    assert found.holdout.after < 0.2 * found.holdout.before
    values = {held.name: held.values for held in found.robot.effects}
    assert values["reference_lever_arm"]["x"] == pytest.approx(AHEAD, abs=2e-3)
    assert values["reference_heading_delay"]["delay"] == pytest.approx(-EARLY, abs=0.01)


@pytest.mark.evidence
def test_the_more_important_is_told_first_though_half_of_its_law_is_not_determined() -> None:
    """A payload that stays the same tells nothing; beside it the temperature counted for none."""
    by_channel = find("radius_by_channel").using(temperature=-2e-3)
    oval = find("oval_left_wheel").using(amplitude=1e-3, phase=0.4)
    runs = []
    for seed in (1, 2):
        warmth = 20.0 + 5.0 * np.sin(np.linspace(0.0, 6.0 + seed, 90 * 20 + 1))
        channels = {"wheel_temperature_c": warmth, "payload_kg": np.full(warmth.size, 3.0)}
        truth = replace(ROBOT, effects=(by_channel, oval))
        runs.append(run_of(truth, seed, channels=channels))
    effects = [find(name) for name in ("radius_by_channel", "oval_left_wheel")]
    found = diagnose(runs, ROBOT, effects)
    assert found.found == ("radius_by_channel", "oval_left_wheel")
    assert found.final.importance["radius_by_channel"] > 1e3


@pytest.mark.evidence
@pytest.mark.parametrize("after", [in_evidence(0.0), 1.0])
def test_what_explains_most_by_itself_gives_way_to_what_does_better_beside_another(
    after: float,
) -> None:
    """A wheel oval, and off its centre, was told to have a bump, a wrong radius and an oval."""
    effects = [
        find(name) for name in ("left_tread_bump", "eccentric_left_wheel", "oval_left_wheel")
    ]
    runs = []
    for seed, place in enumerate((0.3, 1.9, -2.0)):
        twice = float(np.angle(np.exp(1j * (2.0 * place + after))))
        off = find("eccentric_left_wheel").using(amplitude=0.5e-3, phase=place)
        oval = find("oval_left_wheel").using(amplitude=0.9e-3, phase=twice)
        truth = replace(PLAIN, effects=(off, oval))
        runs += runs_of(truth, (seed,), 60)
    found = diagnose(runs, PLAIN, effects)
    assert set(found.found) == {"eccentric_left_wheel", "oval_left_wheel"}
    assert found.verdict == "named"


@pytest.mark.evidence
def test_what_stood_in_for_another_is_dropped_when_that_is_found() -> None:
    """A castor that swings by its own angle passed for one that kicks at reversals alone."""
    truth = replace(PLAIN, effects=(find("castor_swing").using(drag=-0.02),))
    begun = begin(runs_of(truth, (1, 2), 60), (), PLAIN, EvaluationOptions())
    laid = concatenated(for_fit(begun.judge.train, PLAIN))
    before = fit = fit_calibration(laid, PLAIN)
    rounds = []
    for name in ("castor_kick", "castor_swing"):
        rounds.append(search_round(laid, fit, [find(name)], PLAIN))
        fit = refit_to_rest(laid, rounds[-1].tried[0], PLAIN)
    assert fit.names == ("castor_kick", "castor_swing")
    fit, rounds = reconsidered(laid, fit, rounds, PLAIN)
    assert fit.names == ("castor_swing",)
    (held,) = fit.point.model.robot.effects
    assert held.values["drag"] == pytest.approx(-0.02, rel=0.1)
    (only,) = rounds
    assert only.before is before
    assert [tried.names for tried in only.tried] == [("castor_swing",)]


@pytest.mark.evidence
def test_of_an_effect_is_kept_what_is_needed_beside_those_found_after_it() -> None:
    """Play made a late clock seem to drift, and the drift was named beside the play."""
    truth = replace(PLAIN, effects=(find("right_backlash").using(travel=0.006),))
    runs = [
        replace(run, reference=replace(run.reference, time=run.reference.time + 0.01))
        for run in runs_of(truth, (1, 2, 3), 45)
        if run.reference is not None
    ]
    laid = concatenated(for_fit(begin(runs, (), PLAIN, EvaluationOptions()).judge.train, PLAIN))
    before = fit_calibration(laid, PLAIN)
    rounds, fit = [], before
    for name in ("reference_clock_drift", "right_backlash"):
        score = best_of_each(scores(laid, fit.point, (*CALIBRATION, *fit.numbers), one(name)))[0]
        start = started_with(laid, fit.point, score)
        found = fitted_beside(laid, fit, start, score, PLAIN)
        rounds.append(Round(fit, (score,), (found,), (), 1))
        fit = found
    assert fit.names == ("reference_clock_drift", "right_backlash")
    fit, rounds = reconsidered(laid, fit, rounds, PLAIN)
    assert fit.names == ("reference_delay", "right_backlash")
    delay, play = (held.values for held in fit.point.model.robot.effects)
    assert delay["delay"] == pytest.approx(0.01, abs=1e-3)
    assert play["travel"] == pytest.approx(0.006, rel=0.1)


def one(name: str) -> list[Candidate]:
    return candidates([find(name)], [], (), 3)


@pytest.mark.evidence
def test_what_two_do_together_is_not_beyond_the_library() -> None:
    """Squares by a marker that is askew and ahead of the axle: sideways with the rate of turning.

    A curve over that rate holds both, and explained far more than either: *unknown* it was.
    """
    ahead, askew = 3e-3, 6e-3
    speed, turning = (
        [*[still] * 10, *[go] * 160, *[still] * 10, *[by] * 40] * 4
        for still, go, by in ((0.0, 0.2, 0.0), (0.0, 0.0, np.pi / 4.0))
    )
    runs = []
    for seed, sense in enumerate((1.0, -1.0, 1.0, -1.0)):
        driven = (np.convolve(part, np.ones(6) / 6.0, "same") for part in (speed, turning))
        run = run_by(ROBOT, next(driven), sense * next(driven), seed=seed)
        seen = run.reference
        assert seen is not None
        x, y = seen.x + ahead * np.cos(seen.yaw), seen.y + ahead * np.sin(seen.yaw)
        runs.append(replace(run, reference=replace(seen, x=x, y=y, yaw=seen.yaw + askew)))
    found = diagnose(runs, ROBOT, COMMON)
    assert set(found.found) == {"reference_yaw_offset", "reference_lever_arm"}
    values = {held.name: held.values for held in found.robot.effects}
    assert values["reference_lever_arm"]["x"] == pytest.approx(ahead, abs=0.5e-3)
    assert values["reference_yaw_offset"]["angle"] == pytest.approx(askew, abs=0.5e-3)
