# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Where the fit of a candidate begins."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from test.evidence import in_evidence
from test.inference.driven import COMMON, common, of_headings, run_by, run_of
from test.inference.positions import FRAME, positions_of_a_point
from test.inference.test_late_clock import later
from test.model.drives import ROBOT, read
from werrimbi_odom.effects import find
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis import forward_selection
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.inference.diagnosis.forward_selection import fit_calibration, search_round
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted, fitted
from werrimbi_odom.inference.fitting.candidate_starts import (
    looked_for_delay,
    started_with,
    with_candidate,
)
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.fit import start_point
from werrimbi_odom.inference.fitting.free_parameters import (
    START_YAW,
    changed,
    parameters_to_fit,
)
from werrimbi_odom.inference.fitting.prediction import predicted_legs, turns_over
from werrimbi_odom.inference.fitting.score_tests import candidates, scores
from werrimbi_odom.inference.legs.cutting import match_for_fit
from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.effect import Parameter, body_effect
from werrimbi_odom.model.motion import BodyMotion, Number
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.trajectory import trajectory


@body_effect(size=Parameter("", null=0.0, typical=0.01, bounds=(-1.0, 1.0), says="of the trouble"))
def explodes(motion: BodyMotion[Number], drive: Drive[Number], size: float) -> BodyMotion[Number]:
    """A turn that is linear in a small size, and grows without limit in a large one."""
    return motion._replace(turn=motion.turn * (1.0 + size + (4.0 * size) ** 12))


def test_a_score_that_leads_to_nonsense_is_followed_part_of_the_way() -> None:
    runs = concatenated(match_for_fit([run_of(ROBOT, 3, 60)], ROBOT, 1.0))
    point = start_point(runs, ROBOT, EvaluationOptions())
    (score,) = scores(runs, point, (), candidates([explodes], (), (), 1))
    far = replace(score, coefficients=np.array([5e2]))
    before = predicted_legs(point.model, runs)
    assert turns_over(before, predicted_legs(with_candidate(point.model, far), runs))
    start = started_with(runs, point, far)
    assert not turns_over(before, predicted_legs(start.model, runs))
    (effect,) = start.model.robot.effects
    assert 0.0 < effect.values["size"] < 1.0


ANTENNA = -0.137 + 0.033j
"""Ahead of the axle's middle, and left of it [m]."""


@pytest.mark.parametrize("wrong", [0.0, 2.0, 3.0, -2.8])
def test_positions_of_a_point_far_from_the_axle_start_in_its_direction(wrong: float) -> None:
    # Positions of a spin on the spot hold the heading and the point's direction together.
    drives = [
        positions_of_a_point("bends", [0.3, 0.3], [0.3, -0.3], ANTENNA),
        positions_of_a_point("spins", [0.0] * 3, [0.7, -1.2, 0.4], ANTENNA),
    ]
    runs = concatenated(match_for_fit(drives, ROBOT, 1.0))
    point = start_point(runs, ROBOT, EvaluationOptions())
    bends, spins = point.model.own
    turned = {**spins, START_YAW: FRAME + wrong}
    point = replace(point, model=replace(point.model, own=(bends, turned)))
    (score,) = scores(runs, point, (), candidates([find("reference_lever_arm")], (), (), 2))
    (effect,) = started_with(runs, point, score).model.robot.effects
    found = complex(effect.values["x"], effect.values["y"]) / ANTENNA
    assert 0.5 < abs(found) < 1.5  # where a fit starts
    assert abs(np.angle(found)) < 0.5


def test_sizes_that_stood_in_for_a_lever_arm_do_not_stay() -> None:
    """Spins on the spot do not tell unequal wheels from a point beside the axle."""
    spin = run_by(ROBOT, np.full(600, 0.002), np.full(600, -0.39), seed=1)
    seen = spin.reference
    assert seen is not None
    east, north = (0.36 * swing(seen.yaw) for swing in (np.cos, np.sin))
    ahead = replace(spin, reference=replace(seen, x=seen.x + east, y=seen.y + north))
    runs = concatenated(match_for_fit([ahead], ROBOT, 1.0))
    before = fit_calibration(runs, ROBOT)
    model = before.point.model
    apart = {"left_wheel_radius_multiplier": 0.7, "right_wheel_radius_multiplier": 1.3}
    point = replace(before.point, model=replace(model, robot=changed(model.robot, apart)))
    astray = replace(before, point=point, calibrated=())
    (fit,) = search_round(runs, astray, [find("reference_lever_arm")], ROBOT).tried
    (effect,) = fit.point.model.robot.effects
    assert not fit.at_bound
    assert effect.values["x"] == pytest.approx(0.36, abs=2e-3)
    assert effect.values["y"] == pytest.approx(0.0, abs=2e-3)


def test_what_drives_do_not_determine_does_not_stay_where_its_score_sent_it() -> None:
    """Lines and spins: a base 36 % larger was told, beside a sharpness that was not determined."""
    speed, turning = np.tile(np.repeat([[0.3, 0.0, -0.3, 0.0], [0.0, 0.9, 0.0, -0.9]], 60, 1), 3)
    runs = concatenated(match_for_fit([run_by(ROBOT, speed, turning)], ROBOT, 1.0))
    begun = fit_calibration(runs, ROBOT)
    model = begun.point.model
    turns = find("turn_dependent_track").using(sharpness=-0.265, sense=0.0)
    started = replace(
        begun.point, model=replace(model, robot=replace(model.robot, effects=(turns,)))
    )
    fit = fitted(runs, started, [turns.name], parameters_to_fit(turns.effect), ROBOT)
    (found,) = fit.point.model.robot.effects
    assert found.values["sharpness"] == 0.0
    assert fit.point.model.robot.wheel_separation_multiplier == pytest.approx(1.0, abs=0.01)


@pytest.mark.evidence
@pytest.mark.parametrize("point", [0.063 - 0.04j, -0.02 + 0.06j])
def test_on_one_circle_a_point_off_the_axle_is_a_rival_of_the_radii(point: complex) -> None:
    circle = positions_of_a_point("circle", [0.3] * 5, [0.3] * 5, point)
    found = diagnose([circle], ROBOT, COMMON)
    assert found.verdict == "ambiguous"
    assert "reference_lever_arm" in found.rivals


@pytest.mark.evidence
def test_on_one_circle_at_one_speed_many_effects_are_rivals_of_unequal_wheels() -> None:
    load = find("load_transfer").using(lateral=0.02, longitudinal=0.0)
    circle = positions_of_a_point(
        "circle", [0.3] * 5, [0.3] * 5, truth=replace(ROBOT, effects=(load,))
    )
    found = diagnose([circle], ROBOT, COMMON)
    assert found.verdict == "ambiguous"
    assert {"unequal_wheel_radii", "load_transfer"} <= set(found.rivals)


@pytest.mark.parametrize("seed", [0, in_evidence(2)])
def test_two_sizes_that_do_nearly_the_same_start_within_what_is_physical(seed: int) -> None:
    # Left turns at nearly one rate: what `sharpness` adds, `sense` takes away, but for little.
    law = find("turn_dependent_track").using(sharpness=0.02, sense=0.0)
    turning = np.tile(np.repeat([0.0, 0.5], 100), 2)
    turning *= 1.0 + 0.015 * np.random.default_rng(seed).standard_normal(turning.size)
    truth = replace(ROBOT, effects=(law,))
    drive = run_by(truth, np.full(turning.size, 0.3), turning, seed=seed)
    runs = concatenated(match_for_fit([drive], ROBOT, 1.0))
    point = start_point(runs, ROBOT, EvaluationOptions())
    (score,) = scores(runs, point, (), candidates([law.effect], (), (), 1))
    (start,) = started_with(runs, point, score).model.robot.effects
    assert abs(start.values["sharpness"]) < 0.1
    assert abs(start.values["sense"]) < 0.1
    found = diagnose([drive], ROBOT, COMMON)
    assert found.verdict == "ambiguous"
    assert {"track_width", "turn_dependent_track"} <= set(found.rivals)


def test_jitter_of_the_stamps_does_not_stand_in_for_a_delay() -> None:
    """A gyro 50 ms late: starts and stops were taken for jitter, and the delay was not tried."""
    random = np.random.default_rng(3)
    turning = random.uniform(-1.5, 1.5, 20) * (random.random(20) > 0.4)
    drive = run_by(
        ROBOT, *(np.repeat(each, 30) for each in (random.uniform(0.0, 0.3, 20), turning)), seed=3
    )
    seen = drive.reference
    assert seen is not None
    late = seen.time - 0.05 + random.normal(0.0, 0.01, seen.time.size)
    yaw = np.interp(late, seen.time, np.unwrap(seen.yaw))
    gyro = replace(drive, reference=of_headings(seen.time, yaw))
    runs = concatenated(match_for_fit([gyro], ROBOT, 0.25))
    before = fit_calibration(runs, ROBOT, EvaluationOptions(reference_kind="incremental"))
    assert before.point.variances.stamp[0] ** 0.5 > rules.MOST_STAMP_NOISE
    best = search_round(runs, before, COMMON, ROBOT).tried[0]
    assert best.names == ("reference_delay",)
    (delay,) = best.point.model.robot.effects[-1].values.values()
    assert delay == pytest.approx(0.05, abs=0.02)


COARSE = Robot(
    wheel_separation=0.1,
    wheel_radius=0.017,
    left_ticks_per_revolution=20.0,
    right_ticks_per_revolution=20.0,
)


def coarsely_counted(seed: int) -> Run:
    """48 s of wheels with few counts a turn, by a reference that is 20 ms late."""
    fine = replace(COARSE, left_ticks_per_revolution=2e4, right_ticks_per_revolution=2e4)
    random = np.random.default_rng(seed)
    speed = random.uniform(-0.08, 0.15, 40) * (random.random(40) > 0.2)
    turning = random.uniform(-1.5, 1.5, 40) * (random.random(40) > 0.3)
    smooth = np.ones(30) / 30.0
    driven = [np.convolve(np.repeat(part, 120), smooth, "same") for part in (speed, turning)]
    counts = read(COARSE, 100.0, *driven)
    path = trajectory(fine, *read(fine, 100.0, *driven))
    seen = slice(None, None, 2)
    noise = random.normal(0.0, [[2e-4], [2e-4], [1.6e-3]], (3, path.x[seen].size))
    x, y, yaw = np.array([path.x[seen], path.y[seen], path.yaw[seen]]) + noise
    ticks = Ticks(counts.time, counts.left.astype(float), counts.right.astype(float), {})
    reference = Reference(path.time[seen] + 0.02, x, y, yaw)
    return Run(f"coarse_{seed}", Path(f"coarse_{seed}"), ticks, reference)


@pytest.mark.evidence
@pytest.mark.parametrize("first", [0, in_evidence(6)])
def test_steps_of_a_coarse_counter_do_not_hide_a_delay(first: int) -> None:
    """Twenty counts a turn: the score at null ended 4 ms from none, and slip was named instead."""
    runs = [coarsely_counted(first + number) for number in range(3)]
    found = diagnose(runs, COARSE, common("longitudinal_slip", "coulomb_slip"))
    assert found.found == ("reference_delay",)
    (late,) = found.model.robot.effects
    assert late.values["delay"] == pytest.approx(0.02, abs=0.006)  # a message takes 10 ms


@pytest.mark.evidence
def test_what_extends_a_delay_costs_no_more_than_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a late reference the drift of its clock was fitted, in a minimum of its own, 48 dearer."""
    seen: list[Fitted] = []
    monkeypatch.setattr(
        forward_selection, "without_nested", lambda _, tried: [*map(seen.append, tried)][:0]
    )
    laid = concatenated(match_for_fit([coarsely_counted(seed) for seed in range(3)], COARSE, 0.25))
    both = [find("reference_delay"), find("reference_clock_drift")]
    search_round(laid, fit_calibration(laid, COARSE), both, COARSE)
    cost = {fit.names[-1]: fit.cost for fit in seen}
    assert cost["reference_clock_drift"] < cost["reference_delay"] + 0.1


def test_each_drive_s_own_delay_is_looked_for() -> None:
    """Between the steps of a coarse counter the fit of a drifting clock ended 57 dearer."""
    late = (0.08, -0.06, 0.04)
    runs = [later(coarsely_counted(seed), delay - 0.02) for seed, delay in enumerate(late)]
    laid = concatenated(match_for_fit(runs, COARSE, 0.25))
    point = fit_calibration(laid, COARSE).point
    wider = candidates([find("reference_clock_drift")], (), (), 3)
    score = next(each for each in scores(laid, point, (), wider) if each.candidate.per_run)
    start = looked_for_delay(laid, point, score)
    assert start is not None
    found = [mine["reference_clock_drift.delay"] for mine in start.model.own]
    assert found == pytest.approx(late, rel=0.3)


@pytest.mark.parametrize("seed", [30, in_evidence(50)])
def test_a_bump_is_fitted_beside_the_flat_across_from_it(seed: int) -> None:
    """Once a turn they are the same; the flat alone was fitted, with another radius beside it."""
    robot = Robot(0.35, 0.05, 2000.0, 2000.0, left_wheel_noise=4e-4, right_wheel_noise=4e-4)
    bump = find("left_tread_bump")
    truth = replace(robot, effects=(bump.using(height=6e-4, place=1.0),))
    drives = [run_of(truth, number, 60) for number in (seed, seed + 1)]
    laid = concatenated(match_for_fit(drives, robot, 1.0))
    (fit,) = search_round(laid, fit_calibration(laid, robot), [bump], robot).tried
    assert fit.point.model.robot.effects[-1].values["height"] == pytest.approx(6e-4, abs=3e-4)
